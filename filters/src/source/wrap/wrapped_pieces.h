// SPDX-License-Identifier: BSD-3-Clause
// Pieces of a padded picture as pieces of the picture, which continue across its seams.
#pragma once

#include <vector>

#include "source/wrap/wrap.h"

namespace pimg {
inline namespace PIMG_ABI {

/// For each pixel of the picture, row-major, the pixel of the padded picture whose piece it belongs to. `labels` are the
/// pieces of the padded picture, 0 .. count - 1. Those whose middle lies in the picture are kept, wherever they reach;
/// where two of them meet across a seam, the nearer one has the pixel.
std::vector<Index> piece_places(const Wrap& wrap, const std::vector<Index>& labels, Index count);

/// The pieces by these places, numbered from 0 in the order of their first pixel. `count` becomes their number.
std::vector<Index> wrapped_pieces(const Wrap& wrap, const std::vector<Index>& labels, Index& count);

}  // namespace PIMG_ABI
}  // namespace pimg
