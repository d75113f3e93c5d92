// SPDX-License-Identifier: BSD-3-Clause
// What holds for every filter: identities, regions, threads, pixel types, windows, errors.
#include <cmath>
#include <cstdlib>
#include <limits>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <OpenImageIO/deepdata.h>

#include <pimg/detail/oiio_compat.h>
#include <pimg/imagebufalgo.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;
using OIIO::ROI;

FeatureLowpassOptions keep(float fraction)
{
    FeatureLowpassOptions options;
    options.fraction = fraction;
    return options;
}

FeatureLowpassOptions contrast(float strength, bool log = false)
{
    FeatureLowpassOptions options;
    options.strength = strength;
    options.log = log;
    return options;
}

DetailEnhanceOptions times(float gain)
{
    DetailEnhanceOptions options;
    options.gain = gain;
    return options;
}

/// Every filter with settings that change something, on a picture or a progressive image.
template<class Source>
std::vector<std::pair<std::string, std::function<bool(ImageBuf&, const Source&, ROI, int)>>> all_filters()
{
    LevelOptions level;
    level.fraction = 0.1f;
    WireframeOptions wires;
    wires.fraction = 0.1f;
    return {
        { "hdr_compress",
          [](ImageBuf& d, const Source& s, ROI r, int n) {
              return ImageBufAlgo::hdr_compress(d, s, {}, r, n);
          } },
        { "feature_lowpass",
          [](ImageBuf& d, const Source& s, ROI r, int n) {
              return ImageBufAlgo::feature_lowpass(d, s, keep(0.2f), r, n);
          } },
        { "detail_enhance",
          [](ImageBuf& d, const Source& s, ROI r, int n) {
              return ImageBufAlgo::detail_enhance(d, s, times(3.0f), r, n);
          } },
        { "feature_lowpass by strength",
          [](ImageBuf& d, const Source& s, ROI r, int n) {
              return ImageBufAlgo::feature_lowpass(d, s, contrast(0.05f), r, n);
          } },
        { "feature_lowpass of logarithms",
          [](ImageBuf& d, const Source& s, ROI r, int n) {
              return ImageBufAlgo::feature_lowpass(d, s, contrast(0.2f, true), r, n);
          } },
        { "detail_enhance by strength",
          [](ImageBuf& d, const Source& s, ROI r, int n) {
              DetailEnhanceOptions options = times(3.0f);
              options.noise = 3.0f;
              return ImageBufAlgo::detail_enhance(d, s, options, r, n);
          } },
        { "level_image",
          [=](ImageBuf& d, const Source& s, ROI r, int n) {
              return ImageBufAlgo::level_image(d, s, level, r, n);
          } },
        { "wireframe",
          [=](ImageBuf& d, const Source& s, ROI r, int n) {
              return ImageBufAlgo::wireframe(d, s, wires, r, n);
          } },
    };
}

TEST(Filters, NeutralSettingsReturnTheSource)
{
    for (const OIIO::TypeDesc& type : { OIIO::TypeUInt8, OIIO::TypeUInt16, OIIO::TypeHalf, OIIO::TypeFloat })
        for (int channels : { 1, 2, 3, 4, 5 }) {
            const ImageBuf src = hdr_scene(60, 40, type, channels, type.is_floating_point() ? 1.0f : 0.02f);
            ImageBuf low, enhanced;
            EXPECT_FILTER(low, ImageBufAlgo::feature_lowpass(low, src, keep(1.0f)));
            EXPECT_FILTER(enhanced, ImageBufAlgo::detail_enhance(enhanced, src, times(1.0f)));
            const std::vector<float> a = pixels(src), b = pixels(low), c = pixels(enhanced);
            for (std::size_t i = 0; i < a.size(); ++i) {
                ASSERT_NEAR(a[i], b[i], type.is_floating_point() ? 1e-6f * 550.0f : 0.0f) << type << " " << channels;
                ASSERT_EQ(a[i], c[i]) << type << " " << channels;
            }
        }
}

TEST(Filters, TheFinestLevelIsTheSource)
{
    const ImageBuf src = hdr_scene();
    ImageBuf level;
    EXPECT_FILTER(level, ImageBufAlgo::level_image(level, src));
    const std::vector<float> a = pixels(src), b = pixels(level);
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_NEAR(a[i], b[i], 1e-6f * 550.0f);
}

