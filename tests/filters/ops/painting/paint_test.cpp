// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>
#include <OpenImageIO/imagebufalgo.h>
#include <pimg/imagebufalgo.h>
#include <pimg/option_text.h>

#include "core/pictures.h"

namespace iba = pimg::ImageBufAlgo;
using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::ROI;

namespace {

/// A scene in linear light, from -0.1 to some thousand, with alpha.
ImageBuf picture(int width, int height, const OIIO::TypeDesc& type = OIIO::TypeDesc::FLOAT, int channels = 4)
{
    ImageSpec spec(width, height, channels, type);
    if (channels == 4)
        spec.alpha_channel = 3;
    ImageBuf buf(spec);
    for (ImageBuf::Iterator<float> p(buf); !p.done(); ++p) {
        const float v = pimg::test::scene(p.x(), p.y(), width, height) / 255.0f;
        for (int c = 0; c < channels; ++c)
            buf.setpixel(p.x(), p.y(), 0, std::vector<float> { v, v * v, 0.5f * v, 0.5f + 0.5f * v }.data(), channels);
    }
    return buf;
}

std::vector<float> samples(const ImageBuf& buf, int channel = -1)
{
    ROI roi = buf.roi();
    if (channel >= 0) {
        roi.chbegin = channel;
        roi.chend = channel + 1;
    }
    std::vector<float> values(std::size_t(roi.npixels()) * std::size_t(roi.nchannels()));
    buf.get_pixels(roi, OIIO::TypeDesc::FLOAT, values.data());
    return values;
}

bool same_bits(const ImageBuf& a, const ImageBuf& b)
{
    const std::vector<float> x = samples(a), y = samples(b);
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), 4 * x.size()) == 0;
}

TEST(paint, opacity_zero_is_the_source_bit_for_bit)
{
    pimg::PaintOptions options;
    options.opacity = 0.0f;
    options.impasto = 1.0f;
    for (const OIIO::TypeDesc type : { OIIO::TypeDesc::UINT8, OIIO::TypeDesc::HALF, OIIO::TypeDesc::FLOAT }) {
        ImageBuf src = picture(60, 44, type);
        if (type == OIIO::TypeDesc::FLOAT) {
            const float odd[4] = { std::numeric_limits<float>::quiet_NaN(), -3.0f, 1e9f, 0.25f };
            src.setpixel(7, 7, 0, odd, 4);
        }
        const ImageBuf result = iba::paint(src, options);
        ASSERT_FALSE(result.has_error()) << result.geterror();
        EXPECT_TRUE(same_bits(src, result)) << type.c_str();
        EXPECT_EQ(result.spec().format, type);
    }
}

TEST(paint, keeps_alpha_and_does_not_clip)
{
    ImageBuf src = picture(96, 80);
    for (ImageBuf::Iterator<float> p(src); !p.done(); ++p) {
        p[0] = p.x() < 48 ? -5.0f : 4000.0f;
        p[1] = p.x() < 48 ? -5.0f : 4000.0f;
        p[2] = p.x() < 48 ? -5.0f : 4000.0f;
    }
    const ImageBuf result = iba::paint(src);
    ASSERT_FALSE(result.has_error()) << result.geterror();
    EXPECT_EQ(samples(src, 3), samples(result, 3));
    EXPECT_NEAR(result.getchannel(10, 40, 0, 0), -5.0f, 1.0f);
    EXPECT_NEAR(result.getchannel(86, 40, 0, 0), 4000.0f, 800.0f);
}

TEST(paint, is_the_same_at_any_thread_count_and_for_the_same_seed_only)
{
    const ImageBuf src = picture(150, 130);
    pimg::PaintOptions options;
    options.jitter_colour = 0.2f;
    options.impasto = 0.5f;
    const ImageBuf one = iba::paint(src, options, {}, 1), three = iba::paint(src, options, {}, 3);
    EXPECT_TRUE(same_bits(one, three));
    options.seed = 2;
    EXPECT_FALSE(same_bits(one, iba::paint(src, options, {}, 1)));
}

