// SPDX-License-Identifier: BSD-3-Clause
// What decides the mesh: colour guides keep edges that luma does not see, and weights say which channel matters.
#include <cmath>

#include <pimg/imagebufalgo.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;

/// Discs of opposite colour on grey and all of one luma (54 R + 183 G + 19 B), with a little shading.
ImageBuf equal_luma_discs()
{
    ImageBuf buf(OIIO::ImageSpec(128, 96, 3, OIIO::TypeUInt8));
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x) {
            const float r = std::hypot(float(x % 43) - 21.0f, float(y % 48) - 24.0f);
            const float sign = (x / 43 + y / 48) % 2 ? -1.0f : 1.0f, amount = r < 15.0f ? 0.25f * sign : 0.0f;
            const float shade = 0.5f + 0.0005f * float(x);
            const float p[3] = { shade + amount, shade - amount * 54.0f / 183.0f, shade };
            buf.setpixel(x, y, p);
        }
    return buf;
}

double psnr(const ImageBuf& a, const ImageBuf& b, int channel = -1)
{
    const std::vector<float> p = pixels(a), q = pixels(b);
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i)
        if (channel < 0 || int(i % 3) == channel) {
            sum += double(p[i] - q[i]) * double(p[i] - q[i]);
            ++count;
        }
    return 10.0 * std::log10(count / sum);
}

ImageBuf level_of(const ImageBuf& src, const BuildOptions& options, float fraction)
{
    ProgressiveImage progressive;
    EXPECT_TRUE(progressive.build(src, options)) << progressive.error();
    LevelOptions level;
    level.fraction = fraction;
    ImageBuf dst(OIIO::ImageSpec(src.spec().width, src.spec().height, src.nchannels(), OIIO::TypeFloat));
    EXPECT_FILTER(dst, ImageBufAlgo::level_image(dst, progressive, level));
    return dst;
}

BuildOptions guided(const std::string& guide, const std::string& weights = "")
{
    BuildOptions options;
    options.guide = guide;
    options.weights = weights;
    return options;
}

TEST(Guide, ColourGuidesKeepEdgesOfEqualLuma)
{
    const ImageBuf src = equal_luma_discs();
    const double luma = psnr(src, level_of(src, guided("luma"), 0.02f));
    EXPECT_GE(psnr(src, level_of(src, guided("rgb"), 0.02f)), luma + 6.0);
    EXPECT_GE(psnr(src, level_of(src, guided("lab"), 0.02f)), luma + 6.0);
}

TEST(Guide, EveryGuideReturnsTheSourceAtTheFinestLevel)
{
    for (const OIIO::TypeDesc& type : { OIIO::TypeUInt8, OIIO::TypeFloat })
        for (int channels : { 1, 2, 3, 4 })
            for (const char* guide : { "luma", "log", "rgb", "lab" }) {
                const ImageBuf src = hdr_scene(40, 30, type, channels, type == OIIO::TypeFloat ? 1.0f : 0.02f);
                ProgressiveImage progressive;
                ASSERT_TRUE(progressive.build(src, guided(guide))) << progressive.error();
                EXPECT_EQ(progressive.stats().guide, guide);
                DetailEnhanceOptions neutral;
                neutral.gain = 1.0f;
                ImageBuf dst;
                EXPECT_FILTER(dst, ImageBufAlgo::detail_enhance(dst, progressive, neutral));
                const std::vector<float> a = pixels(src), b = pixels(dst);
                for (std::size_t i = 0; i < a.size(); ++i)
                    ASSERT_NEAR(b[i], a[i], 1e-6f * (1.0f + a[i])) << guide << " " << channels;
            }
}

TEST(Guide, TheChannelThatWeighsMoreIsKeptBetter)
{
    ImageBuf src(OIIO::ImageSpec(96, 64, 3, OIIO::TypeUInt8));
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            const float p[3] = { scene(x, y, 96, 64) / 255.0f, 0.5f, scene(95 - x, 63 - y, 96, 64) / 255.0f };
            src.setpixel(x, y, p);
        }
    const ImageBuf red = level_of(src, guided("rgb", "30,1,1"), 0.05f),
                   blue = level_of(src, guided("rgb", "1,1,30"), 0.05f);
    EXPECT_GT(psnr(src, red, 0), psnr(src, blue, 0) + 1.0);
    EXPECT_GT(psnr(src, blue, 2), psnr(src, red, 2) + 1.0);
}

TEST(Guide, WeightsAreCheckedAgainstTheGuide)
{
    const ImageBuf src = hdr_scene(16, 16);
    for (const auto& [guide, weights] : { std::pair("rgb", "1,2"),
                                          { "rgb", "1,2,0" },
                                          { "rgb", "1,x,1" },
                                          { "rgb", "1,1,1," },
                                          { "luma", "1,1,1" },
                                          { "lab", "1,-1,1" } }) {
        ProgressiveImage progressive;
        EXPECT_FALSE(progressive.build(src, guided(guide, weights))) << weights;
        EXPECT_NE(progressive.error().find("weights="), std::string::npos) << progressive.error();
    }
}

}  // namespace
}  // namespace pimg
