// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/outlines.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/pictures.h"
#include "painting/drawing/rasters.h"

using namespace pimg;

namespace {

constexpr int kSize = 200;

template<class F>
Raster picture(F&& f)
{
    return test::raster_of(kSize, kSize, f);
}

/// A disk of radius 60 with a rim that is `soft` pixels wide.
Raster disk(float contrast, float soft)
{
    return picture([=](int x, int y) {
        const float r = std::hypot(float(x) - 100.0f, float(y) - 100.0f);
        return 40.0f + contrast * std::clamp((60.0f - r) / soft + 0.5f, 0.0f, 1.0f);
    });
}

/// A study of segments without borders.
Study study_of(const std::vector<Raster>& features, const std::vector<Raster>& base)
{
    return { features[0], features, base, make_raster(kSize, kSize) };
}

Drawing empty()
{
    Drawing drawing;
    drawing.width = drawing.height = kSize;
    return drawing;
}

Drawing outlined(const Study& study, float detail = 0.5f)
{
    Drawing drawing = empty();
    OutlineOptions options;
    options.detail = detail;
    add_outlines(study, options, drawing);
    return drawing;
}

Drawing outlined(const std::vector<Raster>& features, const std::vector<Raster>& base, float detail = 0.5f)
{
    return outlined(study_of(features, base), detail);
}

Drawing outlined(const Raster& raster, float detail = 0.5f)
{
    return outlined({ raster }, { raster }, detail);
}

TEST(Outlines, OfADiskAreOneCircle)
{
    const Drawing drawing = outlined(disk(120.0f, 1.0f));
    ASSERT_EQ(drawing.lines.size(), 1u);
    EXPECT_NEAR(float(drawing.points.size()), 2.0f * 3.14159f * 60.0f, 15.0f);
    for (const InkPoint& p : drawing.points) {
        EXPECT_NEAR(std::hypot(p.x - 100.0f, p.y - 100.0f), 60.0f, 0.7f);
        EXPECT_GT(p.width, 0.0f);
    }
}

TEST(Outlines, AreWiderWhereThereIsMoreContrast)
{
    const auto middle = [](const Drawing& drawing) {
        return drawing.points.at(drawing.points.size() / 2).width;
    };
    EXPECT_GT(middle(outlined(disk(150.0f, 1.0f))), 1.2f * middle(outlined(disk(40.0f, 1.0f))));
}

TEST(Outlines, AreOfNeitherBlurNorNoise)
{
    EXPECT_TRUE(outlined(disk(120.0f, 60.0f)).lines.empty());
    EXPECT_TRUE(outlined(picture([](int x, int y) {
                    return 100.0f + 30.0f * test::noise(std::uint32_t(x), std::uint32_t(y));
                })).lines.empty());
    EXPECT_TRUE(outlined(make_raster(kSize, kSize, 90.0f)).lines.empty());
}

TEST(Outlines, NeedMoreContrastIfTheBaseHasLostThem)
{
    const Raster flat = make_raster(kSize, kSize, 40.0f), sharp = disk(120.0f, 1.0f);
    EXPECT_TRUE(outlined({ sharp }, { flat }).lines.empty());
}

TEST(Outlines, FollowBordersThatLastIfTheBaseHasLostThem)
{
    const Raster flat = make_raster(kSize, kSize, 40.0f), faint = disk(40.0f, 1.0f);
    Study study = study_of({ faint }, { flat });
    EXPECT_TRUE(outlined(study).lines.empty());
    study.borders = make_raster(kSize, kSize, 800.0f);
    EXPECT_EQ(outlined(study).lines.size(), 1u);
}

TEST(Outlines, GoOnAlongBordersThatLastWhereThereIsLittleContrast)
{
    // A step of 60 that becomes as low as 8 towards the middle, where the base has lost it.
    const auto step = [](float faint) {
        return picture([=](int x, int y) {
            const float t = 0.01f * float(std::abs(y - 100));
            return x < 100 ? 60.0f : 60.0f + std::max(faint, 60.0f * t * t);
        });
    };
    Study study = study_of({ step(8.0f) }, { step(0.0f) });
    EXPECT_GE(outlined(study).lines.size(), 2u);
    study.borders = picture([](int x, int) { return std::abs(x - 100) < 4 ? 800.0f : 0.0f; });
    const Drawing whole = outlined(study);
    ASSERT_EQ(whole.lines.size(), 1u);
    EXPECT_GT(whole.lines[0].count, 180u);
}

/// A slanting line two pixels wide.
Raster cable(float contrast)
{
    return picture([=](int x, int y) {
        const float off = std::fabs(float(y) - 60.0f - 0.3f * float(x));
        return 120.0f + contrast * std::clamp(1.5f - off, 0.0f, 1.0f);
    });
}

TEST(Outlines, OfAThinDarkLineAreOneLine)
{
    const Drawing drawing = outlined(cable(-40.0f));
    ASSERT_EQ(drawing.lines.size(), 1u);
    EXPECT_GT(drawing.points.size(), 180u);
    for (const InkPoint& p : drawing.points)
        EXPECT_NEAR(p.y, 60.0f + 0.3f * p.x, 1.0f);
}

TEST(Outlines, LeaveThinLightLinesWhite)
{
    OutlineOptions options;
    Drawing light = empty(), dark = empty();
    add_highlights(study_of({ cable(40.0f) }, { cable(40.0f) }), options, light);
    add_highlights(study_of({ cable(-40.0f) }, { cable(-40.0f) }), options, dark);
    EXPECT_EQ(light.lines.size(), 1u);
    EXPECT_TRUE(dark.lines.empty());
}

TEST(Outlines, AreMoreWithMoreDetail)
{
    const Raster grid = picture([](int x, int y) {
        const int strength = 1 + x / 40;
        return 100.0f + float(strength) * (((x % 40 < 20) ^ (y % 40 < 20)) ? 6.0f : -6.0f);
    });
    std::size_t before = 0;
    for (const float detail : { 0.0f, 0.5f, 1.0f }) {
        const std::size_t points = outlined(grid, detail).points.size();
        EXPECT_GE(points, before);
        before = points;
    }
    EXPECT_GT(outlined(grid, 1.0f).points.size(), outlined(grid, 0.0f).points.size() + 500);
}

TEST(Outlines, SeeColoursOfOneBrightness)
{
    const Raster red = disk(90.0f, 1.0f);
    Raster green = red;
    for (float& v : green.samples)
        v = 170.0f - v;
    EXPECT_EQ(outlined({ red, green }, { red, green }).lines.size(), 1u);
}

TEST(Outlines, DoNotDependOnTheLoop)
{
    Raster noisy = disk(120.0f, 2.0f);
    for (std::size_t i = 0; i < noisy.samples.size(); ++i)
        noisy.samples[i] += 20.0f * test::noise(std::uint32_t(i), 3);
    const auto drawn = [&](const ParallelFor& parallel) {
        Drawing drawing = empty();
        OutlineOptions options;
        options.parallel = parallel;
        add_outlines(study_of({ noisy }, { noisy }), options, drawing);
        return drawing.points;
    };
    const auto a = drawn({}), b = drawn([](std::size_t n, const std::function<void(std::size_t)>&body) {
                                  for (std::size_t i = n; i-- > 0;)
                                      body(i);
                              });
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_TRUE(a[i].x == b[i].x && a[i].y == b[i].y && a[i].width == b[i].width);
}

}  // namespace