TEST(Filters, S0OneIsTheSource)
{
    const ImageBuf src = hdr_scene();
    HdrCompressOptions options;
    options.s0 = 1.0f;
    options.fit = false;
    ImageBuf dst;
    EXPECT_FILTER(dst, ImageBufAlgo::hdr_compress(dst, src, options));
    const std::vector<float> a = pixels(src), b = pixels(dst);
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_NEAR(b[i] / a[i], 1.0f, 1e-4f);
}

TEST(Filters, LowPassAndEnhancementKeepTheMeanOfTheSurface)
{
    // Details sum to nothing over the surface, so a filter on them leaves the mean; pixels differ by the border's
    // weight.
    const ImageBuf src = hdr_scene(96, 64, OIIO::TypeFloat, 1);
    const auto mean = [](const std::vector<float>& v) {
        double sum = 0;
        for (float x : v)
            sum += x;
        return sum / double(v.size());
    };
    LevelOptions level;
    level.fraction = 0.1f;
    ImageBuf coarse;
    EXPECT_FILTER(coarse, ImageBufAlgo::level_image(coarse, src, level));
    EXPECT_NEAR(mean(pixels(coarse)), mean(pixels(src)), 2e-3 * 550.0);
}

TEST(Filters, RegionsAndThreadsChangeNothing)
{
    const ImageBuf src = hdr_scene();
    ProgressiveImage progressive;
    ASSERT_TRUE(progressive.build(src)) << progressive.error();
    const ROI part = window_of(src);
    for (const auto& [name, filter] : all_filters<ProgressiveImage>()) {
        ImageBuf whole, window;
        EXPECT_FILTER(whole, filter(whole, progressive, {}, 2)) << name;
        EXPECT_FILTER(window, filter(window, progressive, part, 2)) << name;
        for (const int threads : { 1, 3, 8, 16 }) {
            ImageBuf other;
            EXPECT_FILTER(other, filter(other, progressive, {}, threads)) << name;
            EXPECT_TRUE(identical(pixels(whole), pixels(other))) << name << ", " << threads << " threads";
        }
        EXPECT_TRUE(identical(pixels(whole, window.roi()), pixels(window))) << name;
        EXPECT_EQ(window.roi().npixels(), part.npixels()) << name;
    }
}

TEST(Filters, APrebuiltHierarchyGivesTheSame)
{
    const ImageBuf src = hdr_scene();
    ProgressiveImage progressive;
    ASSERT_TRUE(progressive.build(src)) << progressive.error();
    const auto direct = all_filters<ImageBuf>();
    const auto prebuilt = all_filters<ProgressiveImage>();
    for (std::size_t i = 0; i < direct.size(); ++i) {
        ImageBuf a, b;
        EXPECT_FILTER(a, direct[i].second(a, src, {}, 0));
        EXPECT_FILTER(b, prebuilt[i].second(b, progressive, {}, 0));
        EXPECT_TRUE(identical(pixels(a), pixels(b))) << direct[i].first;
    }
}

