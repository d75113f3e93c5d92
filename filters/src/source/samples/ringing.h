// SPDX-License-Identifier: BSD-3-Clause
// Dark samples that are no part of the scene: resampling, sharpening and lossy compression ring beside bright lights.
// They leave samples there that are negative, zero or implausibly dark.
#pragma once

#include <vector>

#include "source/guide.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Finds the pixels that ring, in order, and gives each three quarters of the light around it and its colour: still
/// darker than that, but no hole. `luminance` is that of every pixel, in linear light. A pixel rings if most of the 24
/// pixels around it are lit and it is much darker than these: five stops or more if a channel is negative; three stops
/// if a light is beside it, which is five stops lighter than what is around. So thin black lines are no ringing. Pixels
/// of larger black areas are not found, nor are transparent ones.
std::vector<FilledPixel> find_ringing(const OIIO::ImageBuf& picture, const Colour& colour, const Raster& luminance,
                                      const ParallelFor& parallel);

}  // namespace PIMG_ABI
}  // namespace pimg
