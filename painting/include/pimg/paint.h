// SPDX-License-Identifier: BSD-3-Clause
// Paints planned strokes (strokes.h) on a canvas with a brush (brush.h).
#pragma once

#include <vector>

#include <pimg/brush.h>
#include <pimg/strokes.h>

namespace pimg {

/// What is painted on: channels of float, row-major, any values; nothing is clipped.
struct Canvas {
    int width = 0, height = 0;
    std::vector<float*> channels;
    float* relief = nullptr;  ///< thickness of the paint in pixels, or null when not wanted
};

struct PaintSettings {
    float opacity = 1.0f;       ///< of every stroke, 0..1
    float jitter_color = 0.0f;  ///< 0..1: largest random change of a stroke's brightness, as a share of it
    /// Edges that stop the paint, up to three channels in steps of an 8-bit picture, or null: a stroke covers a pixel
    /// as far as the pixel is on the stroke's side of the edge, and so ends exactly where the picture's edge does,
    /// anti-aliased as it is there.
    const ChannelsView* edges = nullptr;
    /// What to show of the canvas's size and channels where strokes leave holes, or null to leave them: along edges
    /// that stop the paint a few pixels may get none. Gaps between the hairs of a brush stay.
    const ChannelsView* ground = nullptr;
    float crossing = 14.0f;  ///< differences below this are no edge
    ParallelFor parallel;
};

/// Paints the strokes in order; colors[c][i] is of channel c and stroke i. Each pixel is a function of the strokes
/// alone, so the canvas comes out the same for any number of threads.
void paint_strokes(const Strokes& strokes, const std::vector<std::vector<float>>& colors, const Brush& brush,
                   const PaintSettings& settings, Canvas& canvas);

/// Lights the relief of the paint from the upper left: multiplies every channel by up to about 1 +- strength/2.
/// Even paint stays as it is.
void light_relief(Canvas& canvas, float strength, const ParallelFor& parallel = {});

}  // namespace pimg
