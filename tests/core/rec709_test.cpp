// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/rec709.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace pimg {
namespace {

using namespace elementary;

TEST(Rec709, CurveOfSrgbIsThatOfTheStandard)
{
    double worst = 0.0;
    for (int i = -100; i <= 4000; ++i) {
        const double encoded = double(i) / 1000.0, light = srgb_decoded(encoded);
        const double expected = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        worst = std::max(worst, std::fabs(light - expected) / std::max(std::fabs(expected), 1e-6));
    }
    EXPECT_LT(worst, 1e-10);
    EXPECT_EQ(srgb_decoded(0.0), 0.0);
    EXPECT_NEAR(srgb_decoded(1.0), 1.0, 1e-12);
}

/// The standard rounds the place where both parts of the curve meet; the encoded parts differ by 6e-8 there.
TEST(Rec709, EncodingIsTheInverseOfDecoding)
{
    for (int i = -100; i <= 4000; ++i) {
        const double encoded = double(i) / 1000.0;
        EXPECT_NEAR(srgb_encoded(srgb_decoded(encoded)), encoded, 1e-7) << encoded;
    }
}

TEST(Rec709, LightnessOfBlackGreyAndWhite)
{
    EXPECT_EQ(lightness(0.0f), 0.0f);
    EXPECT_NEAR(lightness(0.18f), 49.496f, 1e-3f);
    EXPECT_NEAR(lightness(1.0f), 100.0f, 1e-5f);
    EXPECT_NEAR(lightness(216.0f / 24389.0f), 8.0f, 1e-5f);
    EXPECT_NEAR(kRec709Weights[0] + kRec709Weights[1] + kRec709Weights[2], 1.0f, 1e-7f);
}

}  // namespace
}  // namespace pimg
