// SPDX-License-Identifier: BSD-3-Clause
// The outlines of a drawing: lines along the edges that survive in the smoothed picture.
#pragma once

#include <vector>

#include <pimg/drawing.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Which edges get a line, and how wide it is. Lengths are in pixels of the pictures.
struct OutlineOptions {
    float pen = 2.0f;     ///< width of the pen
    float weight = 1.0f;  ///< factor on the lines' width, above 0
    float detail = 0.5f;  ///< 0..1: with more, weaker and shorter edges get a line
    ParallelFor parallel;
};

/// Adds outlines to a drawing of the pictures' size. `features` are up to three channels in units of one step of an 8-bit
/// picture, with texture and noise removed, and say where the edges are. `base` are the same channels with all but the
/// important features removed. An edge is as important as the geometric mean of its slopes in both, times its length:
/// so an edge that `base` has lost needs far more contrast. A line is as wide as its edge is steep, and its ends taper.
void add_outlines(const std::vector<Raster>& features, const std::vector<Raster>& base, const OutlineOptions& options,
                  Drawing& drawing);

}  // namespace PIMG_ABI
}  // namespace pimg
