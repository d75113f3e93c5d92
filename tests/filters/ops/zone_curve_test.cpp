// SPDX-License-Identifier: BSD-3-Clause
// The equaliser of tone mapping: zones of exposure and sizes of features.
#include <algorithm>
#include <cmath>

#include <pimg/imagebufalgo.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;

constexpr float kPi = 3.14159265f;
constexpr int kWidth = 160, kHeight = 96;

/// Flat shade to the left, middle grey, flat light to the right, with edges between them and a little texture.
ImageBuf three_zones(float texture)
{
    ImageBuf src = picture(kWidth, kHeight, 3, OIIO::TypeFloat);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float stops = x < 50 ? -6.0f : x < 110 ? 0.0f : 5.0f;
            const float light = 0.18f * std::exp2(stops + texture * (noise(std::uint32_t(x), std::uint32_t(y)) - 0.5f));
            const float rgb[3] = { light, light, light };
            src.setpixel(x, y, rgb);
        }
    return src;
}

std::vector<float> gain_of(const ProgressiveImage& image, HdrCompressOptions options)
{
    options.output = "gain";
    ImageBuf dst;
    EXPECT_FILTER(dst, ImageBufAlgo::hdr_compress(dst, image, options));
    return pixels(dst);
}

class Zones : public testing::Test {
protected:
    Zones() { EXPECT_TRUE(m_image.build(three_zones(0.1f))) << m_image.error(); }

    /// How far each pixel is raised.
    std::vector<float> raised(const HdrCompressOptions& options) const
    {
        std::vector<float> more = gain_of(m_image, options);
        HdrCompressOptions plain;
        plain.s0 = options.s0;
        plain.key = options.key;
        const std::vector<float> before = gain_of(m_image, plain);
        for (std::size_t i = 0; i < more.size(); ++i)
            more[i] -= before[i];
        return more;
    }

    ProgressiveImage m_image;
};

float at(const std::vector<float>& values, int x, int y = kHeight / 2)
{
    return values[std::size_t(y * kWidth + x)];
}

TEST_F(Zones, ShadowsAreRaisedUpToTheirEdges)
{
    HdrCompressOptions options;
    options.shadows = 2.0f;
    const std::vector<float> more = raised(options);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (x < 50)
                ASSERT_NEAR(at(more, x, y), 2.0f, 0.1f) << x << " " << y;
            else  // 1 % of the step
                ASSERT_NEAR(at(more, x, y), 0.0f, 0.02f) << x << " " << y;
        }
}

TEST_F(Zones, HighlightsAndMidtones)
{
    HdrCompressOptions options;
    options.s0 = 0.4f;
    options.key = std::pow(0.18f, options.s0);  // middle grey of the scene
    options.highlights = -1.5f;
    options.midtones = 0.5f;
    const std::vector<float> more = raised(options);
    EXPECT_NEAR(at(more, 20), 0.0f, 0.05f);
    EXPECT_NEAR(at(more, 80), 0.5f, 0.05f);
    EXPECT_NEAR(at(more, 140), -1.5f, 0.05f);
}

TEST_F(Zones, ACurveSaysTheSameAsTheWords)
{
    HdrCompressOptions words, curve;
    words.shadows = 1.0f;
    curve.zones = "-3:+1,-2.9:0";
    const std::vector<float> a = raised(words), b = raised(curve);
    EXPECT_NEAR(at(a, 20), at(b, 20), 0.02f);
    EXPECT_NEAR(at(b, 140), 0.0f, 1e-4f);
}

TEST_F(Zones, BadCurvesAreErrors)
{
    for (const char* text : { "1", "0:1,0:2", "2:1,1:1", "0:nan", "0:1,", "a:b", "0:20", "-100:1", "0:1;1:2", ":" }) {
        HdrCompressOptions options;
        options.zones = text;
        ImageBuf dst;
        EXPECT_FALSE(ImageBufAlgo::hdr_compress(dst, m_image, options)) << text;
        EXPECT_NE(dst.geterror().find("zones"), std::string::npos) << text;
    }
    HdrCompressOptions both;
    both.zones = "0:1";
    both.shadows = 1.0f;
    ImageBuf dst;
    EXPECT_FALSE(ImageBufAlgo::hdr_compress(dst, m_image, both));
}

/// Waves of one length; those of one pixel are single dots.
ImageBuf features(int size)
{
    ImageBuf src = picture(256, 256, 3, OIIO::TypeFloat);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) {
            const float wave = size > 1
                ? std::cos(kPi * float(x) / float(size)) * std::cos(kPi * float(y) / float(size))
                : float(x % 5 == 0 && y % 4 == 0);
            const float light = 0.18f * std::exp2(0.1f * wave);
            const float rgb[3] = { light, light, light };
            src.setpixel(x, y, rgb);
        }
    return src;
}

/// How far a setting raises the contrast of waves: the standard deviation of what it adds.
double response(int size, float HdrCompressOptions::*member)
{
    ProgressiveImage image;
    BuildOptions build;
    build.base = 8;  // so that the largest features are none of the base mesh
    EXPECT_TRUE(image.build(features(size), build)) << image.error();
    HdrCompressOptions options;
    options.denoise = 0.0f;
    options.dmax = 7.2f;  // not that of the waves alone
    const std::vector<float> before = gain_of(image, options);
    options.*member = 1.0f;
    const std::vector<float> after = gain_of(image, options);
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < after.size(); ++i) {
        const double d = double(after[i]) - double(before[i]);
        sum += d;
        squares += d * d;
    }
    const double n = double(after.size());
    return std::sqrt(squares / n - sum * sum / (n * n));
}

TEST(Sizes, EachSettingRaisesFeaturesOfItsSize)
{
    const auto fine = &HdrCompressOptions::fine, medium = &HdrCompressOptions::medium,
               coarse = &HdrCompressOptions::coarse;
    EXPECT_GT(response(1, fine), 3.0 * std::max(response(1, medium), response(1, coarse)));
    EXPECT_GT(response(16, medium), 3.0 * std::max(response(16, fine), response(16, coarse)));
    EXPECT_GT(response(100, coarse), 3.0 * response(100, fine));
}

TEST(Sizes, LargeEdgesAreLeftAsTheyAre)
{
    ProgressiveImage image;
    ASSERT_TRUE(image.build(three_zones(0.0f))) << image.error();
    const std::vector<float> plain = gain_of(image, {});
    for (const auto member : { &HdrCompressOptions::fine, &HdrCompressOptions::medium, &HdrCompressOptions::coarse }) {
        HdrCompressOptions options;
        options.*member = 1.0f;
        const std::vector<float> raised = gain_of(image, options);
        for (std::size_t i = 0; i < plain.size(); ++i)
            ASSERT_NEAR(raised[i], plain[i], 0.1f) << i % kWidth;
    }
}

TEST(Sizes, WithoutCoherenceToo)
{
    ProgressiveImage image;
    ASSERT_TRUE(image.build(features(1))) << image.error();
    HdrCompressOptions plain;
    plain.coherence = 0.0f;
    plain.dmax = 7.2f;
    HdrCompressOptions raised = plain;
    raised.fine = 1.0f;
    const std::vector<float> a = gain_of(image, plain), b = gain_of(image, raised);
    const std::size_t middle = 128 * 256 + 130;  // a dot
    const double before = double(a[middle]) - double(a[middle + 1]), after = double(b[middle]) - double(b[middle + 1]);
    EXPECT_GT(std::fabs(after - before), 0.05) << "the contrast of 0.1 stops becomes twice as large";
}

}  // namespace
}  // namespace pimg
