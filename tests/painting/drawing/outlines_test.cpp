// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/outlines.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/pictures.h"
#include "drawing/raster_ops.h"

using namespace pimg;

namespace {

constexpr int kSize = 200;

template<class F>
Raster picture(F&& f)
{
    Raster raster = make_raster(kSize, kSize);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            raster.samples[std::size_t(y * kSize + x)] = f(x, y);
    return raster;
}

/// A disk of radius 60 with a rim that is `soft` pixels wide.
Raster disk(float contrast, float soft)
{
    return picture([=](int x, int y) {
        const float r = std::hypot(float(x) - 100.0f, float(y) - 100.0f);
        return 40.0f + contrast * std::clamp((60.0f - r) / soft + 0.5f, 0.0f, 1.0f);
    });
}

Drawing outlined(const std::vector<Raster>& features, const std::vector<Raster>& base, float detail = 0.5f)
{
    Drawing drawing;
    drawing.width = drawing.height = kSize;
    OutlineOptions options;
    options.detail = detail;
    add_outlines(features, base, options, drawing);
    return drawing;
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
        Drawing drawing;
        OutlineOptions options;
        options.parallel = parallel;
        add_outlines({ noisy }, { noisy }, options, drawing);
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
