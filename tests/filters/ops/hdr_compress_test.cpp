// SPDX-License-Identifier: BSD-3-Clause
// Tone mapping: Eq. (2), scale, colour, edges, and pictures with something wrong in them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <OpenImageIO/imagebufalgo.h>
#include <pimg/imagebufalgo.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;

ImageBuf compressed(const ImageBuf& src, const HdrCompressOptions& options = {})
{
    ImageBuf dst;
    EXPECT_FILTER(dst, ImageBufAlgo::hdr_compress(dst, src, options));
    return dst;
}

TEST(HdrCompress, IsDisplayLinear)
{
    const ImageBuf dst = compressed(hdr_scene());
    EXPECT_EQ(dst.spec().format, OIIO::TypeFloat);
    for (float v : pixels(dst)) {
        ASSERT_GE(v, 0.0f);
        ASSERT_LE(v, 1.0f);
    }
    const std::vector<float> l = lightness(dst);
    EXPECT_GT(*std::max_element(l.begin(), l.end()), 80.0f);
    std::vector<float> sorted = l;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_GT(sorted[sorted.size() / 2], 20.0f);
    EXPECT_LT(sorted[sorted.size() / 2], 80.0f);
}

/// A display of Display P3 shows a green that one of Rec. 709 cannot, and other colours alike.
TEST(HdrCompress, GamutOfTheDisplay)
{
    ImageBuf src = picture(64, 48, 3, OIIO::TypeFloat);
    for (ImageBuf::Iterator<float> p(src); !p.done(); ++p) {
        const bool vivid = p.x() < 20;
        const float light = p.x() > 40 ? 4.0f : 0.3f;
        p[0] = vivid ? -0.1f * light : light;
        p[1] = light;
        p[2] = vivid ? -0.03f * light : 0.8f * light;
    }
    HdrCompressOptions options;
    options.gamut = "p3";
    const ImageBuf narrow = compressed(src), wide = compressed(src, options);
    for (ImageBuf::ConstIterator<float> n(narrow), w(wide); !n.done(); ++n, ++w) {
        EXPECT_GE(std::min({ n[0], n[1], n[2] }), 0.0f);
        EXPECT_TRUE(n.x() < 20 || n[0] == w[0]);
        const float red = 0.8224620f * w[0] + 0.1775380f * w[1];  // of Display P3
        EXPECT_GE(red, -1e-5f);
        EXPECT_LE(std::max({ red, w[1], w[2] }), 1.0f);
    }
    EXPECT_LT(wide.getchannel(10, 20, 0, 0), -0.005f);
}

/// An HDR display shows the same picture up to white, and highlights beyond it.
TEST(HdrCompress, PeakOfTheDisplay)
{
    const ImageBuf src = hdr_scene();
    const std::vector<float> sdr = pixels(compressed(src));
    float before = *std::max_element(sdr.begin(), sdr.end());
    EXPECT_LE(before, 1.0f);
    for (const float nits : { 400.0f, 1000.0f, 4000.0f }) {
        HdrCompressOptions options;
        options.peak = nits;
        const std::vector<float> hdr = pixels(compressed(src, options));
        const float most = *std::max_element(hdr.begin(), hdr.end());
        EXPECT_GT(most, before);
        EXPECT_LE(most, nits / 203.0f * 1.00001f);
        for (std::size_t i = 0; i < sdr.size(); i += 3) {
            const float luminance = 0.2126f * sdr[i] + 0.7152f * sdr[i + 1] + 0.0722f * sdr[i + 2];
            for (std::size_t c = 0; luminance < 0.2f && c < 3; ++c)
                ASSERT_NEAR(hdr[i + c], sdr[i + c], 0.02f) << nits;
        }
        before = most;
    }
}

TEST(HdrCompress, ScaleOfTheInputDoesNotMatter)
{
    const std::vector<float> expected = lightness(compressed(hdr_scene()));
    for (float scale : { 0.25f, 2.0f, 1024.0f }) {
        const std::vector<float> l = lightness(compressed(hdr_scene(96, 64, OIIO::TypeFloat, 3, scale)));
        double sum = 0;
        for (std::size_t i = 0; i < l.size(); ++i)
            sum += std::fabs(l[i] - expected[i]);
        EXPECT_LT(sum / double(l.size()), 0.5) << scale;
    }
}

