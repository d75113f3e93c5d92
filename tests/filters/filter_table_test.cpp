// SPDX-License-Identifier: BSD-3-Clause
// What holds for every filter of the registry, whichever there are: regions, threads, windows, alpha, metadata, NaN.
#include <pimg/filter_table.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;
using OIIO::ROI;

/// Options with which a filter does something visible on a small picture; none where the defaults do.
OptionTexts options_for(const std::string& name)
{
    static const std::pair<const char*, OptionTexts> given[] = {
        { "level", { { "fraction", "0.1" } } },       { "wireframe", { { "fraction", "0.1" } } },
        { "dual_pieces", { { "vertices", "200" } } }, { "segment", { { "regions", "20" } } },
        { "mosaic", { { "tiles", "150" } } },         { "feature_lowpass", { { "strength", "0.2" } } },
    };
    for (const auto& [filter, options] : given)
        if (name == filter)
            return options;
    return {};
}

BoundFilter bound(const Filter& row, const OptionTexts& options)
{
    BoundFilter filter;
    std::string error;
    EXPECT_TRUE(row.bind(options, filter, error)) << row.name << ": " << error;
    return filter;
}

BoundFilter bound(const Filter& row)
{
    return bound(row, options_for(row.name));
}

bool is_picture(FilterOutput output)
{
    return output != FilterOutput::labels && output != FilterOutput::mask;
}

std::vector<float> result_of(const BoundFilter& filter, const ProgressiveImage& src, ROI roi = {}, int threads = 1)
{
    ImageBuf dst;
    EXPECT_FILTER(dst, filter(dst, src, roi, threads));
    return pixels(dst);
}

TEST(FilterTable, NamesAreUniqueAndTold)
{
    std::set<std::string> names, commands;
    for (const Filter& row : filter_table()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_TRUE(commands.insert(row.command).second) << row.command;
        std::string dashed = "--" + std::string(row.name), error;
        std::replace(dashed.begin(), dashed.end(), '_', '-');
        EXPECT_EQ(dashed, row.command);
        EXPECT_EQ(find_filter(dashed.substr(2), error), &row);
        EXPECT_NE(*row.summary, '\0');
        EXPECT_EQ(bound(row, {}).output, row.output) << row.name;
    }
    std::string error;
    EXPECT_EQ(find_filter("sepia", error), nullptr);
    for (const std::string& name : names)
        EXPECT_NE(error.find(name), error.npos) << error;
    EXPECT_STREQ(filter_table().front().name, "level");
}

TEST(FilterTable, BareValuesSetOptionsThereAre)
{
    for (const Filter& row : filter_table())
        for (const std::string key : { row.bare.key, row.bare.share }) {
            const std::vector<OptionInfo> options = row.options();
            const auto is_it = [&](const OptionInfo& o) {
                return o.key == key;
            };
            EXPECT_TRUE(key.empty() || std::any_of(options.begin(), options.end(), is_it)) << row.name << ": " << key;
        }
}

TEST(FilterTable, TellsWhatResultsAre)
{
    std::string error;
    const Filter& segment = *find_filter("segment", error);
    EXPECT_EQ(bound(segment, { { "output", "mean" } }).output, FilterOutput::picture);
    EXPECT_EQ(bound(segment, { { "output", "boundaries" } }).output, FilterOutput::mask);
    EXPECT_EQ(bound(segment, { { "stats", "a.csv" } }).written, "stats");
    EXPECT_EQ(bound(*find_filter("paint", error), { { "strokes", "a.svg" } }).written, "strokes");
    EXPECT_EQ(bound(*find_filter("ink", error), { { "strokes", "a.svg" } }).written, "strokes");
    for (const Filter& row : filter_table())
        EXPECT_EQ(bound(row).written, "") << row.name;
}

TEST(FilterTable, OlderSpellingsOfKeysAreUnderstood)
{
    int aliases = 0;
    for (const Filter& row : filter_table())
        for (const OptionInfo& option : row.options()) {
            if (option.alias.empty())
                continue;
            ++aliases;
            bound(row, { { option.alias, option.default_value.empty() ? "1" : option.default_value } });
        }
    EXPECT_GE(aliases, 2);  // "color" of mosaic, "jitter_color" of paint
}

