// SPDX-License-Identifier: BSD-3-Clause
// The dual pieces of a hierarchy: every vertex of a mesh M_i stands for the pixels it was collapsed from. A pixel that
// is no vertex of the finest mesh is shared out by its interpolation weights. Both functions are one pass from fine to
// coarse.
#pragma once

#include <vector>

#include <pimg/bands.h>
#include <pimg/hierarchy.h>

namespace pimg {

/// Number of pixels t and u of each split stand for. Depends on the geometry only.
std::vector<Detail> piece_sizes(const Hierarchy& hierarchy);

/// Means of one channel (a value per mesh pixel, row-major) over the dual pieces: `base` those of the base vertices,
/// `details` those of t and u of each split: the means themselves, not what a prediction leaves of them. The larger a
/// piece, the less texture its mean carries, which the value of its vertex does not have.
Bands piece_means(const Hierarchy& hierarchy, const float* samples);

}  // namespace pimg