/// The scene between two borders that are together as large; value < 0: sensor noise.
ImageBuf bordered(float value)
{
    const ImageBuf scene = hdr_scene(256, 256);
    ImageBuf dst = picture(512, 256, 3, OIIO::TypeFloat);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 512; ++x) {
            float rgb[3] = { value, value, value };
            for (std::uint32_t c = 0; value < 0.0f && c < 3; ++c)
                rgb[c] = 1e-4f * noise(std::uint32_t(x), std::uint32_t(y), c);
            if (x >= 128 && x < 384)
                scene.getpixel(scene.xbegin() + x - 128, scene.ybegin() + y, rgb);
            dst.setpixel(x, y, rgb);
        }
    return dst;
}

/// log2 of the median luminance of the columns from `begin` on that show the scene.
float median_stops(const ImageBuf& dst, int begin)
{
    std::vector<float> stops;
    for (int y = dst.ybegin(); y < dst.ybegin() + 256; ++y)
        for (int x = begin; x < begin + 256; ++x)
            stops.push_back(std::log2(dst.getchannel(x, y, 0, 1)));
    std::nth_element(stops.begin(), stops.begin() + 32768, stops.end());
    return stops[32768];
}

TEST(HdrCompress, SurroundingsDoNotMoveTheExposure)
{
    const ImageBuf alone = compressed(hdr_scene(256, 256));
    const float expected = median_stops(alone, alone.xbegin());
    for (const float value : { 0.0f, 1.0f, 20.0f, -1.0f })
        EXPECT_NEAR(median_stops(compressed(bordered(value)), 128), expected, 0.3f) << value;
}

/// Half as large, by means of light.
ImageBuf reduced(const ImageBuf& src)
{
    ImageBuf dst = picture(src.spec().width / 2, src.spec().height / 2, 3, OIIO::TypeFloat);
    const std::vector<float> p = pixels(src);
    const std::size_t row = std::size_t(src.spec().width) * 3;
    std::vector<float> mean(std::size_t(dst.spec().image_pixels()) * 3);
    for (std::size_t y = 0, to = 0; y < std::size_t(dst.spec().height); ++y)
        for (std::size_t x = 0; x < std::size_t(dst.spec().width); ++x)
            for (std::size_t c = 0; c < 3; ++c, ++to) {
                const float* from = &p[2 * y * row + 6 * x + c];
                mean[to] = 0.25f * (from[0] + from[3] + from[row] + from[row + 3]);
            }
    dst.set_pixels(dst.roi(), OIIO::TypeFloat, mean.data());
    return dst;
}

double mean_difference(const ImageBuf& a, const ImageBuf& b)
{
    const std::vector<float> l = lightness(a), m = lightness(b);
    EXPECT_EQ(l.size(), m.size());
    double sum = 0;
    for (std::size_t i = 0; i < l.size(); ++i)
        sum += std::fabs(l[i] - m[i]);
    return sum / double(l.size());
}

/// A preview shows what the final picture will look like.
TEST(HdrCompress, ResolutionDoesNotMatter)
{
    const ImageBuf full = hdr_scene(448, 320), half = reduced(full), quarter = reduced(half);
    const ImageBuf expected = reduced(compressed(full));
    EXPECT_LT(mean_difference(compressed(half), expected), 0.5);
    EXPECT_LT(mean_difference(compressed(quarter), reduced(expected)), 1.0);
}

/// With dmax, key and white given, nothing of the picture decides how its parts are shown: tiles, pans, windows.
TEST(HdrCompress, AnchorsFixACrop)
{
    const ImageBuf src = hdr_scene(320, 240);
    HdrCompressOptions found;
    std::string error;
    ASSERT_TRUE(ImageBufAlgo::resolve_hdr_compress(src, found, error)) << error;
    HdrCompressOptions anchors;
    anchors.dmax = found.dmax;
    anchors.key = found.key;
    anchors.white = found.white;
    const OIIO::ROI all = src.roi();
    const OIIO::ROI window(all.xbegin + 40, all.xend - 40, all.ybegin + 30, all.yend - 30, 0, 1, 0, 3);
    const ImageBuf crop = OIIO::ImageBufAlgo::cut(src, window);
    const ImageBuf expected = OIIO::ImageBufAlgo::cut(compressed(src), window);
    EXPECT_LT(mean_difference(compressed(crop, anchors), expected), 0.5);
    // Left alone, the crop is exposed for itself.
    EXPECT_GT(mean_difference(compressed(crop), expected), 0.5);
    HdrCompressOptions again = anchors;
    ASSERT_TRUE(ImageBufAlgo::resolve_hdr_compress(crop, again, error)) << error;
    EXPECT_EQ(again.s0, found.s0);
    EXPECT_EQ(again.contrast, found.contrast);
}

