// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/drawing.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "painting/scene.h"

using namespace pimg;

namespace {

Drawing sheet(int width, int height)
{
    Drawing drawing;
    drawing.width = width;
    drawing.height = height;
    drawing.inks = { { 0.0f, 0.0f, 0.0f }, { 1.0f, 0.0f, 0.0f } };
    return drawing;
}

void add(Drawing& drawing, const std::vector<InkPoint>& points, Index ink = 0)
{
    drawing.lines.push_back({ Index(drawing.points.size()), Index(points.size()), ink });
    drawing.points.insert(drawing.points.end(), points.begin(), points.end());
}

/// Short lines here and there, in two inks.
Drawing scattered(int count)
{
    Drawing drawing = sheet(300, 200);
    for (int i = 0; i < count; ++i) {
        const std::uint32_t a = scramble(std::uint32_t(i)), b = scramble(a), c = scramble(b);
        const float x = 150.0f + 140.0f * signed_unit(a), y = 100.0f + 90.0f * signed_unit(b);
        add(drawing, { { x, y, 1.0f }, { x + 6.0f * signed_unit(c), y + 5.0f, 2.0f } }, Index(i % 2));
    }
    return drawing;
}

std::vector<float> rendered(const Drawing& drawing, const ParallelFor& parallel = {})
{
    std::vector<float> paper(std::size_t(drawing.width * drawing.height), 1.0f);
    Canvas canvas { drawing.width, drawing.height, { paper.data() }, nullptr };
    render_drawing(drawing, { { 0.0f, 0.5f } }, canvas, parallel);
    return paper;
}

float ink_on(const std::vector<float>& paper)
{
    float ink = 0.0f;
    for (const float v : paper)
        ink += 1.0f - v;
    return ink;
}

TEST(Drawing, LinesAndDotsCoverTheirArea)
{
    for (const float width : { 0.2f, 0.7f, 1.0f, 2.5f, 6.0f }) {
        Drawing line = sheet(120, 60);
        add(line, { { 10.3f, 20.6f, width }, { 108.0f, 41.0f, width } });
        const float length = std::hypot(97.7f, 20.4f), ends = 3.14159f / 4.0f * width * width;
        EXPECT_NEAR(ink_on(rendered(line)), length * width + ends, 0.02f * length * width + 0.4f) << width;
    }
    for (const float width : { 2.0f, 5.5f, 20.0f }) {
        Drawing dot = sheet(60, 60);
        add(dot, { { 29.7f, 30.2f, width } });
        const float area = 3.14159f / 4.0f * width * width;
        EXPECT_NEAR(ink_on(rendered(dot)), area, 0.04f * area + 0.3f) << width;
    }
}

TEST(Drawing, ALineThatCrossesItselfIsNotDarkerThere)
{
    Drawing drawing = sheet(40, 40);
    add(drawing, { { 5, 5, 2 }, { 35, 35, 2 }, { 35, 5, 2 }, { 5, 35, 2 } }, 1);
    for (const float v : rendered(drawing))
        EXPECT_GE(v, 0.5f);
}

TEST(Drawing, IsTheSameForAllLoopsAndOrdersOfTiles)
{
    const Drawing drawing = scattered(400);
    EXPECT_EQ(rendered(drawing), rendered(drawing, test::backwards));
}

TEST(Drawing, MayReachBeyondThePaper)
{
    Drawing drawing = sheet(30, 20);
    add(drawing, { { -50, 10, 3 }, { 80, 10, 3 } });
    add(drawing, { { 500, 500, 9 } });
    add(drawing, { { -5, -5, 9 } });
    EXPECT_NEAR(ink_on(rendered(drawing)), 90.0f, 1.0f);
}

TEST(Drawing, KeepsItsShapeInAnotherSize)
{
    const Drawing small = scattered(30), large = resized(small, 900, 600), back = resized(large, 300, 200);
    ASSERT_EQ(back.points.size(), small.points.size());
    for (std::size_t i = 0; i < back.points.size(); ++i) {
        EXPECT_NEAR(back.points[i].x, small.points[i].x, 1e-3f);
        EXPECT_NEAR(back.points[i].y, small.points[i].y, 1e-3f);
        EXPECT_NEAR(back.points[i].width, small.points[i].width, 1e-4f);
    }
    EXPECT_NEAR(ink_on(rendered(large)) / 9.0f, ink_on(rendered(small)), 0.04f * ink_on(rendered(small)));
}

TEST(Drawing, SimplerLinesLookTheSame)
{
    Drawing drawing = sheet(200, 100);
    std::vector<InkPoint> arc;
    for (int k = 0; k <= 180; ++k) {
        const float a = float(k) * 3.14159f / 180.0f;
        arc.push_back({ 100.0f + 80.0f * std::cos(a), 10.0f + 80.0f * std::sin(a), 1.0f + 0.01f * float(k) });
    }
    add(drawing, arc);
    add(drawing, { { 3, 3, 2 } });
    Drawing simpler = drawing;
    simplify_lines(simpler, 0.1f);
    EXPECT_LT(simpler.points.size(), drawing.points.size() / 3);
    EXPECT_EQ(simpler.lines.size(), 2u);
    EXPECT_EQ(simpler.points.front().x, arc.front().x);
    EXPECT_EQ(simpler.begin(simpler.lines[0])[simpler.lines[0].count - 1].x, arc.back().x);
    const std::vector<float> a = rendered(drawing), b = rendered(simpler);
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(a[i], b[i], 0.2f);
}

TEST(Drawing, SortingShortensTheWayAndLosesNothing)
{
    const Drawing drawing = scattered(600);
    Drawing sorted = drawing;
    sort_lines(sorted);
    ASSERT_EQ(sorted.lines.size(), drawing.lines.size());
    EXPECT_LT(pen_travel(sorted), 0.15 * pen_travel(drawing));
    std::vector<Index> first(sorted.lines.size());
    std::transform(sorted.lines.begin(), sorted.lines.end(), first.begin(),
                   [](const InkLine& line) { return line.first; });
    std::sort(first.begin(), first.end());
    EXPECT_EQ(std::adjacent_find(first.begin(), first.end()), first.end());
    EXPECT_TRUE(std::is_sorted(sorted.lines.begin(), sorted.lines.end(),
                               [](const InkLine& a, const InkLine& b) { return a.ink < b.ink; }));
    Drawing nothing = sheet(10, 10);
    sort_lines(nothing);
    EXPECT_EQ(pen_travel(nothing), 0.0);
}

}  // namespace
