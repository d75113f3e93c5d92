// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/colour.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "colour/spaces.h"

namespace pimg {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// What a colour makes of samples: light, and light in Rec. 709.
struct Meaning {
    bool encoded;
    std::array<float, 3> weights;
    std::array<float, 9> decoded { 0.0f, 0.04f, 0.2f, 0.5f, 0.7f, 1.0f, 1.0f, 0.1f, 0.3f }, in_rec709 {};
};

Meaning meaning(const Colour& colour)
{
    Meaning m { colour.encoded(), colour.weights() };
    colour.decode(m.decoded.data(), 3);
    m.in_rec709 = m.decoded;
    colour.to_rec709(m.in_rec709.data(), 3);
    return m;
}

void expect_same(const Meaning& a, const Meaning& b, const std::string& names)
{
    EXPECT_EQ(a.encoded, b.encoded) << names;
    EXPECT_EQ(a.weights, b.weights) << names;
    EXPECT_EQ(a.decoded, b.decoded) << names;
    EXPECT_EQ(a.in_rec709, b.in_rec709) << names;
}

/// Names of one space: OpenImageIO 2.4 and its ACES configurations, 3.0, 3.1 and newer.
const std::vector<std::vector<std::string>> kSame = {
    { "Linear", "lin_rec709", "lin_rec709_scene", "Linear Rec.709 (sRGB)" },
    { "sRGB", "srgb_rec709_scene", "srgb_rec709_display", "sRGB - Texture" },
    { "ACEScg", "lin_ap1", "lin_ap1_scene" },
    { "ACES2065-1", "lin_ap0", "lin_ap0_scene" },
    { "Linear Rec.2020", "lin_rec2020", "lin_rec2020_scene" },
    { "Linear P3-D65", "lin_p3d65", "lin_p3d65_scene" },
    { "gamma2.2", "g22_rec709", "g22_rec709_scene" },
    { "gamma1.8", "g18_rec709", "g18_rec709_scene" },
};

TEST(Colour, NamesOfAllGenerationsMeanTheSameWhenAsked)
{
    const ImageSpec spec(4, 4, 3, TypeDesc::FLOAT);
    for (const std::vector<std::string>& names : kSame) {
        Colour first, other;
        std::string error;
        ASSERT_TRUE(Colour::resolve(spec, names[0], first, error)) << error;
        for (const std::string& name : names) {
            ASSERT_TRUE(Colour::resolve(spec, name, other, error)) << error;
            expect_same(meaning(first), meaning(other), names[0] + ", " + name);
        }
    }
}

TEST(Colour, NamesOfAllGenerationsMeanTheSameInMetadata)
{
    for (const TypeDesc type : { TypeDesc::FLOAT, TypeDesc::UINT16 })
        for (const std::vector<std::string>& names : kSame) {
            ImageSpec spec(4, 4, 3, type);
            spec.attribute("oiio:ColorSpace", names[0]);
            Colour first, other;
            std::string error;
            ASSERT_TRUE(Colour::resolve(spec, "", first, error)) << error;
            for (const std::string& name : names) {
                spec.attribute("oiio:ColorSpace", name);
                ASSERT_TRUE(Colour::resolve(spec, "", other, error)) << error;
                expect_same(meaning(first), meaning(other), names[0] + ", " + name);
            }
        }
}

TEST(Colour, NamesOfLinearLightSayItsPrimaries)
{
    EXPECT_EQ(with_primaries("lin_rec709_scene", kRec709), "lin_rec709_scene");
    EXPECT_EQ(with_primaries("lin_rec709_scene", kAp1), "lin_ap1_scene");
    EXPECT_EQ(with_primaries("lin_rec709", kP3), "lin_p3d65");
    EXPECT_EQ(with_primaries("lin_rec709_scene", kProPhoto), "");
    EXPECT_EQ(with_primaries("Linear", kAp1), "Linear");
}

TEST(Colour, SpacesDiffer)
{
    const ImageSpec spec(4, 4, 3, TypeDesc::FLOAT);
    for (std::size_t i = 1; i < kSame.size(); ++i) {
        Colour a, b;
        std::string error;
        ASSERT_TRUE(Colour::resolve(spec, kSame[i - 1][0], a, error) && Colour::resolve(spec, kSame[i][0], b, error));
        EXPECT_NE(meaning(a).in_rec709, meaning(b).in_rec709) << kSame[i][0];
    }
}

TEST(Colour, LogarithmsAreExact)
{
    std::vector<float> values;
    for (double value = 1e-9; value < 1e9; value *= 1.000173)
        values.push_back(float(value));
    std::vector<float> logs = values;
    log2_in_place(logs.data(), logs.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < logs.size(); ++i)
        worst = std::max(worst,
                         std::fabs(double(logs[i]) - std::log2(double(values[i])))
                             / std::max(1.0, std::fabs(double(logs[i]))));
    EXPECT_LT(worst, 2e-7);  // the approximation that OpenColorIO 2.5 takes by default is off by 1.4e-5
}

}  // namespace
}  // namespace pimg