TEST(paint, a_region_is_that_part_of_the_whole)
{
    const ImageBuf src = picture(100, 90);
    const ImageBuf whole = iba::paint(src);
    ImageBuf dst(src.spec());
    OIIO::ImageBufAlgo::zero(dst);
    ASSERT_TRUE(iba::paint(dst, src, {}, ROI(20, 60, 30, 70, 0, 1, 0, 3)));
    EXPECT_EQ(dst.getchannel(40, 50, 0, 1), whole.getchannel(40, 50, 0, 1));
    EXPECT_EQ(dst.getchannel(19, 50, 0, 1), 0.0f);
    EXPECT_EQ(dst.getchannel(40, 50, 0, 3), 0.0f);
}

TEST(paint, takes_brushes_canvases_and_maps_from_files)
{
    const ImageBuf src = picture(80, 60), small = picture(20, 10);
    ASSERT_TRUE(small.write("small.exr"));
    pimg::PaintOptions options;
    options.brush = options.canvas = options.detail = "small.exr";
    options.strokes = "strokes.json";
    ImageBuf result = iba::paint(src, options);
    EXPECT_FALSE(result.has_error()) << result.geterror();
    std::ifstream json("strokes.json");
    std::string first;
    std::getline(json, first);
    EXPECT_EQ(first.substr(0, 27), "{\"width\": 80, \"height\": 60,");
    options.brush = "bristle";
    options.canvas = "0.9,0.8,0.7";
    options.opacity = 0.0f;
    result = iba::paint(src, options);
    EXPECT_NEAR(result.getchannel(3, 3, 0, 1), 0.8f * src.getchannel(3, 3, 0, 3), 1e-6f);
}

TEST(paint, half_stays_finite)
{
    ImageBuf src = picture(60, 44, OIIO::TypeDesc::HALF, 3);
    for (ImageBuf::Iterator<float> p(src); !p.done(); ++p)
        for (int c = 0; c < 3; ++c)
            p[c] = p[c] * 40000.0f < 60000.0f ? p[c] * 40000.0f : 65504.0f;
    pimg::PaintOptions options;
    options.impasto = 1.0f;
    for (float v : samples(iba::paint(src, options)))
        ASSERT_TRUE(std::isfinite(v));
}

TEST(paint, covers_a_foreign_canvas)
{
    const ImageBuf src = picture(160, 120, OIIO::TypeDesc::FLOAT, 3);
    for (const char* brush : { "round", "flat", "bristle", "knife", "wash" }) {
        pimg::PaintOptions options;
        options.brush = brush;
        options.canvas = "100";
        const ImageBuf result = iba::paint(src, options);
        ASSERT_FALSE(result.has_error()) << result.geterror();
        for (float v : samples(result))
            ASSERT_LT(v, 25.0f) << brush;
    }
}

TEST(paint, says_what_is_wrong)
{
    const ImageBuf src = picture(30, 20);
    const auto message = [&](auto&& change) {
        pimg::PaintOptions options;
        change(options);
        return iba::paint(src, options).geterror();
    };
    EXPECT_NE(message([](auto& o) { o.brush = "broom"; }).find("round|flat|bristle|knife"), std::string::npos);
    EXPECT_NE(message([](auto& o) { o.canvas = "no/such.png"; }).find("canvas: expected"), std::string::npos);
    EXPECT_NE(message([](auto& o) { o.detail = "no/such.png"; }).find("detail: "), std::string::npos);
    EXPECT_NE(message([](auto& o) { o.strokes = "a.pdf"; }).find("FILE.svg or FILE.json"), std::string::npos);
    EXPECT_NE(message([](auto& o) { o.strokes = "no/such/folder/a.svg"; }).find("cannot write"), std::string::npos);
    EXPECT_NE(message([](auto& o) { o.min = 50, o.max = 32; }).find("max: 32 is below min, 50"), std::string::npos);
    EXPECT_NE(message([](auto& o) { o.min = 0.2f; }).find("is below min, 0.2"), std::string::npos);
    EXPECT_NE(message([](auto& o) { o.opacity = 2; }).find("opacity"), std::string::npos);
    EXPECT_NE(message([](auto& o) { o.min = 0; }).find("expected a number, 0.0001 to 1000"), std::string::npos);
    EXPECT_NE(message([](auto& o) { o.style = "baroque"; }).find("oil, impasto, wash, pastel, pointillist"),
              std::string::npos);
    std::string error;
    pimg::PaintOptions options;
    EXPECT_FALSE(pimg::set_option(options, "cover", "most", error));
    EXPECT_NE(error.find("cover=\"most\": expected a number, 0 to 1"), std::string::npos) << error;
}

