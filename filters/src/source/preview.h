// SPDX-License-Identifier: BSD-3-Clause
// A quick look at hdr_compress: the hierarchy is that of a reduced picture, and what it gives is enlarged with the full
// picture as guide.
#pragma once

#include <vector>

#include <pimg/channels.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// How many pixels of a picture, across and down, become one of its preview: a power of two, so that the preview has at
/// most half a million; 1 for a picture too small to be reduced.
int preview_step(int width, int height);

/// The means of blocks of step x step pixels; blocks that the picture's right and lower sides cut have fewer.
Raster reduced(const Raster& picture, int step, const ParallelFor& parallel);

/// What a filter that made `small_result` of `small_guide` would make of `guide`, of which that is the reduced raster. The result
/// is taken to follow the guide along a line in every small neighbourhood (He, Sun and Tang, "Guided image filtering", 2013;
/// for enlarging, He and Sun, "Fast guided filter", 2015), so that edges are as sharp as those of the guide. Where the
/// guide is flat and tells no slope, it is `usual`.
void enlarge(const Raster& small_guide, const std::vector<float>& small_result, int step, const Raster& guide,
             float usual, const ParallelFor& parallel, std::vector<float>& result);

}  // namespace PIMG_ABI
}  // namespace pimg
