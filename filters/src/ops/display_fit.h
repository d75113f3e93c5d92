// SPDX-License-Identifier: BSD-3-Clause
// Compression and exposure: from log luminance of any range to display luminance, middle grey and white placed.
#pragma once

#include <vector>

#include <pimg/options.h>

#include "ops/display_curve.h"
#include "source/overview.h"

namespace pimg {
inline namespace PIMG_ABI {

/// What s0, dmax and detail are where they are 0: dmax a share of the picture's dynamic range, `range` stops, and the
/// others all from dmax, so that pictures compressed with one dmax are treated alike.
void find_compression(float range, HdrCompressOptions& options);

/// The dynamic range, in stops, for which find_compression() would find this dmax.
float range_of(const HdrCompressOptions& options);

/// A cell of the overview: log2 of its compressed luminance, and how much it counts.
using CompressedCells = std::vector<Weighted>;

/// Fills in key and white of otherwise resolved options where they are 0. `scene_key` tells how light the scene is as a
/// whole, see find_scene_key(). If there are no cells, everything is as dark as `dark`.
void find_exposure(CompressedCells cells, float scene_key, float dark, HdrCompressOptions& options);

/// Where the mean of the scene's log luminances lies between its darkest and its lightest parts, 0..1: little at night,
/// much in snow. 0.5 if there is nothing to see.
float find_scene_key(const Overview& overview);

/// The tone curve of resolved options. Its toe brings the darkest part of the base, which the compressed range tells,
/// down to black, as far as that leaves the contrast of the others natural; its shoulder brings `white` to the brightest
/// that the display shows.
ToneCurve tone_curve(const HdrCompressOptions& options);

}  // namespace PIMG_ABI
}  // namespace pimg