TEST(FilterTable, RegionsAndThreadsChangeNothing)
{
    const ImageBuf src = hdr_scene();
    ProgressiveImage progressive;
    ASSERT_TRUE(progressive.build(src)) << progressive.error();
    const ROI part = window_of(src);
    for (const Filter& row : filter_table()) {
        const BoundFilter filter = bound(row);
        ImageBuf whole, window;
        EXPECT_FILTER(whole, filter(whole, progressive, {}, 1)) << row.name;
        EXPECT_FILTER(window, filter(window, progressive, part, 3)) << row.name;
        EXPECT_TRUE(identical(pixels(whole, window.roi()), pixels(window))) << row.name;
        EXPECT_EQ(window.roi().npixels(), part.npixels()) << row.name;
        for (const int threads : { 2, 5 })
            EXPECT_TRUE(identical(pixels(whole), result_of(filter, progressive, {}, threads)))
                << row.name << ", " << threads << " threads";
    }
}

TEST(FilterTable, WindowsAlphaAndMetadataAreKept)
{
    ImageBuf src = hdr_scene(60, 40, OIIO::TypeHalf, 4);
    src.specmod().attribute("Artist", "somebody");
    ProgressiveImage progressive;
    ASSERT_TRUE(progressive.build(src)) << progressive.error();
    for (const Filter& row : filter_table()) {
        const BoundFilter filter = bound(row);
        ImageBuf dst;
        EXPECT_FILTER(dst, filter(dst, progressive, {}, 0)) << row.name;
        EXPECT_EQ(dst.xbegin(), src.xbegin()) << row.name;
        EXPECT_EQ(dst.yend(), src.yend()) << row.name;
        EXPECT_EQ(dst.roi_full().xend, src.roi_full().xend) << row.name;
        EXPECT_EQ(dst.spec().get_string_attribute("Artist"), "somebody") << row.name;
        EXPECT_EQ(dst.nchannels(), is_picture(filter.output) ? 4 : 1) << row.name;
        if (!is_picture(filter.output))
            continue;
        const std::vector<float> a = pixels(src), b = pixels(dst);
        for (std::size_t i = 3; i < a.size(); i += 4)
            ASSERT_EQ(a[i], b[i]) << row.name;
    }
}

/// A sample that is no number spoils no other, and a filter either puts it back or puts something finite there.
TEST(FilterTable, NonFiniteSamplesDoNotSpread)
{
    ImageBuf src = hdr_scene(60, 40);
    const float odd[3] = { std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 0.1f };
    const int x = src.xbegin() + 30, y = src.ybegin() + 20;
    src.setpixel(x, y, odd);
    ProgressiveImage progressive;
    ASSERT_TRUE(progressive.build(src)) << progressive.error();
    for (const Filter& row : filter_table()) {
        ImageBuf dst;
        const BoundFilter filter = bound(row);
        EXPECT_FILTER(dst, filter(dst, progressive, {}, 0)) << row.name;
        int spoilt = 0;
        for (ImageBuf::ConstIterator<float> p(dst); !p.done(); ++p)
            for (int c = 0; c < dst.nchannels(); ++c)
                spoilt += !std::isfinite(p[c]) && (p.x() != x || p.y() != y);
        EXPECT_EQ(spoilt, 0) << row.name;
    }
}

TEST(FilterTable, UnknownKeysAndValuesAreNamed)
{
    for (const Filter& row : filter_table()) {
        BoundFilter filter;
        std::string error;
        EXPECT_FALSE(row.bind({ { "sepia", "1" } }, filter, error)) << row.name;
        EXPECT_NE(error.find("\"sepia\""), error.npos) << row.name << ": " << error;
        EXPECT_EQ(error.find('\n'), error.npos) << row.name;
    }
}

}  // namespace
}  // namespace pimg
