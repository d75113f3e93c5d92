// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/stroke_file.h>

#include <gtest/gtest.h>

#include "painting/text.h"

using namespace pimg;
using namespace pimg::test;

namespace {

Strokes two_strokes()
{
    Strokes strokes;
    strokes.width = 10;
    strokes.height = 5;
    strokes.points = { { -0.5f, 1.25f }, { 3.0f, 2.0f }, { 4.0f, 4.0f } };
    strokes.strokes = { { 0, 2, 1.5f, kGhost, 7, 0 }, { 0, 3, 2.0f, 12, 3, 0 } };
    return strokes;
}

TEST(StrokeFile, NumbersHavePointsAndColoursAreClipped)
{
    const Strokes strokes = two_strokes();
    const std::string svg =
        strokes_to_svg(strokes, { { 2.0f, 0.0f }, { 0.5f, 0.0f }, { -1.0f, 0.0f } }, 1.0f, "#ffffff");
    EXPECT_NE(svg.find("<path stroke=\"#ff8000\" stroke-width=\"1.5\" d=\"M0 1.75L3.5 2.5\"/>"), std::string::npos)
        << svg;
    const std::string json = strokes_to_json(strokes, { { 0.0f, 1.0f } }, 0.25f);
    EXPECT_NE(json.find("[[-0.5, 1.25], [3, 2]], \"width\": 1.5, \"color\": [0, 0, 0], \"level\": 7, \"vertex\": -1"),
              std::string::npos)
        << json;
    EXPECT_NE(json.find("\"level\": 3, \"vertex\": 12"), std::string::npos) << json;
}

TEST(StrokeFile, HasEveryStrokeOnce)
{
    const Strokes strokes = two_strokes();
    EXPECT_EQ(count_of("<path", strokes_to_svg(strokes, {}, 1.0f, "")), 2u);
    EXPECT_EQ(count_of("<rect", strokes_to_svg(strokes, {}, 1.0f, "")), 0u);
    EXPECT_EQ(count_of("<rect", strokes_to_svg(strokes, {}, 1.0f, "#123456")), 1u);
    EXPECT_EQ(count_of("\"points\"", strokes_to_json(strokes, {}, 1.0f)), 2u);
    EXPECT_EQ(count_of("<path", strokes_to_svg({}, {}, 1.0f, "")), 0u);
    EXPECT_EQ(count_of("\"points\"", strokes_to_json({}, {}, 1.0f)), 0u);
}

}  // namespace
