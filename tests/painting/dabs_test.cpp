// SPDX-License-Identifier: BSD-3-Clause
// Dual pieces and the dabs they offer.
#include <pimg/strokes.h>

#include <cmath>

#include "painting/scene.h"

using namespace pimg;
using test::PaintedScene;

namespace {

double area_of(const std::vector<Vec2>& polygon)
{
    double twice = 0.0;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
        twice += double(polygon[j].x) * double(polygon[i].y) - double(polygon[i].x) * double(polygon[j].y);
    return 0.5 * twice;
}

TEST(Dabs, PiecesOfALevelHaveTheAreaOfThePicture)
{
    const PaintedScene scene(test::scene(100, 70));
    for (const double vertices : { 10.0, 200.0, 3000.0 }) {
        Mesh mesh;
        ASSERT_TRUE(refine(scene.hierarchy, scene.hierarchy.level_of_vertices(vertices), mesh).ok());
        double sum = 0.0;
        for (Index v = 0; v < mesh.size(); ++v)
            sum += area_of(piece_polygon(mesh, v));
        EXPECT_NEAR(std::fabs(sum), 99.0 * 69.0, 1.0) << vertices;
    }
}

TEST(Dabs, HaveWidthsInTheRangeAndCentresInThePicture)
{
    const PaintedScene scene(test::scene(160, 120));
    const DirectionField field(scene.guides);
    for (const float min : { 1.0f, 3.0f, 8.0f }) {
        DabOptions options;
        options.min = min;
        options.max = 4.0f * min;
        std::vector<Dab> dabs;
        ASSERT_TRUE(collect_dabs(scene.hierarchy, field, options, dabs).ok());
        EXPECT_GT(dabs.size(), 20u);
        Level level = 0;
        for (const Dab& dab : dabs) {
            EXPECT_TRUE(dab.width >= options.min && dab.width <= options.max) << dab.width;
            EXPECT_GT(dab.length, 0.0f);
            EXPECT_TRUE(dab.centre.x >= 0.0f && dab.centre.x <= 159.0f && dab.centre.y >= 0.0f
                        && dab.centre.y <= 119.0f);
            EXPECT_LT(dab.vertex, scene.hierarchy.vertices());
            EXPECT_GE(dab.level, level) << "in order of the splits";
            level = dab.level;
        }
    }
}

TEST(Dabs, NoneIsLeftOutOfAnUnboundedRange)
{
    const PaintedScene scene(test::scene(50, 40));
    DabOptions options;
    options.min = 0.0f;
    options.max = 1e6f;
    std::vector<Dab> dabs;
    ASSERT_TRUE(collect_dabs(scene.hierarchy, DirectionField(scene.guides), options, dabs).ok());
    // One for a base vertex and two for a split.
    EXPECT_EQ(dabs.size(), scene.hierarchy.base_vertices() + 2 * scene.hierarchy.levels());
}

TEST(Dabs, AreThoseOfTheFirstLevels)
{
    const PaintedScene scene(test::scene(100, 70));
    const DirectionField field(scene.guides);
    DabOptions options;
    std::vector<Dab> all, first;
    ASSERT_TRUE(collect_dabs(scene.hierarchy, field, options, all).ok());
    options.last = scene.hierarchy.levels() / 8;
    ASSERT_TRUE(collect_dabs(scene.hierarchy, field, options, first).ok());
    ASSERT_LT(first.size(), all.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_LE(first[i].level, options.last);
        EXPECT_EQ(first[i].vertex, all[i].vertex);
    }
    EXPECT_GT(all[first.size()].level, options.last);
}

TEST(Dabs, DetailMapScalesTheRangeByPowersOfFour)
{
    DabOptions options;
    EXPECT_EQ(options.scale({ 0, 0 }, 5, 1), 1.0f);
    const float map[5] = { 0.0f, 0.25f, 0.5f, 1.0f, std::nanf("") };
    options.detail = map;
    EXPECT_EQ(options.scale({ 0, 0 }, 5, 1), 4.0f);
    EXPECT_EQ(options.scale({ 1, 0 }, 5, 1), 2.0f);
    EXPECT_EQ(options.scale({ 2, 0 }, 5, 1), 1.0f);
    EXPECT_EQ(options.scale({ 3, 0 }, 5, 1), 0.25f);
    EXPECT_EQ(options.scale({ 4, 0 }, 5, 1), 4.0f);
    EXPECT_EQ(options.scale({ -9, 7 }, 5, 1), 4.0f) << "the nearest pixel";
}

TEST(Dabs, RefuseADamagedHierarchy)
{
    PaintedScene scene(test::scene(50, 40));
    const DirectionField field(scene.guides);
    scene.hierarchy.splits[3].s = 1000000;
    std::vector<Dab> dabs;
    const Status status = collect_dabs(scene.hierarchy, field, {}, dabs);
    EXPECT_NE(status.error().find("split 3"), std::string::npos) << status.error();
}

}  // namespace
