// SPDX-License-Identifier: BSD-3-Clause
// Pen and ink: lines along the edges, as close together as the picture is dark.
#pragma once

#include <cstdint>

#include <pimg/strokes.h>

namespace pimg {

struct PenSettings {
    float width = 1.3f;    ///< of the pen in pixels, 0.5..16
    float length = 1.0f;   ///< factor on the lines' length, 0.1..10
    float density = 1.0f;  ///< factor on the darkness, 0..4
    float outline = 1.0f;  ///< darkness added along edges, 0..4
    bool cross = true;     ///< a second direction where one would have to be too dense
    std::uint32_t seed = 1;
    ParallelFor parallel;
};

/// Plans the lines. `darkness` holds one value per pixel, row-major, from 0 (paper) to 1 (black); values outside count
/// as the nearer end of the range. The lines start at the dual pieces, coarse to fine; each keeps the distance to the others that its width
/// over the darkness asks for, and ends where the darkness changes.
Status plan_ink(const Hierarchy& hierarchy, const float* darkness, const DirectionField& field,
                const PenSettings& options, Strokes& lines);

}  // namespace pimg
