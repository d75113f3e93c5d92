// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/strokes.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <pimg/ink.h>
#include <pimg/mosaic.h>
#include <pimg/paint.h>
#include <pimg/simplify.h>
#include <pimg/stroke_file.h>

#include "core/pictures.h"

using namespace pimg;
using test::Picture;

namespace {

struct Scene {
    Picture picture;
    Hierarchy hierarchy;
    Planes guides;
    std::vector<float> samples;

    explicit Scene(Picture p) : picture(std::move(p))
    {
        Guide guide;
        guide.width = picture.width;
        guide.height = picture.height;
        guide.channels.resize(1);
        guide.channels[0].samples = picture.samples.data();
        std::vector<Bands> bands;
        const Status status = simplify(guide, {}, hierarchy, bands);
        EXPECT_TRUE(status.ok()) << status.error();
        samples = to_mesh_pixels(hierarchy, picture.samples.data());
        guides = { hierarchy.mesh_width(), hierarchy.mesh_height(), { samples.data() } };
    }
};

/// Runs the bodies last to first, as no loop would.
void backwards(std::size_t n, const std::function<void(std::size_t)>& body)
{
    for (std::size_t i = n; i-- > 0;)
        body(i);
}

std::vector<float> painted(const Scene& scene, const StrokeOptions& options, const Brush& brush, PaintSettings settings,
                           float ground)
{
    const DirectionField field(scene.guides, options.parallel);
    Strokes strokes;
    EXPECT_TRUE(plan_strokes(scene.hierarchy, scene.guides, field, options, strokes).ok());
    const auto colors = stroke_colors(strokes, scene.guides, scene.guides, options.parallel);
    std::vector<float> canvas(scene.samples.size(), ground);
    Canvas target { scene.guides.width, scene.guides.height, { canvas.data() }, nullptr };
    settings.parallel = options.parallel;
    paint_strokes(strokes, colors, brush, settings, target);
    return canvas;
}

float turn_between(Vec2 a, Vec2 b)
{
    return std::fabs(a.x * b.x + a.y * b.y);
}

TEST(DirectionField, runs_along_straight_edges_and_into_flat_places)
{
    for (const float angle : { 0.0f, 0.4f, 1.2f, 2.3f }) {
        const Vec2 along { std::cos(angle), std::sin(angle) };
        const Picture p = test::make("edge", 96, 80, [&](int x, int y) {
            return (float(x) - 48.0f) * along.y - (float(y) - 40.0f) * along.x > 0 ? 200.0f : 40.0f;
        });
        const DirectionField field(Planes { p.width, p.height, { p.samples.data() } });
        for (const Vec2 place : { Vec2 { 48, 40 }, Vec2 { 47, 41 }, Vec2 { 3, 3 }, Vec2 { 90, 75 }, Vec2 { 95, 0 } })
            EXPECT_GT(turn_between(field.at(place), along), 0.92f) << angle << " at " << place.x << ", " << place.y;
    }
}

TEST(DirectionField, is_a_unit_vector_even_where_there_is_nothing)
{
    for (const Picture& p : test::awkward_pictures()) {
        const DirectionField field(Planes { p.width, p.height, { p.samples.data() } });
        for (const Vec2 place : { Vec2 { 0, 0 }, Vec2 { -5, 3 }, Vec2 { 500, 500 }, Vec2 { 0.4f, 0.9f } }) {
            const Vec2 d = field.at(place);
            EXPECT_NEAR(d.x * d.x + d.y * d.y, 1.0f, 1e-4f) << p.name;
        }
    }
}

TEST(Strokes, have_widths_in_the_range_and_points_in_the_picture)
{
    const Scene scene(test::scene(160, 120));
    const DirectionField field(scene.guides);
    for (const float min : { 1.0f, 3.0f, 8.0f }) {
        StrokeOptions options;
        options.min = min;
        options.max = 4.0f * min;
        options.jitter_size = 1.0f;
        options.jitter_angle = 1.0f;
        Strokes strokes;
        ASSERT_TRUE(plan_strokes(scene.hierarchy, scene.guides, field, options, strokes).ok());
        EXPECT_GT(strokes.strokes.size(), 20u);
        for (const Stroke& s : strokes.strokes) {
            EXPECT_GE(s.width, options.min);
            EXPECT_LE(s.width, options.max);
            EXPECT_GE(s.count, 2u);
            for (Index k = 0; k < s.count; ++k) {
                EXPECT_GT(strokes.begin(s)[k].x, -options.max);
                EXPECT_LT(strokes.begin(s)[k].x, 160.0f + options.max);
            }
        }
    }
}

TEST(Strokes, are_finer_where_the_detail_map_asks_for_it)
{
    const Scene scene(test::scene(160, 160));
    const DirectionField field(scene.guides);
    std::vector<float> map(scene.samples.size());
    for (std::size_t i = 0; i < map.size(); ++i)
        map[i] = i < map.size() / 2 ? 0.75f : 0.25f;
    StrokeOptions options;
    options.min = options.max = 6.0f;
    options.max = 12.0f;
    options.detail = map.data();
    Strokes strokes;
    ASSERT_TRUE(plan_strokes(scene.hierarchy, scene.guides, field, options, strokes).ok());
    int above = 0, below = 0;
    for (const Stroke& s : strokes.strokes)
        (strokes.begin(s)[s.count / 2].y < 80.0f ? above : below)++;
    EXPECT_GT(above, 3 * below);
}

TEST(Paint, leaves_no_holes)
{
    // On a ground far from any colour of the picture.
    const Scene scene(test::scene(200, 150));
    for (const char* name : { "round", "flat", "bristle", "knife" }) {
        const std::vector<float> canvas = painted(scene, {}, Brush::named(name), {}, -10000.0f);
        std::size_t bare = 0;
        for (float v : canvas)
            bare += v < -5000.0f;
        EXPECT_LE(bare, canvas.size() / 250) << name;
    }
}

TEST(Paint, does_not_depend_on_the_order_of_the_tiles)
{
    const Scene scene(test::scene(200, 150));
    StrokeOptions forwards, reverse;
    reverse.parallel = backwards;
    PaintSettings settings;
    settings.edges = &scene.guides;
    const Brush brush = Brush::named("bristle");
    EXPECT_EQ(painted(scene, forwards, brush, settings, 0.0f), painted(scene, reverse, brush, settings, 0.0f));
}

TEST(Paint, stays_on_its_side_of_an_edge)
{
    const Scene scene(test::make("step", 120, 90, [](int x, int y) { return x + y / 3 < 70 ? 30 : 220; }));
    PaintSettings settings;
    settings.edges = &scene.guides;
    const std::vector<float> canvas = painted(scene, {}, Brush::named("round"), settings, 125.0f);
    for (int y = 1; y < 89; ++y)  // the rim may be thinly covered: leaves_no_holes
        for (int x = 1; x < 119; ++x) {
            const int off = x + y / 3 - 70;
            if (off < -2 || off > 2) {
                EXPECT_NEAR(canvas[std::size_t(y * 120 + x)], off < 0 ? 30.0f : 220.0f, 12.0f) << x << ", " << y;
            }
        }
}

TEST(Paint, opacity_zero_and_constant_pictures_change_nothing)
{
    const Scene scene(test::scene(64, 48));
    PaintSettings settings;
    settings.opacity = 0.0f;
    EXPECT_EQ(painted(scene, {}, Brush::named("bristle"), settings, 7.0f), std::vector<float>(64 * 48, 7.0f));
    const Scene flat(test::make("constant", 64, 48, [](int, int) { return 100; }));
    for (float v : painted(flat, {}, Brush::named("round"), {}, 0.0f))
        EXPECT_TRUE(v == 0.0f || std::fabs(v - 100.0f) <= 100.0f);
}

TEST(Paint, works_on_every_awkward_picture)
{
    for (const Picture& p : test::awkward_pictures()) {
        const Scene scene(p);
        for (float v : painted(scene, {}, Brush::named("bristle"), {}, 1.0f))
            EXPECT_TRUE(std::isfinite(v)) << p.name;
    }
}

TEST(Brush, masks_are_shares_at_every_size)
{
    EXPECT_TRUE(Brush::named("broom").empty());
    const std::vector<float> spot { 0, 2, 1, -1 };
    std::vector<Brush> brushes { Brush::from_picture(2, 2, spot.data(), nullptr) };
    for (const char* name : { "round", "flat", "bristle", "knife" })
        brushes.push_back(Brush::named(name));
    for (const Brush& brush : brushes)
        for (const float width : { 1.0f, 3.0f, 20.0f, 500.0f }) {
            const Brush::Mask mask = brush.mask(width, 12345);
            for (float u = -0.1f; u < 1.1f; u += 0.07f)
                for (float v = -0.1f; v < 1.1f; v += 0.07f) {
                    const Paint paint = mask.at(u, v);
                    EXPECT_TRUE(paint.alpha >= 0.0f && paint.alpha <= 1.0001f);
                    EXPECT_TRUE(paint.height >= 0.0f && paint.height <= 1.0001f);
                }
        }
}

TEST(Relief, even_paint_keeps_its_colour)
{
    std::vector<float> color(100, 3.5f), relief(100, 2.0f);
    Canvas canvas { 10, 10, { color.data() }, relief.data() };
    light_relief(canvas, 1.0f);
    EXPECT_EQ(color, std::vector<float>(100, 3.5f));
}

TEST(Ink, is_denser_where_it_is_darker)
{
    const Scene scene(test::make("ramp", 256, 64, [](int x, int) { return 255 - x; }));
    const DirectionField field(scene.guides);
    std::vector<float> darkness;
    for (float v : scene.samples)
        darkness.push_back(1.0f - v / 255.0f);
    Strokes lines;
    ASSERT_TRUE(plan_ink(scene.hierarchy, darkness.data(), field, {}, lines).ok());
    double length[4] = {};
    for (const Stroke& s : lines.strokes)
        for (Index k = 0; k < s.count; ++k)
            length[std::clamp(int(lines.begin(s)[k].x / 64), 0, 3)] += 1;
    EXPECT_LT(length[0], length[1]);
    EXPECT_LT(length[1], length[2]);
    EXPECT_LT(length[2], length[3]);
}

TEST(Mosaic, tiles_cover_the_picture_and_keep_their_mean)
{
    const Scene scene(test::scene(100, 70));
    Mesh mesh;
    ASSERT_TRUE(refine(scene.hierarchy, scene.hierarchy.level_of_vertices(200), mesh).ok());
    const Tiling tiling = tile(mesh);
    std::size_t outside = 0;
    for (std::size_t i = 0; i < tiling.tile.size(); ++i) {
        ASSERT_LT(tiling.tile[i], mesh.size());
        outside += tiling.inside[i] < -0.5f;
    }
    EXPECT_LE(outside, tiling.tile.size() / 100);
    std::vector<float> samples = scene.samples;
    lay_mosaic(tiling, mesh.size(), { 0.0f, 0.0f, 0.0f, {} }, { 0.0f }, { samples.data() });
    double before = 0, after = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        before += double(scene.samples[i]);
        after += double(samples[i]);
    }
    EXPECT_NEAR(before / after, 1.0, 1e-5);
}

TEST(StrokeFile, numbers_have_points_and_colours_are_clipped)
{
    Strokes strokes;
    strokes.width = 10;
    strokes.height = 5;
    strokes.points = { { -0.5f, 1.25f }, { 3.0f, 2.0f } };
    strokes.strokes = { { 0, 2, 1.5f, kGhost, 7, 0 } };
    const std::string svg = strokes_to_svg(strokes, { { 2.0f }, { 0.5f }, { -1.0f } }, 1.0f, "#ffffff");
    EXPECT_NE(svg.find("<path stroke=\"#ff8000\" stroke-width=\"1.5\" d=\"M0 1.75L3.5 2.5\"/>"), std::string::npos)
        << svg;
    const std::string json = strokes_to_json(strokes, { { 0.0f } }, 0.25f);
    EXPECT_NE(json.find("[[-0.5, 1.25], [3, 2]], \"width\": 1.5, \"color\": [0, 0, 0], \"level\": 7, \"vertex\": -1"),
              std::string::npos)
        << json;
}

}  // namespace
