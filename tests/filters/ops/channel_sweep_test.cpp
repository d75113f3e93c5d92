// SPDX-License-Identifier: BSD-3-Clause
// Filters by position sweep all channels at once, by a plan from the second call on: the result is that of core's plain
// sweeps of one channel after the other.
#include <pimg/bands.h>
#include <pimg/imagebufalgo.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;

/// One channel of a picture whose mesh has a vertex for every pixel, with the details of the first `kept` splits only.
std::vector<float> plain_lowpass(const ProgressiveImage& image, const ImageBuf& src, int channel, Level kept)
{
    const Hierarchy& h = image.hierarchy();
    const std::vector<float> all = pixels(src);
    std::vector<float> samples;
    for (std::size_t i = std::size_t(channel); i < all.size(); i += std::size_t(src.nchannels()))
        samples.push_back(all[i]);
    std::vector<Bands> bands;
    EXPECT_TRUE(analyse(h, { samples.data() }, bands).ok());
    std::vector<float> values(h.vertices());
    sweep(h, bands[0], values.data(), h.levels(), [&](Level i, Detail d) {
        return i < kept ? d : Detail { 0.0f, 0.0f };
    });
    scatter(h, values.data(), samples.data());
    return samples;
}

TEST(ChannelSweep, GivesThePlainSweepsOfEveryChannel)
{
    for (const int channels : { 1, 2, 3, 4 }) {
        const ImageBuf scene = hdr_scene(150, 130, OIIO::TypeFloat, channels, 1.0f / 512.0f);
        BuildOptions options;
        options.incolorspace = "sRGB";  // scene-linear light would be kept from undershooting
        ProgressiveImage image;
        ASSERT_TRUE(image.build(scene, options)) << image.error();
        FeatureLowpassOptions lowpass;
        lowpass.fraction = 0.2f;
        const Level kept = Level(std::lround(0.2 * image.hierarchy().levels()));
        const int swept = channels == 2 || channels == 4 ? channels - 1 : channels;  // the last is alpha
        for (int turn = 0; turn < 3; ++turn) {
            ImageBuf dst;
            EXPECT_FILTER(dst, ImageBufAlgo::on_hierarchy::feature_lowpass(dst, image, lowpass, {}, 1 + turn));
            const std::vector<float> result = pixels(dst);
            for (int c = 0; c < swept; ++c) {
                const std::vector<float> expected = plain_lowpass(image, scene, c, kept);
                for (std::size_t i = 0; i < expected.size(); ++i)
                    ASSERT_EQ(result[i * std::size_t(channels) + std::size_t(c)], expected[i])
                        << channels << " channels, " << turn << ", " << c << ", " << i;
            }
        }
    }
}

/// Results of the filters by position, which sweep in the hierarchy's order at the first call, then by a plan.
TEST(ChannelSweep, IsTheSameAtEveryCallAndNumberOfThreads)
{
    BuildOptions adaptive;
    adaptive.mesh = "adaptive";
    for (const BuildOptions& options : { BuildOptions(), adaptive }) {
        ProgressiveImage image;
        ASSERT_TRUE(image.build(hdr_scene(150, 130), options)) << image.error();
        std::vector<std::vector<float>> first;
        for (const int threads : { 1, 1, 3, 8 }) {
            ImageBuf lowpass, enhanced, level;
            FeatureLowpassOptions by_fraction;
            by_fraction.fraction = 0.1f;
            LevelOptions of_level;
            of_level.fraction = 0.05f;
            EXPECT_FILTER(lowpass,
                          ImageBufAlgo::on_hierarchy::feature_lowpass(lowpass, image, by_fraction, {}, threads));
            EXPECT_FILTER(enhanced, ImageBufAlgo::on_hierarchy::detail_enhance(enhanced, image, {}, {}, threads));
            EXPECT_FILTER(level, ImageBufAlgo::on_hierarchy::level_image(level, image, of_level, {}, threads));
            const std::vector<std::vector<float>> now { pixels(lowpass), pixels(enhanced), pixels(level) };
            if (first.empty())
                first = now;
            for (std::size_t k = 0; k < now.size(); ++k)
                EXPECT_TRUE(identical(now[k], first[k])) << options.mesh << ", " << threads << " threads, " << k;
        }
    }
}

}  // namespace
}  // namespace pimg
