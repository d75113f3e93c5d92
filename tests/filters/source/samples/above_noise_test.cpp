// SPDX-License-Identifier: BSD-3-Clause
#include "source/samples/above_noise.h"

#include <cmath>

#include "filters/pictures.h"

namespace pimg {
namespace {

constexpr int kWidth = 60, kHeight = 40;

/// White noise of standard deviation 1 to the left, ten times as much to the right.
Channels two_halves()
{
    Channels channels(3, std::vector<float>(std::size_t(kWidth * kHeight)));
    for (std::uint32_t c = 0; c < 3; ++c)
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                channels[c][std::size_t(y * kWidth + x)] = std::sqrt(12.0f) * (x < 30 ? 1.0f : 10.0f)
                    * (test::noise(std::uint32_t(x), std::uint32_t(y), c) - 0.5f);
    return channels;
}

TEST(AboveNoise, TextureIsMore)
{
    const std::vector<float> share =
        share_above_noise(two_halves(), std::vector<float>(kWidth * kHeight, 1.0f), kWidth, kHeight, {});
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float s = share[std::size_t(y * kWidth + x)];
            if (x < 26) {
                ASSERT_EQ(s, 0.0f) << x << " " << y;
            } else if (x > 34) {
                ASSERT_GT(s, 0.9f) << x << " " << y;
            }
        }
}

TEST(AboveNoise, WithoutNoiseAllIsMore)
{
    for (const float s :
         share_above_noise(two_halves(), std::vector<float>(kWidth * kHeight, 0.0f), kWidth, kHeight, {}))
        ASSERT_EQ(s, 1.0f);
    EXPECT_EQ(share_above_noise({ { 1.0f, 1.0f } }, { 0.1f, 0.0f }, 2, 1, {}).size(), 2u);
}

}  // namespace
}  // namespace pimg
