// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/mosaic.h>

#include <algorithm>
#include <cmath>

#include "painting/scene.h"

using namespace pimg;
using test::PaintedScene;

namespace {

struct TiledScene : PaintedScene {
    Mesh mesh;
    Tiling tiling;

    explicit TiledScene(test::Picture p) : PaintedScene(std::move(p))
    {
        EXPECT_TRUE(refine(hierarchy, hierarchy.level_of_vertices(200), mesh).ok());
        tiling = tile(mesh);
    }
};

TEST(Mosaic, TilesCoverThePictureAndKeepTheirMean)
{
    const TiledScene scene(test::scene(100, 70));
    std::size_t outside = 0;
    for (std::size_t i = 0; i < scene.tiling.tile.size(); ++i) {
        ASSERT_LT(scene.tiling.tile[i], scene.mesh.size());
        outside += scene.tiling.inside[i] < -0.5f;
    }
    EXPECT_LE(outside, scene.tiling.tile.size() / 100);
    std::vector<float> samples = scene.samples;
    lay_mosaic(scene.tiling, scene.mesh.size(), { 0.0f, 0.0f, 0.0f, {} }, { 0.0f }, { samples.data() });
    double before = 0, after = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        before += double(scene.samples[i]);
        after += double(samples[i]);
    }
    EXPECT_NEAR(before / after, 1.0, 1e-5);
}

TEST(Mosaic, WaysFromTheJointsAreUnitVectors)
{
    const TiledScene scene(test::scene(100, 70));
    for (std::size_t i = 0; i < scene.tiling.tile.size(); ++i) {
        const float x = scene.tiling.away_x[i], y = scene.tiling.away_y[i], square = x * x + y * y;
        EXPECT_TRUE(square == 0.0f || std::fabs(square - 1.0f) < 1e-5f) << square;
    }
}

TEST(Mosaic, DoesNotDependOnTheOrderOfTheStrips)
{
    const TiledScene scene(test::scene(150, 200));
    const Tiling reverse = tile(scene.mesh, test::backwards);
    EXPECT_EQ(scene.tiling.tile, reverse.tile);
    EXPECT_EQ(scene.tiling.inside, reverse.inside);
    std::vector<float> a = scene.samples, b = scene.samples, a2 = a, b2 = b;
    lay_mosaic(scene.tiling, scene.mesh.size(), {}, { 9.0f, 3.0f }, { a.data(), a2.data() });
    lay_mosaic(scene.tiling, scene.mesh.size(), { 1.5f, 2.0f, 0.5f, test::backwards }, { 9.0f, 3.0f },
               { b.data(), b2.data() });
    EXPECT_EQ(a, b);
    EXPECT_EQ(a2, b2);
}

TEST(Mosaic, ConstantPictureShowsOnlyJointsAndSlopes)
{
    const TiledScene scene(test::make("constant", 90, 60, [](int, int) { return 50; }));
    std::vector<float> plain = scene.samples, jointed = scene.samples, lit = scene.samples;
    lay_mosaic(scene.tiling, scene.mesh.size(), { 0.0f, 0.0f, 0.0f, {} }, { 0.0f }, { plain.data() });
    EXPECT_EQ(plain, scene.samples);
    lay_mosaic(scene.tiling, scene.mesh.size(), { 2.0f, 0.0f, 0.0f, {} }, { 10.0f }, { jointed.data() });
    std::size_t joints = 0;
    for (const float v : jointed) {
        EXPECT_TRUE(v >= 10.0f && v <= 50.0f) << v;
        joints += v < 50.0f;
    }
    EXPECT_GT(joints, 100u);
    EXPECT_LT(joints, jointed.size());
    lay_mosaic(scene.tiling, scene.mesh.size(), { 0.0f, 4.0f, 1.0f, {} }, { 0.0f }, { lit.data() });
    std::size_t bright = 0, dark = 0;
    for (const float v : lit) {
        EXPECT_TRUE(v >= 50.0f * 0.4f && v <= 50.0f * 1.6f) << v;
        bright += v > 50.0f;
        dark += v < 50.0f;
    }
    EXPECT_GT(bright, 100u);
    EXPECT_GT(dark, 100u);
}

TEST(Mosaic, TilesChangeByChanceAndTheSeed)
{
    const TiledScene scene(test::make("constant", 90, 60, [](int, int) { return 50; }));
    const auto laid = [&](float variation, std::uint32_t seed) {
        std::vector<float> samples = scene.samples;
        lay_mosaic(scene.tiling, scene.mesh.size(), { 0.0f, 0.0f, 0.0f, {}, variation, 0.0f, seed }, { 0.0f },
                   { samples.data() });
        return samples;
    };
    const std::vector<float> a = laid(0.2f, 1);
    EXPECT_EQ(laid(0.0f, 1), scene.samples);
    EXPECT_NE(a, laid(0.2f, 2));
    std::vector<float> of_tile(scene.mesh.size(), 0.0f);
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_TRUE(a[i] >= 40.0f - 1e-3f && a[i] <= 60.0f + 1e-3f) << a[i];
        float& known = of_tile[scene.tiling.tile[i]];
        EXPECT_TRUE(known == 0.0f || known == a[i]) << "one colour to a tile";
        known = a[i];
    }
}

TEST(Mosaic, GlassGlowsBetweenRoundLead)
{
    const TiledScene scene(test::make("constant", 90, 60, [](int, int) { return 50; }));
    std::vector<float> samples = scene.samples;
    TileOptions options;
    options.leading = 4.0f;
    lay_mosaic(scene.tiling, scene.mesh.size(), options, { 10.0f }, { samples.data() });
    std::size_t lead = 0, shining = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        lead += samples[i] < 25.0f;
        shining += samples[i] > 10.5f && samples[i] < 19.0f;
        if (scene.tiling.inside[i] > 6.0f) {
            EXPECT_TRUE(samples[i] > 30.0f && samples[i] <= 55.0f) << samples[i];
        }
    }
    EXPECT_GT(lead, samples.size() / 20);
    EXPECT_GT(shining, 50u) << "the side towards the light";
}

TEST(Mosaic, GlassOfPureColourHasNoLightBelowZero)
{
    const TiledScene scene(test::make("constant", 90, 60, [](int, int) { return 50; }));
    std::vector<float> red = scene.samples, green(red.size(), 1.0f), blue(red.size(), -2.0f);
    TileOptions options;
    options.leading = 4.0f;
    lay_mosaic(scene.tiling, scene.mesh.size(), options, { 0.0f, 0.0f, 0.0f },
               { red.data(), green.data(), blue.data() });
    EXPECT_GE(*std::min_element(green.begin(), green.end()), 0.0f);
    EXPECT_LT(*std::min_element(blue.begin(), blue.end()), -1.0f) << "colours outside of the gamut stay outside";
}

}  // namespace
