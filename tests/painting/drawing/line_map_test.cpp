// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/line_map.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/pictures.h"
#include "painting/drawing/rasters.h"

using namespace pimg;

namespace {

constexpr int kSize = 120;

template<class F>
Study study_of(F&& f)
{
    const Raster raster = test::raster_of(kSize, kSize, f);
    return { raster, { raster }, { raster }, make_raster(kSize, kSize) };
}

float at(const Raster& raster, int x, int y)
{
    return raster.samples[std::size_t(y * kSize + x)];
}

/// An upright edge at 40 and an upright dark line at 80.
Study edge_and_line()
{
    return study_of([](int x, int) { return x < 40 ? 150.0f : x == 80 || x == 81 ? 30.0f : 70.0f; });
}

TEST(LineMap, EdgesAreStrongestOnThemAndRunAlong)
{
    const LineMap map = edges_of(edge_and_line(), {});
    EXPECT_GT(at(map.strength, 40, 60), 20.0f);
    EXPECT_GT(at(map.strength, 40, 60), 3.0f * at(map.strength, 43, 60));
    EXPECT_NEAR(std::fabs(map.along({ 40.0f, 60.0f }).y), 1.0f, 1e-3f);
    EXPECT_EQ(at(map.importance, 10, 60), 0.0f);
}

TEST(LineMap, ThinLinesAreNoEdges)
{
    const LineMap dark = thin_lines_of(edge_and_line(), false, {}), light = thin_lines_of(edge_and_line(), true, {});
    EXPECT_GT(at(dark.strength, 80, 60) + at(dark.strength, 81, 60), 20.0f);
    for (int x = 30; x < 50; ++x)
        EXPECT_LT(at(dark.strength, x, 60), 1.0f) << x;
    for (int x = 70; x < 90; ++x)
        EXPECT_LT(at(light.importance, x, 60), 6.0f) << x;
}

TEST(LineMap, EdgesAmongOthersCountLess)
{
    const auto stripes = [](int x, int) {
        return x % 10 < 5 ? 60.0f : 140.0f;
    };
    const LineMap alone = edges_of(study_of([](int x, int) { return x < 60 ? 60.0f : 140.0f; }), {});
    const LineMap among = edges_of(study_of(stripes), {});
    EXPECT_LT(at(among.importance, 60, 60), 0.6f * at(alone.importance, 60, 60));
}

TEST(LineMap, ThinLinesOfNoiseAreNotImportant)
{
    const LineMap map = thin_lines_of(
        study_of([](int x, int y) { return 100.0f + 20.0f * test::noise(std::uint32_t(x), std::uint32_t(y)); }), false,
        {});
    std::size_t important = 0;
    for (const float v : map.importance.samples)
        important += v > 6.0f;
    EXPECT_LT(important, map.importance.samples.size() / 500);
}

}  // namespace
