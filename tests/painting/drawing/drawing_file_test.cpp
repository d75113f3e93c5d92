// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/drawing_file.h>

#include <gtest/gtest.h>

#include "painting/text.h"

using namespace pimg;
using namespace pimg::test;

namespace {

/// A line, a dot and a red line on 100 x 50 pixels.
Drawing three_lines()
{
    Drawing drawing;
    drawing.width = 100;
    drawing.height = 50;
    drawing.inks = { { 0.0f, 0.0f, 0.0f }, { 1.0f, 0.5f, -0.2f } };
    drawing.points = { { 9.5f, 9.5f, 2 }, { 19.5f, 9.5f, 2 }, { 49.5f, 24.5f, 4 },
                       { 0, 0, 1 },       { 1, 2.125f, 1 },   { 3, 4, 1 } };
    drawing.lines = { { 0, 2, 0 }, { 2, 1, 0 }, { 3, 3, 1 } };
    return drawing;
}

TEST(DrawingFile, IsInMillimetresInTheMiddleOfThePaper)
{
    Paper paper { 148.0, 210.0 };
    EXPECT_DOUBLE_EQ(millimetres_per_pixel(three_lines(), paper), 2.1);  // the paper is turned
    EXPECT_EQ(paper.width, 210.0);
    const std::string svg = drawing_to_svg(three_lines(), { 200.0, 120.0 });
    EXPECT_EQ(svg.substr(0, 4), "<svg");
    EXPECT_NE(svg.find("width=\"200mm\" height=\"120mm\" viewBox=\"0 0 200 120\""), std::string::npos) << svg;
    // Two millimetres to a pixel and ten above the picture: the upper side of the line, a half circle, the lower side.
    EXPECT_NE(svg.find("d=\"M20 28L40 28A2 2 0 0 1 40 32L20 32A2 2 0 0 1 20 28Z\""), std::string::npos) << svg;
    EXPECT_NE(svg.find("<circle cx=\"100\" cy=\"60\" r=\"4\"/>"), std::string::npos) << svg;
}

TEST(DrawingFile, HasALayerForEveryInkAndEveryLineOnce)
{
    for (const std::string& svg : { drawing_to_svg(three_lines(), {}), drawing_to_plot(three_lines(), {}, 1.0f) }) {
        EXPECT_EQ(count_of("<g ", svg), 2u);
        EXPECT_EQ(count_of("<path", svg) + count_of("<circle", svg), 3u);
        EXPECT_LT(svg.find("#ff8000"), svg.find("#000000"));
        EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
    }
    EXPECT_EQ(count_of("<rect", drawing_to_svg(three_lines(), {})), 1u);
    EXPECT_EQ(count_of("<rect", drawing_to_plot(three_lines(), {}, 1.0f)), 0u);
}

TEST(DrawingFile, PlotsMiddleLinesWithOnePen)
{
    const std::string svg = drawing_to_plot(three_lines(), { 200.0, 100.0 }, 1.5f);
    EXPECT_EQ(count_of("stroke-width=\"3\"", svg), 2u);
    EXPECT_NE(svg.find("d=\"M20 20L40 20\""), std::string::npos) << svg;
    EXPECT_NE(svg.find("d=\"M100 50h0\""), std::string::npos) << svg;
    EXPECT_NE(svg.find("d=\"M1 1L3 5.25 7 9\""), std::string::npos) << svg;
}

TEST(DrawingFile, JsonHasPointsWithTheirWidths)
{
    const std::string json = drawing_to_json(three_lines());
    EXPECT_NE(json.find("\"inks\": [[0, 0, 0], [255, 128, 0]]"), std::string::npos) << json;
    EXPECT_NE(json.find("{\"ink\": 1, \"points\": [[0, 0, 1], [1, 2.125, 1], [3, 4, 1]]}"), std::string::npos) << json;
    EXPECT_EQ(count_of("\"ink\"", json), 3u);
    EXPECT_EQ(count_of("\"points\"", drawing_to_json({})), 0u);
}

}  // namespace