TEST(Filters, TheDestinationMayBeTheSource)
{
    for (const auto& [name, filter] : all_filters<ImageBuf>()) {
        ImageBuf src = hdr_scene(), dst;
        EXPECT_FILTER(dst, filter(dst, src, {}, 0)) << name;
        EXPECT_FILTER(src, filter(src, src, {}, 0)) << name;
        EXPECT_TRUE(identical(pixels(src), pixels(dst))) << name;
    }
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// How often to do something: $name, or `usual`.
int times(const char* name, int usual)
{
    const char* value = std::getenv(name);
    return value != nullptr ? std::atoi(value) : usual;
}

// $PIMG_BUILDS and $PIMG_RETUNES ask for more, as before a release: 200 and 10000.
TEST(Filters, MemoryDoesNotGrow)
{
    constexpr std::size_t kSlack = 1 << 16;  // less than what two pictures, or a kilobyte each time, would leave behind
    const int builds = times("PIMG_BUILDS", 12), retunes = times("PIMG_RETUNES", 100);
    const ImageBuf src = hdr_scene();
    const auto work = [&](int count) {
        ProgressiveImage image;
        ASSERT_TRUE(image.build(src, {}, 1)) << image.error();
        HdrCompressOptions options;
        for (int i = 0; i < count; ++i) {
            options.s0 = 0.2f + 0.1f * float(i % 7);
            ASSERT_FALSE(ImageBufAlgo::hdr_compress(image, options, {}, 1).has_error());
        }
    };
    const auto in_use = [] {
        return mallinfo2().uordblks + mallinfo2().hblkhd;
    };
    work(30);
    work(3);
    const std::size_t before = in_use();
    for (int i = 0; i < builds; ++i)
        work(retunes / builds);
    EXPECT_LE(in_use(), before + kSlack) << builds << " builds, " << retunes << " retunes";
    ProgressiveImage image;
    ASSERT_TRUE(image.build(src, {}, 1)) << image.error();
    HdrCompressOptions options;
    for (int i = 0; i < 10; ++i)
        ImageBufAlgo::hdr_compress(image, options, {}, 1);
    const std::size_t kept = in_use();
    for (int i = 0; i < retunes; ++i) {
        options.s0 = 0.2f + 0.1f * float(i % 7);
        ImageBufAlgo::hdr_compress(image, options, {}, 1);
    }
    EXPECT_LE(in_use(), kept + kSlack) << retunes << " retunes of one image";
}
#endif

TEST(Filters, PicturesMayLieInTheImageCache)
{
    const ImageBuf src = hdr_scene();
    ASSERT_TRUE(src.write("cached.exr")) << src.geterror();
    const std::shared_ptr<OIIO::ImageCache> cache = private_image_cache();
    for (const auto& [name, filter] : all_filters<ImageBuf>()) {
        ImageBuf cached = picture_in_cache("cached.exr", cache);
        ImageBuf direct, from_cache, into_cached = picture_in_cache("cached.exr", cache);
        ASSERT_TRUE(cached.init_spec("cached.exr", 0, 0));
        ASSERT_EQ(cached.storage(), ImageBuf::IMAGECACHE);
        EXPECT_FILTER(direct, filter(direct, src, {}, 0)) << name;
        EXPECT_FILTER(from_cache, filter(from_cache, cached, {}, 0)) << name;
        EXPECT_TRUE(identical(pixels(direct), pixels(from_cache))) << name;
        EXPECT_FILTER(into_cached, filter(into_cached, src, {}, 0)) << name;
        EXPECT_TRUE(identical(pixels(direct), pixels(into_cached))) << name;
    }
}

TEST(Filters, ADisjointRegionChangesNothing)
{
    const ImageBuf src = hdr_scene();
    for (const auto& [name, filter] : all_filters<ImageBuf>()) {
        ImageBuf dst = hdr_scene();
        const std::vector<float> before = pixels(dst);
        EXPECT_FILTER(dst, filter(dst, src, ROI(5000, 5010, 5000, 5010), 0)) << name;
        EXPECT_TRUE(identical(before, pixels(dst))) << name;
    }
}

TEST(Filters, WindowsAndAlphaAreKept)
{
    const ImageBuf src = hdr_scene(60, 40, OIIO::TypeHalf, 4);
    for (const auto& [name, filter] : all_filters<ImageBuf>()) {
        if (name == "wireframe")
            continue;
        ImageBuf dst;
        EXPECT_FILTER(dst, filter(dst, src, {}, 0)) << name;
        EXPECT_EQ(dst.roi(), src.roi()) << name;
        EXPECT_EQ(dst.roi_full(), src.roi_full()) << name;
        const std::vector<float> a = pixels(src), b = pixels(dst);
        for (std::size_t i = 3; i < a.size(); i += 4)
            ASSERT_EQ(a[i], b[i]) << name;
    }
}

TEST(Filters, AwkwardSizes)
{
    for (auto [w, h] : { std::pair { 1, 1 }, { 1, 9 }, { 9, 1 }, { 2, 2 }, { 3, 2 }, { 2, 33 }, { 65, 64 } }) {
        const ImageBuf src = hdr_scene(w, h);
        for (const auto& [name, filter] : all_filters<ImageBuf>()) {
            ImageBuf dst;
            EXPECT_FILTER(dst, filter(dst, src, {}, 0)) << name << " " << w << "x" << h;
            for (float v : pixels(dst))
                ASSERT_TRUE(std::isfinite(v)) << name << " " << w << "x" << h;
        }
    }
}

TEST(Filters, NonFiniteSamplesPassThroughSmoothing)
{
    ImageBuf src = hdr_scene();
    const float odd[3] = { std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 0.1f };
    src.setpixel(30, 20, odd);
    ImageBuf dst;
    EXPECT_FILTER(dst, ImageBufAlgo::feature_lowpass(dst, src, keep(0.1f)));
    float out[3];
    dst.getpixel(30, 20, out);
    EXPECT_TRUE(std::isnan(out[0]));
    EXPECT_TRUE(std::isinf(out[1]));
    dst.getpixel(31, 20, out);
    EXPECT_TRUE(std::isfinite(out[0]) && std::isfinite(out[1]));
}

TEST(Filters, HugeValuesDoNotOverflow)
{
    ImageBuf src = picture(40, 30, 1, OIIO::TypeFloat);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const float v = (x + y) % 2 ? 1.7e38f : -1.7e38f;
            src.setpixel(x, y, &v);
        }
    ImageBuf dst;
    EXPECT_FILTER(dst, ImageBufAlgo::feature_lowpass(dst, src, keep(1.0f)));
    const std::vector<float> a = pixels(src), b = pixels(dst);
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_NEAR(a[i], b[i], 3.4e38f * 1e-6f);
}

