// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/paint.h>

#include <algorithm>
#include <cmath>

#include "painting/scene.h"

using namespace pimg;
using test::PaintedScene;

namespace {

constexpr const char* kNames[] = { "round", "flat", "bristle", "knife" };

std::vector<float> painted(const PaintedScene& scene, const StrokeOptions& options, const Brush& brush,
                           StrokePaintOptions settings, float ground)
{
    const Strokes strokes = scene.strokes(options);
    const auto colours = stroke_colours(strokes, scene.guides, scene.guides, options.parallel);
    std::vector<float> canvas(scene.samples.size(), ground);
    Canvas target { scene.guides.width, scene.guides.height, { canvas.data() }, nullptr };
    settings.parallel = options.parallel;
    paint_strokes(strokes, colours, brush, settings, target);
    return canvas;
}

TEST(Paint, LeavesNoHoles)
{
    // On a ground far from any colour of the picture.
    const PaintedScene scene(test::scene(200, 150));
    for (const char* name : kNames) {
        const std::vector<float> canvas = painted(scene, {}, Brush::named(name), {}, -10000.0f);
        std::size_t bare = 0;
        for (float v : canvas)
            bare += v < -5000.0f;
        EXPECT_LE(bare, canvas.size() / 250) << name;
    }
}

TEST(Paint, DoesNotDependOnTheOrderOfTheTiles)
{
    const PaintedScene scene(test::scene(200, 150));
    StrokeOptions forwards, reverse;
    reverse.parallel = test::backwards;
    StrokePaintOptions settings;
    settings.edges = &scene.guides;
    const Brush brush = Brush::named("bristle");
    EXPECT_EQ(painted(scene, forwards, brush, settings, 0.0f), painted(scene, reverse, brush, settings, 0.0f));
}

TEST(Paint, StaysOnItsSideOfAnEdge)
{
    const PaintedScene scene(test::make("step", 120, 90, [](int x, int y) { return x + y / 3 < 70 ? 30 : 220; }));
    StrokePaintOptions settings;
    settings.edges = &scene.guides;
    const std::vector<float> canvas = painted(scene, {}, Brush::named("round"), settings, 125.0f);
    for (int y = 1; y < 89; ++y)  // the rim may be thinly covered: LeavesNoHoles
        for (int x = 1; x < 119; ++x) {
            const int off = x + y / 3 - 70;
            if (off < -2 || off > 2) {
                EXPECT_NEAR(canvas[std::size_t(y * 120 + x)], off < 0 ? 30.0f : 220.0f, 12.0f) << x << ", " << y;
            }
        }
}

TEST(Paint, OfOpacityZeroChangesNothing)
{
    const PaintedScene scene(test::scene(64, 48));
    StrokePaintOptions settings;
    settings.opacity = 0.0f;
    EXPECT_EQ(painted(scene, {}, Brush::named("bristle"), settings, 7.0f), std::vector<float>(64 * 48, 7.0f));
}

/// One colour everywhere: paint adds nothing to it but the grain of the brush, and covers any ground.
TEST(Paint, OfAConstantPictureHasItsColour)
{
    const PaintedScene flat(test::make("constant", 64, 48, [](int, int) { return 100; }));
    for (const char* name : kNames) {
        const Brush brush = Brush::named(name);
        const float most = 100.0f * (1.0f + 0.5f * brush.grain()) + 1e-3f;
        const float least = 100.0f * (1.0f - 0.5f * brush.grain()) - 1e-3f;
        for (const float v : painted(flat, {}, brush, {}, 100.0f))
            EXPECT_TRUE(v >= least && v <= most) << name << ": " << v;
        // On black, gaps show between the hairs; but most of the canvas has the colour.
        std::size_t covered = 0;
        for (const float v : painted(flat, {}, brush, {}, 0.0f)) {
            EXPECT_TRUE(v >= 0.0f && v <= most) << name << ": " << v;
            covered += v >= least;
        }
        EXPECT_GE(covered, std::size_t(64 * 48 * 8 / 10)) << name;
    }
}

TEST(Paint, ShowsTheGroundInHoles)
{
    const PaintedScene scene(test::scene(80, 60));
    std::vector<float> canvas(scene.samples.size(), -10000.0f);
    Canvas target { scene.guides.width, scene.guides.height, { canvas.data() }, nullptr };
    StrokePaintOptions settings;
    settings.ground = &scene.guides;
    paint_strokes({}, { {} }, Brush::named("round"), settings, target);
    EXPECT_EQ(canvas, scene.samples) << "without strokes all is one hole";
}

TEST(Paint, WorksOnEveryAwkwardPicture)
{
    for (const test::Picture& p : test::awkward_pictures()) {
        const PaintedScene scene(p);
        for (float v : painted(scene, {}, Brush::named("bristle"), {}, 1.0f))
            EXPECT_TRUE(std::isfinite(v)) << p.name;
    }
}

TEST(Relief, EvenPaintKeepsItsColour)
{
    std::vector<float> color(100, 3.5f), relief(100, 2.0f);
    Canvas canvas { 10, 10, { color.data() }, relief.data() };
    light_relief(canvas, 1.0f);
    EXPECT_EQ(color, std::vector<float>(100, 3.5f));
}

TEST(Relief, IsLitFromTheUpperLeft)
{
    // A ridge in the middle column: its left slope faces the light.
    std::vector<float> color(90, 1.0f), relief(90);
    for (std::size_t i = 0; i < relief.size(); ++i)
        relief[i] = i % 9 == 4 ? 3.0f : 0.0f;
    Canvas canvas { 9, 10, { color.data() }, relief.data() };
    light_relief(canvas, 1.0f, test::backwards);
    for (std::size_t y = 0; y < 10; ++y) {
        EXPECT_GT(color[9 * y + 3], 1.1f);
        EXPECT_LT(color[9 * y + 5], 0.9f);
        EXPECT_EQ(color[9 * y + 1], 1.0f);
        EXPECT_LE(color[9 * y + 3], 1.5f);
    }
}

}  // namespace