/// A style is nothing but the values of its row, and options that are given win.
TEST(paint, styles_are_rows_of_values)
{
    const ImageBuf src = picture(90, 70);
    std::vector<ImageBuf> paintings;
    for (const pimg::Preset& style : pimg::paint_styles()) {
        pimg::PaintOptions named;
        named.style = style.name;
        const pimg::PaintOptions filled = pimg::with_style(named);
        for (const auto& option : pimg::option_table<pimg::PaintOptions>()) {
            const bool may_be_unset = option.get(named) == pimg::OptionValue(-1.0f);
            EXPECT_FALSE(may_be_unset && option.get(filled) == pimg::OptionValue(-1.0f)) << option.rule.key;
        }
        EXPECT_FALSE(filled.brush.empty() || filled.canvas.empty()) << style.name;
        const ImageBuf by_name = iba::paint(src, named);
        ASSERT_FALSE(by_name.has_error()) << by_name.geterror();
        pimg::PaintOptions by_value = filled;
        by_value.style = "oil";
        EXPECT_TRUE(same_bits(by_name, iba::paint(src, by_value))) << style.name;
        EXPECT_TRUE(same_bits(by_name, iba::paint(src, named, {}, 3))) << style.name << ", 3 threads";
        for (const ImageBuf& other : paintings)
            EXPECT_FALSE(same_bits(by_name, other)) << style.name;
        paintings.push_back(by_name);
        named.min = 5;
        named.brush = "flat";
        named.impasto = 0;
        EXPECT_EQ(pimg::with_style(named).min, 5.0f);
        EXPECT_EQ(pimg::with_style(named).brush, "flat");
        EXPECT_EQ(pimg::with_style(named).impasto, 0.0f);
        EXPECT_EQ(pimg::with_style(named).max, filled.max);
    }
    EXPECT_TRUE(same_bits(paintings[0], iba::paint(src))) << "oil is the default";
}

/// Below 1, sizes are shares of the diagonal; a size given in pixels moves a default that contradicts it.
TEST(paint, sizes_are_pixels_or_shares)
{
    const ImageBuf src = picture(160, 120);  // a diagonal of 200
    const auto painted = [&](float min, float max) {
        pimg::PaintOptions options;
        options.min = min;
        options.max = max;
        ImageBuf result = iba::paint(src, options);
        EXPECT_FALSE(result.has_error()) << result.geterror();
        return result;
    };
    EXPECT_TRUE(same_bits(painted(0.02f, 0.1f), painted(4, 20)));
    EXPECT_TRUE(same_bits(painted(30, -1), painted(30, 30)));
    EXPECT_TRUE(same_bits(painted(-1, 1), painted(1, 1)));
    EXPECT_FALSE(same_bits(painted(4, 20), painted(4, 12)));
}

/// Places that are not covered show the canvas.
TEST(paint, cover_below_one_leaves_canvas)
{
    const ImageBuf src = picture(160, 120, OIIO::TypeDesc::FLOAT, 3);
    pimg::PaintOptions options;
    options.canvas = "100";
    options.cover = 0.3f;
    std::size_t bare = 0;
    for (const float v : samples(iba::paint(src, options), 0))
        bare += v > 50.0f;
    EXPECT_GT(bare, std::size_t(160 * 120 / 50));
    options.canvas = "source";
    for (const float v : samples(iba::paint(src, options), 0))
        ASSERT_LT(v, 50.0f);
}

