// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/strokes.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "painting/scene.h"

using namespace pimg;
using test::PaintedScene;

namespace {

bool same(const Strokes& a, const Strokes& b)
{
    const auto same_stroke = [](const Stroke& x, const Stroke& y) {
        return x.first == y.first && x.count == y.count && x.width == y.width && x.vertex == y.vertex
            && x.level == y.level && x.variation == y.variation && x.opacity == y.opacity;
    };
    const auto same_point = [](Vec2 x, Vec2 y) {
        return x.x == y.x && x.y == y.y;
    };
    return std::equal(a.strokes.begin(), a.strokes.end(), b.strokes.begin(), b.strokes.end(), same_stroke)
        && std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), same_point);
}

TEST(Strokes, HaveWidthsInTheRangeAndPointsInThePicture)
{
    const PaintedScene scene(test::scene(160, 120));
    for (const float min : { 1.0f, 3.0f, 8.0f }) {
        StrokeOptions options;
        options.min = min;
        options.max = 4.0f * min;
        options.jitter_size = 1.0f;
        options.jitter_angle = 1.0f;
        const Strokes strokes = scene.strokes(options);
        EXPECT_GT(strokes.strokes.size(), 20u);
        for (const Stroke& s : strokes.strokes) {
            EXPECT_GE(s.width, options.min);
            EXPECT_LE(s.width, options.max);
            EXPECT_GE(s.count, 2u);
            for (Index k = 0; k < s.count; ++k) {
                EXPECT_GT(strokes.begin(s)[k].x, -options.max);
                EXPECT_LT(strokes.begin(s)[k].x, 160.0f + options.max);
                EXPECT_GT(strokes.begin(s)[k].y, -options.max);
                EXPECT_LT(strokes.begin(s)[k].y, 120.0f + options.max);
            }
        }
    }
}

TEST(Strokes, AreFinerWhereTheDetailMapAsksForIt)
{
    const PaintedScene scene(test::scene(160, 160));
    std::vector<float> map(scene.samples.size());
    for (std::size_t i = 0; i < map.size(); ++i)
        map[i] = i < map.size() / 2 ? 0.75f : 0.25f;
    StrokeOptions options;
    options.min = 6.0f;
    options.max = 12.0f;
    options.detail = map.data();
    const Strokes strokes = scene.strokes(options);
    int above = 0, below = 0;
    for (const Stroke& s : strokes.strokes)
        (strokes.begin(s)[s.count / 2].y < 80.0f ? above : below)++;
    EXPECT_GT(above, 3 * below);
}

TEST(Strokes, DependOnTheSeedButNotOnTheOrderOfTheWork)
{
    const PaintedScene scene(test::scene(160, 120));
    StrokeOptions options, reverse, other;
    reverse.parallel = test::backwards;
    other.seed = 2;
    EXPECT_TRUE(same(scene.strokes(options), scene.strokes(reverse)));
    EXPECT_FALSE(same(scene.strokes(options), scene.strokes(other)));
}

TEST(Strokes, AreFewerWhenMoreIsTolerated)
{
    const PaintedScene scene(test::scene(160, 120));
    std::size_t before = std::size_t(-1);
    for (const float tolerance : { 0.0f, 3.0f, 10.0f, 30.0f }) {
        StrokeOptions options;
        options.tolerance = tolerance;
        const Strokes strokes = scene.strokes(options);
        // Without those that only fill gaps, which become more.
        const auto count = std::size_t(std::count_if(strokes.strokes.begin(), strokes.strokes.end(),
                                                     [](const Stroke& s) { return s.vertex != kGhost; }));
        EXPECT_LT(count, before) << tolerance;
        before = count;
    }
}

