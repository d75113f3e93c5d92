// SPDX-License-Identifier: BSD-3-Clause
#include "sketch.h"

#include <cmath>

#include "painting/scene.h"

using namespace pimg;
using test::view_of;

namespace {

constexpr float kBare = 64.0f;

TEST(ShadePicture, KeepsAConstantPictureAndTheMean)
{
    const test::Picture flat = test::make("flat", 20, 15, [](int, int) { return 77; });
    const ShadePicture shades(view_of(flat), {});
    for (int y = 0; y < 15; ++y)
        for (int x = 0; x < 20; ++x)
            EXPECT_EQ(shades.pixel(x, y)[0], 77.0f);
    EXPECT_EQ(shades.between({ 3.7f, 200.0f })[0], 77.0f);
    EXPECT_EQ(shades.contrast(10, 7), 0.0f);
    const test::Picture dot = test::make("dot", 21, 21, [](int x, int y) { return x == 10 && y == 10 ? 256 : 0; });
    const ShadePicture spread(view_of(dot), test::backwards);
    double sum = 0.0;
    for (int y = 0; y < 21; ++y)
        for (int x = 0; x < 21; ++x)
            sum += double(spread.pixel(x, y)[0]);
    EXPECT_EQ(sum, 256.0);
}

class SketchOfAStep : public testing::Test {
protected:
    static int step(int x, int) { return x < 30 ? 40 : 200; }

    const test::Picture m_picture = test::make("step", 60, 40, step);
    const ShadePicture m_shades { view_of(m_picture), {} };
    Sketch m_sketch { m_shades, 2 };
    const Vec2 m_line[2] = { { 10, 8 }, { 10, 30 } };  ///< on the dark side
};

TEST_F(SketchOfAStep, GainIsWhatAStrokeImproves)
{
    const Shade dark { 40, 0, 0 }, bright { 200, 0, 0 };
    EXPECT_NEAR(m_sketch.gain(m_line, 2, 8.0f, dark, kBare), kBare, 1e-3f) << "on the bare canvas, exactly right";
    EXPECT_NEAR(m_sketch.gain(m_line, 2, 8.0f, bright, kBare), kBare - 160.0f, 1e-3f);
    m_sketch.put(m_line, 2, 8.0f, bright, 1.0f);
    EXPECT_NEAR(m_sketch.gain(m_line, 2, 8.0f, bright, kBare), 0.0f, 1e-3f) << "the same again";
    EXPECT_NEAR(m_sketch.gain(m_line, 2, 8.0f, dark, kBare), 160.0f, 1e-3f);
    m_sketch.put(m_line, 2, 8.0f, dark, 1.0f);
    EXPECT_NEAR(m_sketch.gain(m_line, 2, 8.0f, bright, kBare), -160.0f, 1e-3f) << "harm";
}

TEST_F(SketchOfAStep, ThinPaintImprovesByItsShare)
{
    const Shade dark { 40, 0, 0 }, bright { 200, 0, 0 };
    m_sketch.put(m_line, 2, 8.0f, bright, 0.1f);
    EXPECT_NEAR(m_sketch.gain(m_line, 2, 8.0f, dark, kBare), 160.0f, 1e-3f) << "bare canvas is covered by it";
    m_sketch.put(m_line, 2, 8.0f, dark, 0.25f);
    EXPECT_NEAR(m_sketch.gain(m_line, 2, 8.0f, dark, kBare), 120.0f, 1e-3f);
}

TEST(ShadePyramid, HasCoarserPicturesForWiderStrokes)
{
    const test::Picture step = test::make("step", 96, 64, [](int x, int) { return x < 48 ? 40 : 200; });
    const ShadePyramid pyramid(view_of(step), test::backwards);
    EXPECT_EQ(&pyramid.for_width(3.0f), &pyramid.finest());
    int shrunk = 1;
    for (const float width : { 3.0f, 16.0f, 32.0f, 64.0f, 1e6f }) {
        const ShadePicture& picture = pyramid.for_width(width);
        EXPECT_GE(picture.shrunk(), shrunk);
        shrunk = picture.shrunk();
        // Places mean the same in all of them.
        if (width <= 64.0f) {
            EXPECT_NEAR(picture.between({ 12, 30 })[0], 40.0f, 1.0f) << width;
            EXPECT_NEAR(picture.between({ 47.5f, 30 })[0], 120.0f, 1.0f) << width;
            EXPECT_NEAR(picture.at({ 84, 30 })[0], 200.0f, 1.0f) << width;
        }
    }
    EXPECT_EQ(pyramid.for_width(64.0f).shrunk(), 8);
}

TEST_F(SketchOfAStep, PaintBelowStaysBelow)
{
    const Shade dark { 40, 0, 0 }, bright { 200, 0, 0 };
    m_sketch.put(m_line, 2, 8.0f, bright, 1.0f);
    m_sketch.put_below(m_line, 2, 8.0f, dark);
    EXPECT_NEAR(m_sketch.gain(m_line, 2, 8.0f, dark, kBare), 160.0f, 1e-3f) << "bright is still on top";
}

TEST_F(SketchOfAStep, BareCellsAreThoseNotPainted)
{
    const std::size_t cells = m_sketch.bare_cells().size();
    EXPECT_EQ(cells, 30u * 20u);
    EXPECT_FALSE(m_sketch.is_covered({ 10, 20 }));
    m_sketch.put(m_line, 2, 8.0f, { 40, 0, 0 }, 1.0f);
    EXPECT_TRUE(m_sketch.is_covered({ 10, 20 }));
    EXPECT_FALSE(m_sketch.is_covered({ 40, 20 }));
    const std::vector<Vec2> bare = m_sketch.bare_cells();
    EXPECT_LT(bare.size(), cells);
    for (const Vec2 place : bare)
        EXPECT_FALSE(m_sketch.is_covered(place));
    const Vec2 across[2] = { { -50, 20 }, { 150, 20 } };
    m_sketch.put_below(across, 2, 200.0f, { 40, 0, 0 });
    EXPECT_TRUE(m_sketch.bare_cells().empty());
}

}  // namespace
