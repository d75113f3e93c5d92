// SPDX-License-Identifier: BSD-3-Clause
// Filters on pictures built from a simpler initial mesh: the residual is their finest band.
#include <cmath>

#include <OpenImageIO/imagebufalgo.h>

#include <pimg/imagebufalgo.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;

BuildOptions adaptive(const std::string& guide = "", const std::string& control = "gradient")
{
    BuildOptions options;
    options.mesh = "adaptive";
    options.guide = guide;
    options.control = control;
    return options;
}

double mean_difference(const ImageBuf& a, const ImageBuf& b)
{
    const std::vector<float> p = pixels(a), q = pixels(b);
    double sum = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i)
        sum += double(std::fabs(p[i] - q[i]));
    return sum / double(p.size());
}

TEST(Adaptive, NeutralSettingsReturnTheSource)
{
    for (const OIIO::TypeDesc& type : { OIIO::TypeUInt8, OIIO::TypeUInt16, OIIO::TypeHalf, OIIO::TypeFloat })
        for (int channels : { 1, 3, 4, 5 })
            for (const char* guide : { "luma", "rgb", "log" }) {
                const ImageBuf src = hdr_scene(60, 40, type, channels, type.is_floating_point() ? 1.0f : 0.02f);
                ProgressiveImage p;
                ASSERT_TRUE(p.build(src, adaptive(guide))) << p.error();
                EXPECT_LT(p.hierarchy().vertices(), 60u * 40u / 2u);
                ImageBuf low, enhanced, compressed;
                FeatureLowpassOptions all;
                all.fraction = 1.0f;
                DetailEnhanceOptions once;
                once.gain = 1.0f;
                HdrCompressOptions identity;
                identity.s0 = 1.0f;
                identity.fit = false;
                EXPECT_FILTER(low, ImageBufAlgo::feature_lowpass(low, p, all));
                EXPECT_FILTER(enhanced, ImageBufAlgo::detail_enhance(enhanced, p, once));
                const std::vector<float> a = pixels(src), b = pixels(low), c = pixels(enhanced);
                for (std::size_t i = 0; i < a.size(); ++i) {
                    ASSERT_NEAR(a[i], b[i], type.is_floating_point() ? 1e-6f * 550.0f : 0.0f) << type << channels;
                    ASSERT_EQ(a[i], c[i]) << type << channels;
                }
                if (!type.is_floating_point())
                    continue;
                EXPECT_FILTER(compressed, ImageBufAlgo::hdr_compress(compressed, p, identity));
                const std::vector<float> d = pixels(compressed);
                for (std::size_t i = 0; i < a.size(); ++i)
                    ASSERT_NEAR(a[i], d[i], 2e-5f * (1.0f + std::fabs(a[i]))) << type << channels;
            }
}

TEST(Adaptive, LowpassDropsTheResidualAndEnhancementAmplifiesIt)
{
    const ImageBuf src = hdr_scene(120, 90);
    ProgressiveImage p;
    ASSERT_TRUE(p.build(src, adaptive("luma"))) << p.error();
    const Level all = p.hierarchy().levels();
    FeatureLowpassOptions but_one;
    but_one.splits = int(all) - 1;
    DetailEnhanceOptions residual_only;
    residual_only.gain = 2.0f;
    residual_only.from = float(all);
    residual_only.to = float(all);
    const ImageBuf low = ImageBufAlgo::feature_lowpass(p, but_one), mesh = ImageBufAlgo::level_image(p);
    const ImageBuf enhanced = ImageBufAlgo::detail_enhance(p, residual_only);
    EXPECT_LT(mean_difference(low, mesh), 0.01 * mean_difference(src, mesh));
    // picture + (picture - mesh) is what a residual twice as large gives.
    const std::vector<float> s = pixels(src), m = pixels(mesh), e = pixels(enhanced);
    for (std::size_t i = 0; i < s.size(); ++i)
        ASSERT_NEAR(e[i], 2.0f * s[i] - m[i], 1e-3f * (1.0f + std::fabs(s[i])));
}

TEST(Adaptive, ToneMappingIsVisiblyThatOfTheFullMesh)
{
    const ImageBuf src = hdr_scene(200, 150);
    ProgressiveImage full, third;
    ASSERT_TRUE(full.build(src));
    ASSERT_TRUE(third.build(src, adaptive()));
    const std::vector<float> a = lightness(ImageBufAlgo::hdr_compress(full));
    const std::vector<float> b = lightness(ImageBufAlgo::hdr_compress(third));
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += double(std::fabs(a[i] - b[i]));
    EXPECT_LT(sum / double(a.size()), 2.0);
}

TEST(Adaptive, ControlMapFromAFile)
{
    ImageBuf map(OIIO::ImageSpec(64, 48, 1, OIIO::TypeUInt8));
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const float value = x < 32 ? 1.0f : 0.0f;
            map.setpixel(x, y, &value);
        }
    ASSERT_TRUE(map.write("adaptive_control.tif"));
    const ImageBuf src = hdr_scene(64, 48);
    ProgressiveImage p;
    ASSERT_TRUE(p.build(src, adaptive("", "adaptive_control.tif"))) << p.error();
    std::size_t left = 0;
    for (Index pixel : p.hierarchy().pixels)
        left += pixel % 64 < 32;
    EXPECT_GT(left, 8 * (p.hierarchy().vertices() - left));
    EXPECT_FALSE(p.build(hdr_scene(65, 48), adaptive("", "adaptive_control.tif")));
    EXPECT_FALSE(p.build(src, adaptive("", "nothing_there.tif")));
    EXPECT_NE(p.error().find("gradient, curvature or an image file"), std::string::npos) << p.error();
}

TEST(Adaptive, OnePixelWideAndStopping)
{
    ProgressiveImage p;
    ASSERT_TRUE(p.build(hdr_scene(1, 9), adaptive())) << p.error();
    ASSERT_TRUE(p.build(hdr_scene(9, 1), adaptive())) << p.error();
    ASSERT_TRUE(p.build(hdr_scene(2, 2), adaptive())) << p.error();
    EXPECT_FALSE(p.build(hdr_scene(80, 80), adaptive(), 0, [](float) { return false; }));
}

}  // namespace
}  // namespace pimg