TEST(Strokes, AreLeftOutByChanceBelowFullCover)
{
    const PaintedScene scene(test::scene(160, 120));
    StrokeOptions all, half, none;
    all.tolerance = half.tolerance = none.tolerance = 0.0f;
    half.cover = 0.5f;
    none.cover = 0.0f;
    const double count = double(scene.strokes(all).strokes.size());
    EXPECT_NEAR(double(scene.strokes(half).strokes.size()), 0.5 * count, 0.1 * count);
    EXPECT_TRUE(scene.strokes(none).strokes.empty());
}

/// Noise changes how thickly strokes are painted, and hardly which ones and where: of the strokes on one of two pictures, most
/// are on the other, too.
TEST(Strokes, AreMostlyTheSameUnderNoise)
{
    const auto noisy = [](std::uint32_t seed) {
        return PaintedScene(test::make("noisy", 160, 120,
                                       [=](int x, int y) {
                                           const std::uint32_t bits =
                                               scramble(std::uint32_t(x) + scramble(std::uint32_t(y) + seed));
                                           const float triangular = signed_unit(bits) + signed_unit(scramble(bits));
                                           return test::scene(x, y, 160, 120) + 2.4f * triangular;  // sigma 2
                                       }))
            .strokes({});
    };
    const auto thick = [](const Strokes& strokes) {
        std::set<std::uint32_t> places;
        for (const Stroke& s : strokes.strokes)
            if (s.opacity > 0.5f && (s.vertex != kGhost || s.level == 0))
                places.insert(s.variation);
        return places;
    };
    const std::set<std::uint32_t> a = thick(noisy(1)), b = thick(noisy(2));
    std::size_t both = 0;
    for (const std::uint32_t place : a)
        both += b.count(place);
    EXPECT_GT(both, a.size() * 3 / 4);
}

TEST(Strokes, CoverTheCanvasWithTheWidestBrush)
{
    const PaintedScene flat(test::make("constant", 160, 120, [](int, int) { return 90; }));
    StrokeOptions options;
    options.max = 20.0f;
    const Strokes strokes = flat.strokes(options);
    // Narrower ones are only in the gaps, as there is nothing else to improve.
    float wide = 0.0f, narrow = 0.0f;
    for (const Stroke& s : strokes.strokes)
        (s.width > 19.9f ? wide : narrow) += s.opacity * s.width * s.width * float(s.count);
    EXPECT_GT(wide, 5.0f * narrow);
    EXPECT_GT(wide, 160.0f * 120.0f);
}

TEST(Strokes, DoNotRunAcrossAnEdge)
{
    const PaintedScene scene(test::make("step", 120, 90, [](int x, int) { return x < 60 ? 30 : 220; }));
    const Strokes strokes = scene.strokes({});
    ASSERT_GT(strokes.strokes.size(), 20u);
    for (const Stroke& s : strokes.strokes) {
        float left = 1e9f, right = -1e9f;
        for (Index k = 0; k < s.count; ++k) {
            left = std::min(left, strokes.begin(s)[k].x);
            right = std::max(right, strokes.begin(s)[k].x);
        }
        // The edge lies at 59.5; the smoothed picture, by which strokes are planned, has it two pixels wide.
        EXPECT_FALSE(left < 57.5f && right > 61.5f) << left << " to " << right;
    }
}

TEST(Strokes, HaveColoursWithinThoseOfThePicture)
{
    const PaintedScene scene(test::scene(120, 90));
    const Strokes strokes = scene.strokes({});
    const auto colours = stroke_colours(strokes, scene.guides, scene.guides);
    const auto reverse = stroke_colours(strokes, scene.guides, scene.guides, test::backwards);
    ASSERT_EQ(colours.size(), 1u);
    EXPECT_EQ(colours, reverse);
    ASSERT_EQ(colours[0].size(), strokes.strokes.size());
    const auto [least, most] = std::minmax_element(scene.samples.begin(), scene.samples.end());
    for (const float v : colours[0])
        EXPECT_TRUE(v >= *least && v <= *most) << v;
}

}  // namespace
