// SPDX-License-Identifier: BSD-3-Clause
// The noise of a picture is found where it is smooth, and a smooth picture has none.
#include "source/samples/noise.h"

#include <cmath>

#include "filters/pictures.h"

namespace pimg {
namespace {

using OIIO::ImageBuf;

constexpr int kWidth = 320, kHeight = 240;

/// A number with mean 0 and standard deviation 1, nearly normal: of twelve even ones.
float deviate(int x, int y)
{
    float sum = -6.0f;
    for (std::uint32_t k = 0; k < 12; ++k)
        sum += test::noise(std::uint32_t(x), std::uint32_t(y), k);
    return sum;
}

/// A wall lit from the right, 0.05 to 2, with noise of this variance.
LogLuminance wall(float read, float photon)
{
    ImageBuf buf(OIIO::ImageSpec(kWidth, kHeight, 1, OIIO::TypeFloat));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float light = 0.05f * std::exp2(5.3f * float(x) / kWidth);
            const float sample = light + std::sqrt(read + photon * light) * deviate(x, y);
            buf.setpixel(x, y, &sample);
        }
    Colour colour;
    std::string error;
    EXPECT_TRUE(Colour::resolve(buf.spec(), "", colour, error)) << error;
    return log_luminance(buf, colour, {});
}

TEST(Noise, OfASensorIsFound)
{
    for (const auto& [read, photon] : { std::pair(1e-5f, 0.0f), { 0.0f, 2e-4f }, { 4e-6f, 2e-4f } }) {
        const NoiseModel noise = estimate_noise(wall(read, photon), {});
        for (const float light : { 0.1f, 0.5f, 1.5f }) {
            const float expected = std::sqrt(read + photon * light);
            EXPECT_NEAR(std::sqrt(noise.read + noise.photon * light), expected, 0.3f * expected)
                << read << " " << light;
        }
    }
}

TEST(Noise, OfASmoothPictureIsNone)
{
    const NoiseModel noise = estimate_noise(wall(0.0f, 0.0f), {});
    EXPECT_LT(std::sqrt(noise.read + noise.photon), 1e-4f);
}

/// In guide units: the relative deviation times the units of a doubling.
TEST(Noise, InStops)
{
    const NoiseTable table({ 0.0f, 1e-4f, 0.5f });
    EXPECT_NEAR(table.at(0.0f), std::sqrt(1e-4f / 0.5f) / std::log(2.0f) * kUnitsPerStop, 1e-3f);
    EXPECT_NEAR(table.at(-2.0f * kUnitsPerStop), 2.0f * table.at(0.0f), 1e-3f);
    EXPECT_EQ(NoiseTable({}).at(0.0f), 0.0f);
}

}  // namespace
}  // namespace pimg
