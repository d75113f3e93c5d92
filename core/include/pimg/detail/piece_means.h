// SPDX-License-Identifier: BSD-3-Clause
// The dual pieces of a hierarchy: every vertex of a mesh M_i stands for the pixels it was collapsed from. A pixel that
// is no vertex of the finest mesh is shared out by its interpolation weights. Both functions are one pass from fine to
// coarse.
#pragma once

#include <vector>

#include <pimg/dual_pieces.h>
#include <pimg/hierarchy.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Number of pixels t and u of each split stand for. Depends on the geometry only.
PIMG_EXPORT_DETAIL std::vector<SplitPair> piece_sizes(const Hierarchy& hierarchy);

/// Means of one channel, a value per mesh pixel, row-major.
PIMG_EXPORT_DETAIL PieceMeans piece_means(const Hierarchy& hierarchy, const float* samples);

}  // namespace PIMG_ABI
}  // namespace pimg
