// SPDX-License-Identifier: BSD-3-Clause
// What a draughtsman sees before drawing: the picture without texture, its large forms, and where its segments meet.
#pragma once

#include <vector>

#include <pimg/direction.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// A picture on the drawing's grid. Channels are in units of one step of an 8-bit picture.
struct Study {
    Raster mean;                   ///< of the channels as they are
    std::vector<Raster> features;  ///< without texture and noise
    std::vector<Raster> base;      ///< with the important features only
    /// How long the border of segments nearest to a cell survives when segments are merged, the cheapest first: the
    /// square root of the cost of the merge that removes it, which is about contrast times size in cells. 0 away from
    /// borders.
    Raster borders;
};

/// Studies up to three channels of one size, 2 x 2 or more. A hierarchy is built on the drawing's grid, not on the
/// picture's own pixels. So the same subject in two resolutions gives the same study, but for what the smaller one has
/// lost.
Study make_study(std::vector<Raster> channels, const ParallelFor& parallel);

}  // namespace PIMG_ABI
}  // namespace pimg
