// SPDX-License-Identifier: BSD-3-Clause
// A drawing in ink: lines whose width varies along them, and dots, in a few inks.
#pragma once

#include <array>
#include <vector>

#include <pimg/paint.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// A place on the middle of a line, and how wide the line is there, in pixels. The centre of pixel (x, y) is at (x, y).
struct InkPoint {
    float x, y, width;
};

/// A line through `count` points of Drawing::points, the first of which has the number `first`. Its ends are round. A line
/// of one point is a dot.
struct InkLine {
    Index first, count;
    Index ink;  ///< of Drawing::inks
};

/// Lines in the order in which they are drawn.
struct Drawing {
    int width = 0, height = 0;               ///< size of the picture in pixels
    std::vector<std::array<float, 3>> inks;  ///< red, green and blue, encoded in sRGB, 0..1; the first draws outlines
    std::vector<InkLine> lines;
    std::vector<InkPoint> points;  ///< those of all lines

    const InkPoint* begin(const InkLine& line) const { return points.data() + line.first; }
    InkPoint* begin(const InkLine& line) { return points.data() + line.first; }
};

/// The same drawing on a picture of another size, 1 x 1 pixels or more.
PIMG_EXPORT Drawing resized(const Drawing& drawing, int width, int height);

/// Leaves out points where a line is straight and evenly wide to within `tolerance` pixels, 0 or more.
PIMG_EXPORT void simplify_lines(Drawing& drawing, float tolerance);

/// Orders the lines so that a pen travels little between them: ink by ink, and from each line to the nearest end of
/// those left. Lines may be turned round.
PIMG_EXPORT void sort_lines(Drawing& drawing);

/// How far the pen travels off the paper, in pixels: from the end of each line to the beginning of the next.
PIMG_EXPORT double pen_travel(const Drawing& drawing);

/// Draws the lines on a canvas of the drawing's size, in their order. values[c][i] is the value of ink i in channel c. A
/// line covers a pixel as far as it covers the pixel's area. The result does not depend on `parallel`.
PIMG_EXPORT void render_drawing(const Drawing& drawing, const std::vector<std::vector<float>>& values, Canvas& canvas,
                                const ParallelFor& parallel = {});

}  // namespace PIMG_ABI
}  // namespace pimg
