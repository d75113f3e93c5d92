// SPDX-License-Identifier: BSD-3-Clause
// Pictures built for a quick look (BuildOptions::preview).
#include "source/preview.h"

#include <algorithm>
#include <cmath>

#include <pimg/imagebufalgo.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;

BuildOptions for_preview()
{
    BuildOptions options;
    options.preview = true;
    return options;
}

ImageBuf compressed(const ImageBuf& src, const BuildOptions& build, const HdrCompressOptions& options = {},
                    int threads = 0)
{
    ProgressiveImage image;
    EXPECT_TRUE(image.build(src, build, threads)) << image.error();
    return ImageBufAlgo::hdr_compress(image, options, {}, threads);
}

TEST(Preview, IsNearlyTheFinalPictureAlsoAtEdges)
{
    const ImageBuf src = hdr_scene(512, 384);
    const std::vector<float> quick = lightness(compressed(src, for_preview())), whole = lightness(compressed(src, {}));
    double sum = 0.0, at_edges = 0.0;
    std::size_t edges = 0;
    for (int y = 2; y < 382; ++y)
        for (int x = 2; x < 510; ++x) {
            const std::size_t i = std::size_t(y) * 512 + std::size_t(x);
            const double difference = std::fabs(quick[i] - whole[i]);
            sum += difference;
            // Within two pixels of a step of 10 L*.
            if (std::fabs(whole[i + 2] - whole[i - 2]) > 10.0f
                || std::fabs(whole[i + 1024] - whole[i - 1024]) > 10.0f) {
                at_edges += difference;
                ++edges;
            }
        }
    ASSERT_GT(edges, 1000u);
    EXPECT_LT(sum / double(380 * 508), 0.5);
    EXPECT_LT(at_edges / double(edges), 1.0);
}

TEST(Preview, IsBuiltFromAQuarterOfThePixelsOrFewer)
{
    ProgressiveImage image;
    ASSERT_TRUE(image.build(hdr_scene(301, 200), for_preview()));
    EXPECT_EQ(image.hierarchy().vertices(), 151u * 100u);
    EXPECT_EQ(image.spec().width, 301);
    EXPECT_EQ(preview_step(1920, 1080), 2);
    EXPECT_EQ(preview_step(3840, 2160), 4);
    EXPECT_EQ(preview_step(60, 4000), 1);
    EXPECT_EQ(preview_step(1 << 20, 70), 2);
}

TEST(Preview, AnySizeAndAlphaAreTaken)
{
    for (const auto& [width, height] : { std::pair { 1, 1 }, { 1, 70 }, { 65, 64 }, { 67, 129 }, { 400, 3 } })
        for (int channels : { 1, 3, 4 }) {
            const ImageBuf src = hdr_scene(width, height, OIIO::TypeHalf, channels);
            const ImageBuf result = compressed(src, for_preview());
            EXPECT_FALSE(result.has_error()) << result.geterror();
            for (float value : pixels(result))
                ASSERT_TRUE(std::isfinite(value)) << width << " x " << height << ", " << channels;
        }
}

TEST(Preview, TooSmallToBeReducedItIsTheFinalPicture)
{
    const ImageBuf src = hdr_scene(60, 40);
    BuildOptions log;
    log.guide = "log";
    EXPECT_TRUE(identical(pixels(compressed(src, for_preview())), pixels(compressed(src, log))));
}

TEST(Preview, SettingsAndOutputsWork)
{
    const ImageBuf src = hdr_scene(256, 200);
    HdrCompressOptions options;
    options.output = "gain";
    options.shadows = 1.0f;
    options.fine = 1.0f;
    const std::vector<float> quick = pixels(compressed(src, for_preview(), options)),
                             whole = pixels(compressed(src, {}, options));
    ASSERT_EQ(quick.size(), whole.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < quick.size(); ++i)
        sum += std::fabs(double(quick[i]) - double(whole[i]));
    EXPECT_LT(sum / double(quick.size()), 0.1);  // stops
}

TEST(Preview, ThreadsDoNotChangeABit)
{
    const ImageBuf src = hdr_scene(300, 220);
    EXPECT_TRUE(
        identical(pixels(compressed(src, for_preview(), {}, 1)), pixels(compressed(src, for_preview(), {}, 4))));
}

TEST(Preview, PanoramasHaveNoSeam)
{
    ImageBuf src(OIIO::ImageSpec(256, 128, 3, OIIO::TypeFloat));
    for (OIIO::ImageBuf::Iterator<float> it(src); !it.done(); ++it)
        for (int c = 0; c < 3; ++c)
            it[c] = std::exp2(4.0f * std::sin(float(it.x()) * 6.2831853f / 256.0f + 0.5f) + 0.1f * float(it.y() % 7));
    BuildOptions options = for_preview();
    options.wrap = "x";
    const std::vector<float> light = lightness(compressed(src, options));
    ASSERT_EQ(light.size(), 256u * 128u);
    float seam = 0.0f, elsewhere = 0.0f;
    for (std::size_t y = 0; y < 128; ++y)
        for (std::size_t x = 0; x < 256; ++x) {
            const float step = std::fabs(light[y * 256 + x] - light[y * 256 + (x + 1) % 256]);
            (x == 255 ? seam : elsewhere) += x == 255 ? step : step / 255.0f;
        }
    EXPECT_LT(seam, 2.0f * elsewhere);
}

TEST(Preview, OtherFiltersAndFilesRefuseIt)
{
    const ImageBuf src = hdr_scene(200, 100);
    ProgressiveImage image;
    ASSERT_TRUE(image.build(src, for_preview()));
    for (const ImageBuf& result :
         { ImageBufAlgo::level_image(image), ImageBufAlgo::segment(image), ImageBufAlgo::paint(image) }) {
        EXPECT_TRUE(result.has_error());
        EXPECT_NE(result.geterror().find("preview: expected hdr_compress"), std::string::npos);
    }
    const ProgressiveImage stored = image.unwrapped(src);
    EXPECT_FALSE(stored.initialized());
    EXPECT_NE(stored.error().find("preview"), std::string::npos);
}

TEST(Preview, EnlargingWhatIsALineOverTheGuideIsExact)
{
    Raster guide { 90, 70, {} };
    for (int i = 0; i < 90 * 70; ++i)
        guide.samples.push_back(float((i * 7919) % 1000) * 0.1f);
    const Raster small = reduced(guide, 2, {});
    std::vector<float> of_small, result(guide.samples.size());
    for (float g : small.samples)
        of_small.push_back(0.5f * g + 3.0f);
    enlarge(small, of_small, 2, guide, 0.5f, {}, result);
    for (std::size_t i = 0; i < result.size(); ++i)
        ASSERT_NEAR(result[i], 0.5f * guide.samples[i] + 3.0f, 1e-3f) << i;
}

}  // namespace
}  // namespace pimg