TEST(painting, works_on_odd_pictures)
{
    for (const auto& [width, height] : { std::pair { 1, 1 }, { 1, 9 }, { 7, 1 }, { 2, 2 }, { 40, 30 } })
        for (const int channels : { 1, 3, 4 })
            for (const OIIO::TypeDesc type : { OIIO::TypeDesc::UINT8, OIIO::TypeDesc::FLOAT }) {
                ImageBuf src = picture(width, height, type, channels);
                src.set_origin(-5, 11);
                if (type == OIIO::TypeDesc::FLOAT)
                    src.setpixel(-5, 11, 0, std::vector<float>(4, std::numeric_limits<float>::infinity()).data(),
                                 channels);
                for (const ImageBuf& result : { iba::paint(src), iba::mosaic(src), iba::ink(src) }) {
                    ASSERT_FALSE(result.has_error()) << result.geterror();
                    EXPECT_EQ(result.roi(), src.roi());
                    for (int c = 0; c < std::min(channels, 3); ++c)
                        for (float v : samples(result, c))
                            ASSERT_TRUE(std::isfinite(v)) << width << " x " << height << ", channel " << c;
                }
            }
}

/// One picture, as bytes in memory and as float read from a file of bytes.
TEST(painting, takes_an_8_bit_file_read_as_float_for_what_it_is)
{
    ImageBuf bytes = picture(90, 70, OIIO::TypeDesc::UINT8, 3);
    bytes.specmod().attribute("oiio:ColorSpace", "sRGB");
    ASSERT_TRUE(bytes.write("bytes.png")) << bytes.geterror();
    ImageBuf floats("bytes.png");
    ASSERT_TRUE(floats.read(0, 0, true, OIIO::TypeDesc::FLOAT)) << floats.geterror();
    ASSERT_EQ(floats.spec().format, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT));
    for (const char* guide : { "", "rgb", "log" }) {
        pimg::BuildOptions build;
        build.guide = guide;
        pimg::ProgressiveImage a, b;
        ASSERT_TRUE(a.build(bytes, build)) << a.error();
        ASSERT_TRUE(b.build(floats, build)) << b.error();
        EXPECT_EQ(a.stats().guide, b.stats().guide);
        const auto check = [&](const ImageBuf& one, const ImageBuf& other) {
            ASSERT_FALSE(one.has_error() || other.has_error()) << one.geterror() << other.geterror();
            EXPECT_EQ(one.spec().format, OIIO::TypeDesc(OIIO::TypeDesc::UINT8));
            EXPECT_EQ(other.spec().format, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT));
            EXPECT_TRUE(same_bits(one, other.copy(OIIO::TypeDesc::UINT8))) << guide;
        };
        check(iba::paint(a), iba::paint(b));
        check(iba::mosaic(a), iba::mosaic(b));
        check(iba::ink(a), iba::ink(b));
    }
}

/// Any part of the picture, by any number of threads, has the same pixels as the whole.
TEST(painting, is_the_same_at_any_thread_count_and_in_any_region)
{
    const ImageBuf src = picture(150, 130);
    ROI part = src.roi();
    part.xbegin = 31, part.xend = 118;
    part.ybegin = 17, part.yend = 129;
    const auto check = [&](const char* name, auto&& filter) {
        const ImageBuf whole = filter(ROI(), 1);
        ASSERT_FALSE(whole.has_error()) << name << ": " << whole.geterror();
        for (const int threads : { 2, 3, 8 })
            EXPECT_TRUE(same_bits(whole, filter(ROI(), threads))) << name << ", " << threads << " threads";
        const ImageBuf window = filter(part, 3);
        EXPECT_EQ(window.roi().npixels(), part.npixels()) << name;
        EXPECT_TRUE(same_bits(OIIO::ImageBufAlgo::cut(whole, part), OIIO::ImageBufAlgo::cut(window, part))) << name;
    };
    pimg::PaintOptions paint;
    paint.impasto = 0.5f;
    pimg::MosaicOptions mosaic;
    mosaic.tiles = 300;
    pimg::InkOptions ink;
    ink.width = 2;
    check("paint", [&](ROI roi, int threads) { return iba::paint(src, paint, roi, threads); });
    check("mosaic", [&](ROI roi, int threads) { return iba::mosaic(src, mosaic, roi, threads); });
    check("ink", [&](ROI roi, int threads) { return iba::ink(src, ink, roi, threads); });
}

