// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/ink.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "painting/scene.h"

using namespace pimg;
using test::PaintedScene;

namespace {

class Ink : public testing::Test {
protected:
    Strokes lines(const PaintedScene& scene, const std::vector<float>& darkness, const PenOptions& pen = {}) const
    {
        Strokes planned;
        const DirectionField field(scene.guides, pen.parallel);
        EXPECT_TRUE(plan_ink(scene.hierarchy, darkness.data(), field, pen, planned).ok());
        return planned;
    }

    static std::vector<float> darkness_of(const PaintedScene& scene)
    {
        std::vector<float> darkness;
        for (float v : scene.samples)
            darkness.push_back(1.0f - v / 255.0f);
        return darkness;
    }
};

TEST_F(Ink, IsDenserWhereItIsDarker)
{
    const PaintedScene scene(test::make("ramp", 256, 64, [](int x, int) { return 255 - x; }));
    const Strokes planned = lines(scene, darkness_of(scene));
    double length[4] = {};
    for (const Stroke& s : planned.strokes)
        for (Index k = 0; k < s.count; ++k)
            length[std::clamp(int(planned.begin(s)[k].x / 64), 0, 3)] += 1;
    EXPECT_LT(length[0], length[1]);
    EXPECT_LT(length[1], length[2]);
    EXPECT_LT(length[2], length[3]);
}

TEST_F(Ink, LinesHaveThePensWidthAndStayInThePicture)
{
    const PaintedScene scene(test::scene(120, 90));
    PenOptions pen;
    pen.width = 2.25f;
    const Strokes planned = lines(scene, darkness_of(scene), pen);
    EXPECT_GT(planned.strokes.size(), 20u);
    for (const Stroke& s : planned.strokes) {
        EXPECT_EQ(s.width, 2.25f);
        EXPECT_GE(s.count, 3u);
        for (Index k = 0; k < s.count; ++k) {
            const Vec2 p = planned.begin(s)[k];
            EXPECT_TRUE(p.x >= 0.0f && p.x <= 119.0f && p.y >= 0.0f && p.y <= 89.0f) << p.x << ", " << p.y;
        }
    }
}

TEST_F(Ink, WhitePaperAndNumbersThatAreNoneGetNoLines)
{
    const PaintedScene scene(test::scene(60, 40));
    for (const float v : { 0.0f, -3.0f, std::numeric_limits<float>::quiet_NaN() })
        EXPECT_TRUE(lines(scene, std::vector<float>(scene.samples.size(), v)).strokes.empty()) << v;
    PenOptions pen;
    pen.density = 0.0f;
    pen.outline = 0.0f;
    EXPECT_TRUE(lines(scene, darkness_of(scene), pen).strokes.empty());
    // More than black is black.
    EXPECT_EQ(lines(scene, std::vector<float>(scene.samples.size(), 1.0f)).points.size(),
              lines(scene, std::vector<float>(scene.samples.size(), 7.0f)).points.size());
}

TEST_F(Ink, CrossesWhereOneDirectionIsNotEnough)
{
    const PaintedScene scene(test::make("dark", 96, 96, [](int x, int) { return x < 48 ? 230 : 10; }));
    PenOptions one, two;
    one.cross = false;
    const std::vector<float> darkness = darkness_of(scene);
    EXPECT_GT(lines(scene, darkness, two).points.size(), lines(scene, darkness, one).points.size());
}

TEST_F(Ink, SeedChangesOnlyTheVariation)
{
    const PaintedScene scene(test::scene(90, 60));
    PenOptions pen;
    const Strokes a = lines(scene, darkness_of(scene), pen);
    pen.seed = 2;
    pen.parallel = test::backwards;
    const Strokes b = lines(scene, darkness_of(scene), pen);
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i)
        ASSERT_TRUE(a.points[i].x == b.points[i].x && a.points[i].y == b.points[i].y);
    EXPECT_NE(a.strokes[0].variation, b.strokes[0].variation);
}

}  // namespace
