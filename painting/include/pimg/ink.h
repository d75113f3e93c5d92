// SPDX-License-Identifier: BSD-3-Clause
// Pen and ink: lines along the edges of a picture, the closer together the darker it is.
#pragma once

#include <cstdint>

#include <pimg/strokes.h>

namespace pimg {

/// How the lines are drawn.
struct PenOptions {
    float width = 1.3f;      ///< width of the pen in pixels, 0.5..16
    float length = 1.0f;     ///< factor on the lines' length, 0.1..10
    float density = 1.0f;    ///< factor on the darkness, 0..4
    float outline = 1.0f;    ///< darkness added along edges, 0..4
    bool cross = true;       ///< draw lines in a second direction where those of one would be too dense
    std::uint32_t seed = 1;  ///< another seed gives other random variations
    ParallelFor parallel;    ///< the result does not depend on it
};

using PenSettings [[deprecated("renamed: PenOptions")]] = PenOptions;

/// Plans the lines. `darkness` holds one value per pixel, row-major, from 0 (paper) to 1 (black); values outside count as
/// the nearer end of this range. `field` is the direction field of the picture and also says its size. Lines start at the
/// dual pieces of the hierarchy, from coarse to fine. A line keeps a distance from the others that is its width divided by
/// the darkness, and it ends where the darkness changes. Fails only on a damaged hierarchy.
Status plan_ink(const Hierarchy& hierarchy, const float* darkness, const DirectionField& field,
                const PenOptions& options, Strokes& lines);

}  // namespace pimg