TEST(mosaic, one_tile_colour_between_joints)
{
    const ImageBuf src = picture(120, 90);
    pimg::MosaicOptions options;
    options.tiles = 100;
    options.colour = "9";
    options.bevel = 0;
    const ImageBuf result = iba::mosaic(src, options);
    ASSERT_FALSE(result.has_error()) << result.geterror();
    EXPECT_EQ(samples(src, 3), samples(result, 3));
    std::size_t joints = 0;
    for (float v : samples(result, 0))
        joints += v > 5.0f;
    EXPECT_GT(joints, 300u);
    options.colour = "mauve";
    EXPECT_NE(iba::mosaic(src, options).geterror().find("colour: \"mauve\""), std::string::npos);
}

/// Cells and pieces, stained glass, and chance: all are other pictures, and the same for any number of threads.
TEST(mosaic, has_shapes_and_leading)
{
    const ImageBuf src = picture(130, 90);
    std::vector<ImageBuf> mosaics;
    for (const char* changed : { "", "shape=pieces", "leading=3", "variation=0.3", "round=1", "seed=2" }) {
        pimg::MosaicOptions options;
        pimg::OptionTexts texts;
        std::string error;
        ASSERT_TRUE(pimg::split_options(changed, texts, error));
        ASSERT_TRUE(pimg::set_option(options, "tiles", "150", error));
        for (const auto& [key, value] : texts)
            ASSERT_TRUE(pimg::set_option(options, key, value, error)) << error;
        const ImageBuf one = iba::mosaic(src, options, {}, 1);
        ASSERT_FALSE(one.has_error()) << one.geterror();
        EXPECT_TRUE(same_bits(one, iba::mosaic(src, options, {}, 3))) << changed;
        EXPECT_EQ(samples(src, 3), samples(one, 3)) << changed;
        for (const ImageBuf& other : mosaics)
            EXPECT_FALSE(same_bits(one, other)) << changed;
        mosaics.push_back(one);
    }
    pimg::MosaicOptions options;
    std::string error;
    EXPECT_FALSE(pimg::set_option(options, "shape", "stars", error));
    EXPECT_NE(error.find("cells, pieces"), std::string::npos) << error;
    EXPECT_FALSE(pimg::set_option(options, "leading", "-1", error));
    EXPECT_NE(error.find("0 to 64"), std::string::npos) << error;
}

TEST(ink, is_black_on_white_and_exports_lines)
{
    const ImageBuf src = picture(120, 90);
    pimg::InkOptions options;
    options.width = 1.5f;
    options.strokes = "lines.svg";
    const ImageBuf result = iba::ink(src, options);
    ASSERT_FALSE(result.has_error()) << result.geterror();
    float least = 1, most = 0;
    for (float v : samples(result, 1)) {
        least = std::min(least, v);
        most = std::max(most, v);
    }
    EXPECT_GE(least, 0.0f);
    EXPECT_LT(least, 0.01f);
    const std::vector<float> alpha = samples(src, 3);
    EXPECT_EQ(most, *std::max_element(alpha.begin(), alpha.end()));  // paper is associated with alpha
    std::ifstream svg("lines.svg");
    std::string first;
    std::getline(svg, first);
    EXPECT_EQ(first.substr(0, 4), "<svg");
}

