// SPDX-License-Identifier: BSD-3-Clause
// Smoothing and enhancement by strength on ImageBuf; what smoothing itself does is tests/core/smoothing_test.cpp.
#include <cmath>

#include <pimg/imagebufalgo.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;

FeatureLowpassOptions by(float strength, bool log = false)
{
    FeatureLowpassOptions options;
    options.strength = strength;
    options.log = log;
    return options;
}

std::vector<float> lowpass(const ImageBuf& src, const FeatureLowpassOptions& options)
{
    ImageBuf dst;
    EXPECT_FILTER(dst, ImageBufAlgo::feature_lowpass(dst, src, options));
    return pixels(dst);
}

TEST(Strength, ZeroIsTheSource)
{
    for (int channels : { 1, 2, 3, 4 }) {
        const ImageBuf src = hdr_scene(60, 40, OIIO::TypeFloat, channels);
        EXPECT_TRUE(identical(lowpass(src, by(0.0f)), pixels(src))) << channels;
        EXPECT_TRUE(identical(lowpass(src, by(0.0f, true)), pixels(src))) << channels;
    }
}

TEST(Strength, IsTheDefaultWay)
{
    const ImageBuf src = hdr_scene();
    EXPECT_TRUE(identical(lowpass(src, {}), lowpass(src, by(0.03f))));
    FeatureLowpassOptions log;
    log.log = true;
    EXPECT_TRUE(identical(lowpass(src, log), lowpass(src, by(0.3f, true))));
}

TEST(Strength, LogarithmsFollowTheScaleOfThePicture)
{
    const std::vector<float> a = lowpass(hdr_scene(), by(0.2f, true));
    const std::vector<float> b = lowpass(hdr_scene(96, 64, OIIO::TypeFloat, 3, 4096.0f), by(0.2f, true));
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_NEAR(a[i], b[i] / 4096.0f, 1e-3f * a[i]);
}

TEST(Strength, LogarithmsSmoothDarkAndBrightAlike)
{
    // The texture of hdr_scene() is a tenth of the light, everywhere.
    const std::vector<float> before = pixels(hdr_scene()), after = lowpass(hdr_scene(), by(0.2f, true));
    const auto roughness = [](const std::vector<float>& p, int x0, int y0) {
        double sum = 0.0;
        for (int y = y0; y < y0 + 8; ++y)
            for (int x = x0; x < x0 + 8; ++x) {
                const std::size_t i = 3 * std::size_t(y * 96 + x);
                sum += std::fabs(std::log2(double(p[i + 3]) / double(p[i])));
            }
        return sum;
    };
    EXPECT_LT(roughness(after, 75, 50), 0.2 * roughness(before, 75, 50));  // shade
    EXPECT_LT(roughness(after, 45, 25), 0.2 * roughness(before, 45, 25));  // window
}

TEST(Strength, NoiseFollowsTheScaleOfThePicture)
{
    FeatureLowpassOptions options;
    options.noise = 2.0f;
    const std::vector<float> a = lowpass(hdr_scene(), options);
    const std::vector<float> b = lowpass(hdr_scene(96, 64, OIIO::TypeFloat, 3, 1024.0f), options);
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_EQ(a[i], b[i] / 1024.0f);
}

TEST(Strength, NegativeBlackAndHugeSamplesStayFinite)
{
    ImageBuf src = hdr_scene();
    int i = 0;
    for (float v : { -0.5f, 0.0f, -0.0f, 1e-42f, 3e38f, -3e38f }) {
        const float pixel[3] = { v, v, 0.1f };
        src.setpixel(src.xbegin() + 10 + 3 * i++, src.ybegin() + 20, pixel);
    }
    for (bool log : { false, true })
        for (float v : lowpass(src, by(0.2f, log)))
            ASSERT_TRUE(std::isfinite(v)) << log;
}

TEST(Strength, OnlyOneWayAtATime)
{
    const ImageBuf src = hdr_scene(20, 20);
    const auto refused = [&](const FeatureLowpassOptions& options) {
        ImageBuf dst;
        EXPECT_FALSE(ImageBufAlgo::feature_lowpass(dst, src, options));
        return dst.geterror();
    };
    FeatureLowpassOptions options = by(0.1f);
    options.noise = 2.0f;
    EXPECT_NE(refused(options).find("noise"), std::string::npos);
    options = by(0.1f);
    options.splits = 10;
    EXPECT_NE(refused(options).find("strength"), std::string::npos);
    DetailEnhanceOptions enhance;
    enhance.strength = 0.1f;
    enhance.from = 0.5f;
    ImageBuf dst;
    EXPECT_FALSE(ImageBufAlgo::detail_enhance(dst, src, enhance));
    EXPECT_NE(dst.geterror().find("from"), std::string::npos);
}

/// A textured wall to the right, a smooth one to the left, and the same noise on both.
ImageBuf noisy_walls()
{
    ImageBuf src = picture(160, 96, 3, OIIO::TypeFloat);
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 160; ++x) {
            float deviate = -6.0f;  // nearly normal
            for (std::uint32_t k = 0; k < 12; ++k)
                deviate += noise(std::uint32_t(x), std::uint32_t(y), k);
            const float texture = x < 80 ? 0.0f : 0.15f * float(((x / 5) + (y / 5)) % 2);
            const float light = 0.3f + texture + 0.01f * deviate, rgb[3] = { light, light, light };
            src.setpixel(src.xbegin() + x, src.ybegin() + y, rgb);
        }
    return src;
}

TEST(Strength, EnhancementLeavesNoiseAsItIs)
{
    const ImageBuf src = noisy_walls();
    const auto deviation = [](const ImageBuf& buf, int x0) {
        const std::vector<float> p = pixels(buf);
        double sum = 0.0, squares = 0.0;
        for (int y = 10; y < 86; ++y)
            for (int x = x0; x < x0 + 60; ++x) {
                const double v = double(p[3 * std::size_t(y * 160 + x)]);
                sum += v;
                squares += v * v;
            }
        return std::sqrt(squares / (60 * 76) - sum * sum / (60.0 * 76 * 60 * 76));
    };
    for (const float strength : { -1.0f, 0.2f }) {  // by position, by strength
        DetailEnhanceOptions options;
        options.gain = 3.0f;
        options.strength = strength;
        ImageBuf calm, plain;
        EXPECT_FILTER(calm, ImageBufAlgo::detail_enhance(calm, src, options));
        options.denoise = 0.0f;
        EXPECT_FILTER(plain, ImageBufAlgo::detail_enhance(plain, src, options));
        EXPECT_LT(deviation(calm, 10), 1.3 * deviation(src, 10)) << strength;
        EXPECT_GT(deviation(plain, 10), 1.8 * deviation(src, 10)) << strength;
        EXPECT_GT(deviation(calm, 95), 0.85 * deviation(plain, 95)) << strength;
    }
}

}  // namespace
}  // namespace pimg