// ---- errors ------------------------------------------------------------------------------------------------

template<class Options>
void expect_refused(const Options& options, const char* word)
{
    std::string error;
    EXPECT_FALSE(check_options(options, error));
    EXPECT_NE(error.find(word), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
}

TEST(FilterErrors, OptionsOutOfRangeAreNamed)
{
    HdrCompressOptions hdr;
    hdr.s0 = -0.5f;
    expect_refused(hdr, "s0");
    hdr = {};
    hdr.beta = std::numeric_limits<float>::quiet_NaN();
    expect_refused(hdr, "beta");
    expect_refused(times(-1.0f), "gain");
    BuildOptions build;
    build.base = 1;
    expect_refused(build, "base");
    ImageBuf dst;
    EXPECT_FALSE(ImageBufAlgo::detail_enhance(dst, hdr_scene(), times(-1.0f)));
    EXPECT_NE(dst.geterror().find("gain"), std::string::npos);
    const ImageBuf returned = ImageBufAlgo::detail_enhance(hdr_scene(), times(-1.0f));
    EXPECT_TRUE(returned.has_error());
    returned.geterror();
}

TEST(FilterErrors, TextIsParsedStrictly)
{
    HdrCompressOptions options;
    std::string error;
    EXPECT_TRUE(set_option(options, "beta", "3.5", error)) << error;
    EXPECT_EQ(options.beta, 3.5f);
    for (auto [key, value] : { std::pair { "beta", "lots" },
                               { "beta", "1e999" },
                               { "beta", "nan" },
                               { "beta", "" },
                               { "beta", "3x" },
                               { "betta", "3" },
                               { "s0", "2" } }) {
        EXPECT_FALSE(set_option(options, key, value, error)) << key << "=" << value;
        EXPECT_NE(error.find(key), std::string::npos) << error;
    }
    EXPECT_EQ(options.beta, 3.5f);
}

TEST(FilterErrors, DeepVolumeEmptyAndMissing)
{
    OIIO::ImageSpec deep_spec(8, 8, 3, OIIO::TypeFloat);
    deep_spec.deep = true;
    OIIO::ImageSpec volume_spec(8, 8, 3, OIIO::TypeFloat);
    volume_spec.depth = volume_spec.full_depth = 4;
    const ImageBuf deep(deep_spec), volume(volume_spec), empty, missing("no/such/file.exr");
    for (const auto& [name, filter] : all_filters<ImageBuf>())
        for (const ImageBuf* src : { &deep, &volume, &empty, &missing }) {
            ImageBuf dst;
            EXPECT_FALSE(filter(dst, *src, {}, 0)) << name;
            const std::string error = dst.geterror();
            EXPECT_FALSE(error.empty()) << name;
            EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        }
    deep.geterror();
    volume.geterror();
    empty.geterror();
    missing.geterror();
}

TEST(FilterErrors, OnlyOneLevelAtATime)
{
    LevelOptions options;
    options.faces = 100;
    options.fraction = 0.5f;
    ImageBuf dst;
    EXPECT_FALSE(ImageBufAlgo::level_image(dst, hdr_scene(), options));
    EXPECT_FALSE(dst.geterror().empty());
}

}  // namespace
}  // namespace pimg
