// SPDX-License-Identifier: BSD-3-Clause
// The outlines of a drawing: lines along the edges of a picture, and what is left white.
#pragma once

#include <pimg/drawing.h>

#include "drawing/study.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Which edges get a line, and how wide it is. Lengths are in pixels of the pictures.
struct OutlineOptions {
    float pen = 2.0f;     ///< width of the pen
    float weight = 1.0f;  ///< factor on the lines' width, above 0
    float detail = 0.5f;  ///< 0..1: with more, weaker and shorter edges get a line
    ParallelFor parallel;
};

/// Adds outlines to a drawing of the study's size: along what is dark and thinner than a pen, and along edges. An edge is
/// as important as the geometric mean of its slopes in features and base, times its length; one on a border of segments
/// that survive many merges counts as if the base had it, and goes on where it has little contrast. A line is as wide as
/// its edge is steep, and its ends taper.
void add_outlines(const Study& study, const OutlineOptions& options, Drawing& drawing);

/// Adds lines along what is light and thinner than a pen, which are to be left white.
void add_highlights(const Study& study, const OutlineOptions& options, Drawing& drawing);

}  // namespace PIMG_ABI
}  // namespace pimg