/// Eq. (2) as printed, on a picture of one split's worth of structure: with coherence = 0, s0 scales base and details
/// that reach dmax, and small details stay.
TEST(HdrCompress, Equation2)
{
    const ImageBuf src = hdr_scene(64, 48, OIIO::TypeFloat, 1);
    HdrCompressOptions options;
    options.coherence = 0.0f;
    options.fit = false;
    options.s0 = 0.25f;
    options.beta = 0.0f;  // h = 1 for every detail below dmax: only the base is scaled
    options.dmax = 200.0f;
    const std::vector<float> a = pixels(src), b = pixels(compressed(src, options));
    options.beta = 1000.0f;  // h = s0 for every detail of note: everything is scaled
    options.dmax = 0.01f;
    const std::vector<float> c = pixels(compressed(src, options));
    // log2 of c is a quarter of log2 of a, up to the rounding of details far under 0.01 stops.
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_NEAR(std::log2(c[i]), 0.25f * std::log2(a[i]), 0.05f);
    // The base carries the coarse structure, so scaling it alone still narrows the range.
    const auto range = [](const std::vector<float>& v) {
        const auto [low, high] = std::minmax_element(v.begin(), v.end());
        return std::log2(*high / *low);
    };
    EXPECT_LT(range(c), 0.26f * range(a));
    EXPECT_GT(range(b), range(c));
}

/// Eq. (2) at several beta, computed here in double precision from the bands: with coherence = 0 each detail d becomes
/// h(d) d with h(d) = s0 + (1 - s0) (1 - |d| / dmax)^beta, and s0 d from dmax on; the base is scaled by s0.
TEST(HdrCompress, Equation2AtSeveralBeta)
{
    const ImageBuf src = hdr_scene(64, 48, OIIO::TypeFloat, 1);
    BuildOptions build;
    build.guide = "log";
    ProgressiveImage image;
    ASSERT_TRUE(image.build(src, build)) << image.error();
    const Hierarchy& hierarchy = image.hierarchy();
    const Bands& bands = image.guide_bands()[0];
    constexpr double kUnits = 12.75;  // guide units to a stop: progressive_image.h
    // The guide is log2(luminance / reference), reference a power of two.
    std::vector<float> guide(hierarchy.mesh_pixels()), expected(guide.size());
    synthesise(hierarchy, bands, guide.data());
    const std::vector<float> light = pixels(src);
    const double reference = std::round(std::log2(double(light[0])) - double(guide[0]) / kUnits);

    HdrCompressOptions options;
    options.coherence = 0.0f;
    options.fit = false;
    for (const float s0 : { 0.2f, 0.6f })
        for (const float dmax : { 0.5f, 4.0f })
            for (const float beta : { 0.5f, 1.0f, 3.0f, 12.0f }) {
                options.s0 = s0;
                options.dmax = dmax;
                options.beta = beta;
                const auto h = [&](float detail) {
                    const double rest = 1.0 - std::fabs(double(detail)) / (double(dmax) * kUnits);
                    const double gain = rest > 0.0 ? std::pow(rest, double(beta)) : 0.0;
                    return double(s0) + (1.0 - double(s0)) * gain;
                };
                Bands compressed_bands = bands;
                for (float& v : compressed_bands.base)
                    v *= s0;
                for (Detail& d : compressed_bands.details)
                    d = { float(h(d.t) * double(d.t)), float(h(d.u) * double(d.u)) };
                for (float& v : compressed_bands.residual)
                    v = float(h(v) * double(v));
                synthesise(hierarchy, compressed_bands, expected.data());
                ImageBuf dst;
                EXPECT_FILTER(dst, ImageBufAlgo::hdr_compress(dst, image, options));
                const std::vector<float> result = pixels(dst);
                for (std::size_t i = 0; i < result.size(); ++i)
                    ASSERT_NEAR(std::log2(double(result[i])), double(expected[i]) / kUnits + double(s0) * reference,
                                2e-3)
                        << "s0 " << s0 << ", dmax " << dmax << ", beta " << beta << ", pixel " << i;
            }
}

