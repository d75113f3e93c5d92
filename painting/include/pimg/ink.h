// SPDX-License-Identifier: BSD-3-Clause
// Pen and ink: outlines along the features of a picture, and hatching or dots that are as dark as the picture.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/drawing.h>
#include <pimg/inks.h>
#include <pimg/strokes.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What tones are made of.
enum class InkStyle {
    hatch,    ///< calm, nearly parallel lines, and lines across them where it is dark
    contour,  ///< the same, but lines follow the forms, as in an engraving
    stipple   ///< dots
};

/// How a picture is drawn.
struct PenOptions {
    float width = 1.3f;      ///< width of the pen in pixels, above 0; lines are 0.5 to 1.8 times as wide
    float length = 1.0f;     ///< factor on the length of hatching lines, 0.1..10
    float density = 1.0f;    ///< factor on the darkness, 0..4; 0: outlines only
    float outline = 1.0f;    ///< factor on the width of outlines, 0..4; 0: none
    bool cross = true;       ///< draw lines in a second direction where those of one would be too dense
    std::uint32_t seed = 1;  ///< another seed gives other random variations
    ParallelFor parallel;    ///< the result does not depend on it
    InkStyle style = InkStyle::hatch;
    float spacing = 2.0f;  ///< least distance of hatching lines from middle to middle, in pens, 1..20
    float detail = 0.5f;   ///< 0..1: with more, weaker and shorter edges get outlines
    float light = 0.0f;    ///< 0..1: 0: tones of the picture; 1: its lightest places are white, and half of it is light
};

using PenSettings [[deprecated("renamed: PenOptions")]] = PenOptions;

/// What is drawn. All channels are width x height, row-major, with finite samples.
struct InkPicture {
    int width = 0, height = 0;         ///< in pixels
    const float* lightness = nullptr;  ///< L*, 0..100; values outside count as the nearer end
    ChannelsView features;             ///< up to three channels in 8-bit steps, whose features are drawn
    ChannelsView base;                 ///< deprecated: not used
    std::vector<Ink> inks { Ink { { 0.0f, 0.0f, 0.0f }, 0.0f } };  ///< the first is black, for outlines and shadows
    const std::uint8_t* ink = nullptr;  ///< of each pixel: the ink of its light tones; null: the first everywhere
};

/// Draws a picture.
///
/// *Outlines* follow edges and thin lines: those that survive strong smoothing, and those on borders of segments that
/// survive many merges. Their width follows the contrast, and their ends taper. *Hatching* lines are streamlines of a
/// direction field of the large forms, at even distances that follow the tone (Jobard and Lefer 1997); they end at edges. Their width is then adjusted until the drawing, seen from afar, has
/// the picture's L*, from that of the paper down to the darkest that lines `spacing` apart can give. *Dots* are the
/// centres of a weighted Voronoi diagram of the tone (Secord 2002).
///
/// Everything is planned on a grid of fixed size in pens. So pictures of the same subject in two sizes give nearly the
/// same drawing for the same `width` in proportion to the picture.
PIMG_EXPORT void draw_ink(const InkPicture& picture, const PenOptions& options, Drawing& drawing);

/// The drawing that draw_ink() makes of `darkness` alone, from 0 (paper) to 1 (black), as strokes that are as wide as the
/// pen. `hierarchy` is not used, and of `field` only the size. Does not fail.
[[deprecated("use draw_ink()")]] Status plan_ink(const Hierarchy& hierarchy, const float* darkness,
                                                 const DirectionField& field, const PenOptions& options,
                                                 Strokes& lines);

}  // namespace PIMG_ABI
}  // namespace pimg
