// SPDX-License-Identifier: BSD-3-Clause
// Paints strokes that were planned before (strokes.h) on a canvas, with a brush (brush.h).
#pragma once

#include <vector>

#include <pimg/brush.h>
#include <pimg/strokes.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What is painted on: channels of floats, width x height, row-major. They may hold any values, and nothing is clipped.
struct Canvas {
    int width = 0, height = 0;
    std::vector<float*> channels;
    float* relief = nullptr;  ///< receives the thickness of the paint in pixels, one float per pixel; null: not wanted
    /// Alpha of what is on the canvas, if its colours are multiplied by alpha. It is painted on like a channel, but
    /// without grain and random changes. Null: all is opaque.
    float* alpha = nullptr;
};

/// How strokes are painted.
struct StrokePaintOptions {
    float opacity = 1.0f;  ///< opacity of every stroke, 0..1
    union {
        float jitter_colour = 0.0f;  ///< 0..1: largest random change of a stroke's brightness, as a share of it
        [[deprecated("renamed: jitter_colour")]] float jitter_color;
    };
    /// Edges that stop the paint: up to three channels of the canvas's size, in units of one step of an 8-bit picture.
    /// A stroke covers a pixel only as far as the pixel is on the stroke's side of an edge. So it ends where the
    /// picture's edge does, with the same anti-aliasing. Null: edges do not stop paint.
    const ChannelsView* edges = nullptr;
    /// Fills holes: along edges that stop the paint, a few pixels may get none, and these show this picture, which has
    /// the size and the channels of the canvas, and then its alpha, if that has one. Gaps between the hairs of a brush
    /// stay. Null: holes stay, too.
    const ChannelsView* ground = nullptr;
    float crossing = 14.0f;  ///< smallest difference in `edges` that is an edge
    /// The sample of white if samples are encoded as for a display. Random changes are then as large in dark colours as
    /// in a middle grey, up to three times their share. 0: they are shares of the brightness everywhere.
    float white = 0.0f;
    ParallelFor parallel;  ///< the result does not depend on it
};

using PaintSettings [[deprecated("renamed: StrokePaintOptions")]] = StrokePaintOptions;

/// Paints the strokes in their order. colours[c][i] is the value of stroke i in channel c of the canvas; the entry
/// after the channels is its alpha, if the canvas has one.
PIMG_EXPORT void paint_strokes(const Strokes& strokes, const std::vector<std::vector<float>>& colours,
                               const Brush& brush, const StrokePaintOptions& options, Canvas& canvas);

/// Lights the relief of the paint from the upper left. Every channel is multiplied by a number between about
/// 1 - strength / 2 and 1 + strength / 2, for a strength of 0..1. Where paint is equally thick, nothing changes. `white` is
/// as in StrokePaintOptions: if it is known, relief is up to 1.7 times as strong in the dark.
PIMG_EXPORT void light_relief(Canvas& canvas, float strength, const ParallelFor& parallel = {}, float white = 0.0f);

}  // namespace PIMG_ABI
}  // namespace pimg