/// Ratios of channels change by one and the same power: that keeps the hue.
TEST(HdrCompress, HueIsKept)
{
    const ImageBuf src = hdr_scene();
    HdrCompressOptions options;
    options.denoise = 0.0f;  // colours do not fade
    const std::vector<float> a = pixels(src), b = pixels(compressed(src, options));
    for (std::size_t i = 0; i < a.size(); i += 3) {
        if (std::max({ b[i], b[i + 1], b[i + 2] }) > 0.6f)
            continue;  // near the limits of the display's gamut
        const float power = std::log(b[i + 1] / b[i]) / std::log(a[i + 1] / a[i]);
        ASSERT_NEAR(power, std::log(b[i + 2] / b[i]) / std::log(a[i + 2] / a[i]), 2e-2f);
        ASSERT_GT(power, 0.8f);
        ASSERT_LE(power, 1.0f);
    }
    HdrCompressOptions grey;
    grey.saturation = 0.0f;
    const std::vector<float> g = pixels(compressed(src, grey));
    for (std::size_t i = 0; i < g.size(); i += 3) {
        ASSERT_NEAR(g[i], g[i + 1], 1e-5f);
        ASSERT_NEAR(g[i], g[i + 2], 1e-5f);
    }
}

/// A step of three decades: the plateaus must stay flat right up to the edge.
TEST(HdrCompress, NoHaloBesideAStep)
{
    ImageBuf src = picture(128, 96, 1, OIIO::TypeFloat);
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x) {
            const float texture = std::pow(10.0f, 0.04f * std::sin(2.0f * 3.14159265f * (float(y) + 0.5f) / 8.0f));
            const float v = (x < 64 ? 0.1f : 100.0f) * texture;
            src.setpixel(x, y, &v);
        }
    const std::vector<float> l = lightness(compressed(src));
    std::vector<float> profile(128, 0.0f);
    for (int y = 16; y < 80; ++y)
        for (int x = 0; x < 128; ++x)
            profile[std::size_t(x)] += l[std::size_t(y * 128 + x)] / 64.0f;
    const float dark = profile[20], bright = profile[108], step = bright - dark;
    ASSERT_GT(step, 20.0f);
    for (std::size_t x = 8; x < 64; ++x)
        EXPECT_NEAR(profile[x], dark, 0.02f * step) << x;
    for (std::size_t x = 64; x < 120; ++x)
        EXPECT_NEAR(profile[x], bright, 0.02f * step) << x;
}

/// The rest of the picture must stay within 1 L* of the clean result, whatever is wrong with a few pixels.
TEST(HdrCompress, BadPixelsStayAlone)
{
    const ImageBuf clean = hdr_scene();
    const std::vector<float> expected = lightness(compressed(clean));
    constexpr float kInf = std::numeric_limits<float>::infinity();
    struct Case {
        const char* name;
        float value;
        int size;
    };
    for (const Case& bad : { Case { "NaN", std::nanf(""), 1 }, Case { "Inf", kInf, 1 }, Case { "-Inf", -kInf, 1 },
                             Case { "negatives", -0.01f, 4 }, Case { "1e30", 1e30f, 1 }, Case { "black", 0.0f, 1 } }) {
        ImageBuf src = clean;
        const float v[3] = { bad.value, bad.value, bad.value };
        for (int y = 0; y < bad.size; ++y)
            for (int x = 0; x < bad.size; ++x)
                src.setpixel(80 + x, 50 + y, v);
        const ImageBuf dst = compressed(src);
        for (float p : pixels(dst))
            ASSERT_TRUE(std::isfinite(p)) << bad.name;
        const std::vector<float> l = lightness(dst);
        float worst = 0.0f;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 96; ++x) {
                // Beside the bad ones the mesh itself differs.
                const bool near = std::abs(x + 5 - 80) < bad.size + 2 && std::abs(y - 2 - 50) < bad.size + 2;
                if (!near)
                    worst = std::max(worst, std::fabs(l[std::size_t(y * 96 + x)] - expected[std::size_t(y * 96 + x)]));
            }
        EXPECT_LT(worst, 1.0f) << bad.name;
    }
}

