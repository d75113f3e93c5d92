// SPDX-License-Identifier: BSD-3-Clause
// Filters on linear light leave no less than none, and no black rings round lamps.
#include <algorithm>
#include <limits>

#include <pimg/imagebufalgo.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;

constexpr int kSize = 96;

/// Texture between 1e-4 and 0.2 with lamps of 200, some pixels apart; `least` is the sample of a few dark pixels.
ImageBuf lamps(float least = 1e-4f)
{
    ImageBuf buf = picture(kSize, kSize, 3, OIIO::TypeFloat);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const float n = 0.5f + 0.5f * noise(std::uint32_t(x), std::uint32_t(y));
            const bool lamp = x % 23 == 11 && y % 19 == 7, hole = x % 31 == 5 && y % 29 == 3;
            const float light = lamp ? 200.0f : hole ? least : 1e-3f + 0.2f * n * n * n * n;
            const float pixel[3] = { light, 0.8f * light, 0.6f * light };
            buf.setpixel(x, y, pixel);
        }
    return buf;
}

/// The least sample of a channel around each.
std::vector<float> least_around(const std::vector<float>& p)
{
    std::vector<float> least(p.size(), std::numeric_limits<float>::max());
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            for (int j = std::max(y - 1, 0); j < std::min(y + 2, kSize); ++j)
                for (int i = std::max(x - 1, 0); i < std::min(x + 2, kSize); ++i)
                    for (std::size_t c = 0; c < 3; ++c) {
                        float& l = least[3 * std::size_t(y * kSize + x) + c];
                        l = std::min(l, p[3 * std::size_t(j * kSize + i) + c]);
                    }
    return least;
}

/// Results of every filter that works on linear light, under their names.
std::vector<std::pair<std::string, std::vector<float>>> results_of(const ImageBuf& src)
{
    std::vector<std::pair<std::string, std::vector<float>>> results;
    const auto keep = [&](const std::string& name, const ImageBuf& result) {
        EXPECT_FALSE(result.has_error()) << result.geterror();
        results.emplace_back(name, pixels(result));
    };
    for (const float fraction : { 0.01f, 0.1f, 0.5f }) {
        LevelOptions level;
        level.fraction = fraction;
        keep("level", ImageBufAlgo::level_image(src, level));
        FeatureLowpassOptions lowpass;
        lowpass.fraction = fraction;
        keep("feature_lowpass", ImageBufAlgo::feature_lowpass(src, lowpass));
    }
    keep("feature_lowpass by strength", ImageBufAlgo::feature_lowpass(src, {}));
    for (const float gain : { 2.0f, 8.0f }) {
        DetailEnhanceOptions enhance;
        enhance.gain = gain;
        keep("detail_enhance", ImageBufAlgo::detail_enhance(src, enhance));
        enhance.strength = 0.1f;
        keep("detail_enhance by strength", ImageBufAlgo::detail_enhance(src, enhance));
    }
    return results;
}

TEST(PositiveLight, NoFilterMakesLessThanNone)
{
    for (const float least : { 1e-4f, 0.0f, -0.02f }) {
        const ImageBuf src = lamps(least);
        const std::vector<float> bound = least_around(pixels(src));
        for (const auto& [name, result] : results_of(src))
            for (std::size_t i = 0; i < result.size(); ++i)
                ASSERT_GE(result[i], std::min(0.0f, bound[i])) << name << ", least " << least << ", sample " << i;
    }
}

TEST(PositiveLight, LampsHaveNoBlackRings)
{
    const ImageBuf src = lamps();
    const std::vector<float> before = pixels(src);
    const float darkest = *std::min_element(before.begin(), before.end());
    for (const auto& [name, result] : results_of(src))
        EXPECT_GE(*std::min_element(result.begin(), result.end()), 0.249f * darkest) << name;
}

TEST(PositiveLight, EncodedPicturesKeepTheirLevels)
{
    // Where samples are not light, a level is its mesh, whatever that is below 0.
    ImageBuf src = lamps();
    src.specmod().attribute("oiio:ColorSpace", "sRGB");
    LevelOptions level;
    level.fraction = 0.1f;
    const std::vector<float> result = pixels(ImageBufAlgo::level_image(src, level));
    EXPECT_LT(*std::min_element(result.begin(), result.end()), -1.0f);
}

}  // namespace
}  // namespace pimg