TEST(ink, draws_linear_light_without_contrast_in_middle_tones)
{
    for (const float light : { 0.01f, 1.0f, 300.0f }) {
        ImageBuf src(ImageSpec(60, 40, 3, OIIO::TypeDesc::FLOAT));
        OIIO::ImageBufAlgo::fill(src, { light, light, light });
        pimg::InkOptions options;
        options.width = 1.0f;
        double mean = 0.0;
        const std::vector<float> drawn = samples(iba::ink(src, options), 0);
        for (const float v : drawn)
            mean += double(v) / double(drawn.size());
        EXPECT_GT(mean, 0.3) << light;
        EXPECT_LT(mean, 0.7) << light;
    }
}

TEST(ink, draws_in_the_inks_asked_for)
{
    ImageBuf src(OIIO::ImageSpec(160, 120, 3, OIIO::TypeDesc::FLOAT));
    for (OIIO::ImageBuf::Iterator<float> p(src); !p.done(); ++p) {
        const bool left = p.x() < 80;
        p[0] = left ? 0.8f : 0.1f;
        p[1] = 0.3f;
        p[2] = left ? 0.1f : 0.7f;
    }
    src.specmod().attribute("oiio:ColorSpace", "sRGB");
    pimg::InkOptions options;
    options.width = 1.5f;
    options.outline = 0;
    const auto differs = [&](int x0, int x1) {  // mean of red minus blue
        const ImageBuf result = iba::ink(src, options, {}, 1);
        EXPECT_FALSE(result.has_error()) << result.geterror();
        const std::vector<float> red = samples(result, 0), blue = samples(result, 2);
        double sum = 0;
        for (int y = 0; y < 120; ++y)
            for (int x = x0; x < x1; ++x)
                sum += double(red[std::size_t(y * 160 + x)] - blue[std::size_t(y * 160 + x)]);
        return sum / double(120 * (x1 - x0));
    };
    EXPECT_EQ(differs(0, 160), 0.0);
    options.colours = 3;
    EXPECT_GT(differs(0, 70), 0.2);
    EXPECT_LT(differs(90, 160), -0.2);
}

TEST(ink, sizes_follow_the_paper)
{
    const ImageBuf src = picture(120, 90);
    pimg::InkOptions options;
    options.paper = "240x180";
    options.pen = 3;
    options.strokes = "sheet.svg";
    const ImageBuf a = iba::ink(src, options);
    std::ifstream svg("sheet.svg");
    std::string first;
    std::getline(svg, first);
    EXPECT_NE(first.find("width=\"240mm\" height=\"180mm\""), std::string::npos) << first;
    options.strokes.clear();
    options.width = 1.5f;  // pixels: 240 mm are 120 of them
    EXPECT_EQ(samples(a, 0), samples(iba::ink(src, options), 0));
    options.sort = true;  // another order of the same lines
    const std::vector<float> one = samples(a, 0), other = samples(iba::ink(src, options), 0);
    for (std::size_t i = 0; i < one.size(); ++i)
        ASSERT_NEAR(one[i], other[i], 1e-5f);
}

TEST(ink, says_what_is_wrong)
{
    const ImageBuf src = picture(60, 40);
    const auto says = [&](const char* key, const char* value, const char* expected) {
        pimg::InkOptions options;
        std::string error;
        if (pimg::set_option(options, key, value, error)) {
            const ImageBuf result = iba::ink(src, options);
            EXPECT_TRUE(result.has_error()) << key;
            error = result.geterror();
        }
        EXPECT_NE(error.find(expected), std::string::npos) << error;
    };
    for (const char* paper : { "", "a7", "letter", "20x", "0x5", "nanxnan", "5x5x5" })
        says("paper", paper, "expected a0 to a6, or two sides");
    says("pen", "0.009", "expected a number, 0.01 to 100");
    says("width", "0.01", "width: expected a pen of at least");
    says("style", "charcoal", "hatch, contour, stipple");
    says("strokes", "lines.png", "expected FILE.svg or FILE.json");
}

}  // namespace