/// Pixels that outshine everything around them, as hot pixels and fireflies of renderers do, say nothing of the scene.
/// Two of them may touch.
TEST(HdrCompress, SingleBrightPixelsDoNotMoveTheExposure)
{
    HdrCompressOptions expected;
    std::string error;
    ASSERT_TRUE(ImageBufAlgo::resolve_hdr_compress(hdr_scene(), expected, error)) << error;
    const float bright[3] = { 1e4f, 1e4f, 1e4f };
    for (const auto& [dx, dy] : { std::pair(0, 0), { 1, 0 }, { 0, 1 }, { 1, 1 } }) {
        ImageBuf src = hdr_scene();
        for (const auto& [x, y] : { std::pair(20, 12), { 60, 40 }, { 80, 20 } }) {
            src.setpixel(x, y, bright);
            src.setpixel(x + dx, y + dy, bright);
        }
        HdrCompressOptions options;
        ASSERT_TRUE(ImageBufAlgo::resolve_hdr_compress(src, options, error)) << error;
        EXPECT_NEAR(options.dmax / expected.dmax, 1.0f, 0.02f) << dx << ' ' << dy;
        EXPECT_NEAR(options.key / expected.key, 1.0f, 0.02f) << dx << ' ' << dy;
        EXPECT_NEAR(options.white / expected.white, 1.0f, 0.02f) << dx << ' ' << dy;
    }
}

TEST(HdrCompress, PicturesWithNothingInThem)
{
    for (float value : { 0.0f, 0.18f, -1.0f, 1e-30f, 60000.0f }) {
        ImageBuf src = picture(24, 16, 3, OIIO::TypeFloat);
        const float v[3] = { value, value, value };
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 24; ++x)
                src.setpixel(x, y, v);
        for (float p : pixels(compressed(src))) {
            ASSERT_TRUE(std::isfinite(p)) << value;
            ASSERT_GE(p, 0.0f);
            ASSERT_LE(p, 1.0f);
        }
        const float white[3] = { 1.0f, 1.0f, 1.0f };
        src.setpixel(11, 7, white);
        for (float p : pixels(compressed(src)))
            ASSERT_TRUE(std::isfinite(p)) << value;
    }
}

TEST(HdrCompress, EightBitInputIsDecodedFirst)
{
    // The same light, once linear and once encoded, must come out alike.
    const ImageBuf linear = hdr_scene(96, 64, OIIO::TypeFloat, 3, 0.002f);
    ImageBuf encoded = picture(96, 64, 3, OIIO::TypeUInt16, 5, -2);
    encoded.specmod().attribute("oiio:ColorSpace", "sRGB");
    for (int y = linear.ybegin(); y < linear.yend(); ++y)
        for (int x = linear.xbegin(); x < linear.xend(); ++x) {
            float p[3];
            linear.getpixel(x, y, p);
            for (float& v : p)
                v = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
            encoded.setpixel(x, y, p);
        }
    const std::vector<float> a = lightness(compressed(linear)), b = lightness(compressed(encoded));
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += std::fabs(a[i] - b[i]);
    EXPECT_LT(sum / double(a.size()), 1.5);
}

TEST(HdrCompress, ResolvedOptionsRepeatTheResult)
{
    const ImageBuf src = hdr_scene();
    ProgressiveImage progressive;
    ASSERT_TRUE(progressive.build(src));
    HdrCompressOptions options;
    std::string error;
    ASSERT_TRUE(ImageBufAlgo::resolve_hdr_compress(progressive, options, error)) << error;
    EXPECT_GT(options.s0, 0.0f);
    EXPECT_GT(options.dmax, 0.0f);
    HdrCompressOptions without_hierarchy;
    ASSERT_TRUE(ImageBufAlgo::resolve_hdr_compress(src, without_hierarchy, error)) << error;
    EXPECT_EQ(options.key, without_hierarchy.key);
    EXPECT_EQ(options.white, without_hierarchy.white);
    ImageBuf a, b;
    EXPECT_FILTER(a, ImageBufAlgo::hdr_compress(a, progressive));
    EXPECT_FILTER(b, ImageBufAlgo::hdr_compress(b, progressive, options));
    const std::vector<float> p = pixels(a), q = pixels(b);
    for (std::size_t i = 0; i < p.size(); ++i)
        ASSERT_NEAR(p[i], q[i], 1e-4f);
}

}  // namespace
}  // namespace pimg
