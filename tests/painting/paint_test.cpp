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
    settings.edges = settings.ground = &scene.guides;
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

TEST(Paint, OfThinStrokesLeavesTheirShare)
{
    const PaintedScene flat(test::make("constant", 64, 48, [](int, int) { return 100; }));
    Strokes strokes { 64, 48, { { 0, 2, 20.0f } }, { { 20, 24 }, { 44, 24 } } };
    for (const float opacity : { 0.0f, 0.25f, 1.0f }) {
        strokes.strokes[0].opacity = opacity;
        std::vector<float> canvas(flat.samples.size(), 0.0f);
        Canvas target { 64, 48, { canvas.data() } };
        paint_strokes(strokes, { { 100.0f } }, Brush::named("round"), {}, target);
        EXPECT_NEAR(canvas[24 * 64 + 32], 100.0f * opacity, 1e-3f);
    }
}

/// A dot is as long as it is wide, and its corners are bare.
TEST(Paint, OfNoLengthIsARoundDot)
{
    const Strokes dot { 64, 48, { { 0, 2, 20.0f } }, { { 32, 24 }, { 32.01f, 24 } } };
    std::vector<float> canvas(64 * 48, 0.0f);
    Canvas target { 64, 48, { canvas.data() } };
    paint_strokes(dot, { { 1.0f } }, Brush::named("round"), {}, target);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const double r = std::hypot(x - 32, y - 24);
            if (r < 8.0 || r > 11.0) {
                EXPECT_NEAR(canvas[std::size_t(y * 64 + x)], r < 8.0 ? 1.0f : 0.0f, 0.02f) << x << ", " << y;
            }
        }
}

/// The tooth keeps chalk off some of the canvas, the same pixels whatever is drawn.
TEST(Paint, OfChalkLeavesTheValleysOfTheCanvas)
{
    const Strokes strokes { 64, 48, { { 0, 2, 40.0f } }, { { 12, 24 }, { 52, 24 } } };
    const auto drawn = [&](const char* brush, float colour) {
        std::vector<float> canvas(64 * 48, 0.0f);
        Canvas target { 64, 48, { canvas.data() } };
        paint_strokes(strokes, { { colour } }, Brush::named(brush), {}, target);
        return canvas;
    };
    const std::vector<float> chalk = drawn("chalk", 1.0f), again = drawn("chalk", 2.0f), oil = drawn("round", 1.0f);
    int bare = 0, covered = 0;
    for (int y = 18; y < 30; ++y)
        for (int x = 20; x < 44; ++x) {
            const std::size_t at = std::size_t(y * 64 + x);
            bare += chalk[at] < 0.1f;
            covered += chalk[at] > 0.5f;
            EXPECT_NEAR(again[at], 2.0f * chalk[at], 1e-5f);
            EXPECT_GT(oil[at], 0.99f);
        }
    EXPECT_GT(bare, 12 * 24 / 50);
    EXPECT_GT(covered, 12 * 24 / 3);
}

TEST(Paint, ChangesColoursOfStrokesByChance)
{
    const PaintedScene flat(test::make("constant", 90, 70, [](int, int) { return 100; }));
    StrokePaintOptions settings;
    settings.jitter_colour = 0.2f;
    const std::vector<float> canvas = painted(flat, {}, Brush::named("round"), settings, 100.0f);
    const auto [least, most] = std::minmax_element(canvas.begin(), canvas.end());
    EXPECT_GE(*least, 100.0f * (1.0f - 0.2f) - 1e-3f) << "of one channel only the brightness changes";
    EXPECT_LE(*most, 100.0f * (1.0f + 0.2f) + 1e-3f);
    EXPECT_GT(*most - *least, 10.0f);
}

TEST(Paint, ChangesDarkColoursAsMuchAsMiddleOnesIfWhiteIsKnown)
{
    const auto spread = [](int value, float white) {
        const PaintedScene flat(test::make("constant", 90, 70, [=](int, int) { return value; }));
        StrokePaintOptions settings;
        settings.jitter_colour = 0.1f;
        settings.white = white;
        const std::vector<float> canvas = painted(flat, {}, Brush::named("round"), settings, float(value));
        const auto [least, most] = std::minmax_element(canvas.begin(), canvas.end());
        return *most - *least;
    };
    EXPECT_NEAR(spread(40, 250.0f), spread(112, 0.0f), 2.0f);
    EXPECT_FLOAT_EQ(spread(125, 250.0f), spread(125, 0.0f));
    EXPECT_FLOAT_EQ(spread(200, 250.0f), spread(200, 0.0f));
    EXPECT_LT(spread(2, 250.0f), 2.5f) << "black stays black";
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

TEST(Relief, IsStrongerInTheDarkIfWhiteIsKnown)
{
    const auto change = [](float value, float white) {
        std::vector<float> color(90, value), relief(90);
        for (std::size_t i = 0; i < relief.size(); ++i)
            relief[i] = i % 9 == 4 ? 3.0f : 0.0f;
        Canvas canvas { 9, 10, { color.data() }, relief.data() };
        light_relief(canvas, 0.4f, {}, white);
        return color[3] / value - 1.0f;
    };
    EXPECT_GT(change(0.2f, 1.0f), 1.5f * change(0.2f, 0.0f));
    EXPECT_FLOAT_EQ(change(0.6f, 1.0f), change(0.6f, 0.0f));
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
