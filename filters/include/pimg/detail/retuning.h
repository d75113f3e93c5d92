// SPDX-License-Identifier: BSD-3-Clause
// For hosts whose users turn knobs.
#pragma once

#include <pimg/progressive_image.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Says that filters will be called with many settings. What they otherwise do at their second call, to make all later ones
/// fast, they then do at the first. The results are the same.
PIMG_EXPORT_DETAIL void expect_retunes(const ProgressiveImage& image);

}  // namespace PIMG_ABI
}  // namespace pimg
