// SPDX-License-Identifier: BSD-3-Clause
// The tiles of a padded picture as tiles of the picture, which continue across its seams.
#pragma once

#include <pimg/mosaic.h>

#include "source/wrap/wrap.h"

namespace pimg {
inline namespace PIMG_ABI {

/// The tiling of the picture without margins. Tiles of the two margins that do not fit together get a joint where they meet.
Tiling wrapped_tiling(const Wrap& wrap, const Tiling& tiling, Index tiles);

}  // namespace PIMG_ABI
}  // namespace pimg
