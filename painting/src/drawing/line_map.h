// SPDX-License-Identifier: BSD-3-Clause
// Where the lines of a drawing may run: along the edges of a picture, and along what is thinner than a pen.
#pragma once

#include <pimg/direction.h>
#include <pimg/types.h>

#include "drawing/raster_ops.h"
#include "drawing/study.h"

namespace pimg {
inline namespace PIMG_ABI {

/// A direction, and how much there is to draw, at every cell. Lines run along the ridges of `strength`.
struct LineMap {
    Raster along_x, along_y;  ///< unit vector along the line, without a sign
    Raster strength;          ///< slope across an edge in steps per cell, or depth of a thin line in steps
    Raster importance;        ///< of a line here: its strength, as far as it deserves to be drawn

    Vec2 along(Vec2 p) const
    {
        const std::size_t at = pixel_at(strength, p);
        return { along_x.samples[at], along_y.samples[at] };
    }
};

/// The edges of a study. Important are those that the base shows, too, or on the border of segments that survive many
/// merges. Edges with others around them are less so: the edges of leaves and gravel suppress each other.
LineMap edges_of(const Study& study, const ParallelFor& parallel);

/// What is thinner than about two cells and darker than its surroundings on both sides, such as the cables of a bridge;
/// with `light`, what is lighter.
LineMap thin_lines_of(const Study& study, bool light, const ParallelFor& parallel);

}  // namespace PIMG_ABI
}  // namespace pimg
