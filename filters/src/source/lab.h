// SPDX-License-Identifier: BSD-3-Clause
// Colours as seen, for telling regions apart.
#pragma once

#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/colour.h>
#include <pimg/types.h>

#include "source/guide.h"

namespace pimg {
inline namespace PIMG_ABI {

/// CIELAB-like channels of a float picture without special samples, one raster of its size each: L, a, b of its linear
/// light; L alone for one colour channel, and that of each for two. Greys have a = b = 0 whatever the primaries.
///
/// Encoded pictures (8 bit) have their white at L = 100. Scene-linear ones have no white: the median luminance is
/// placed at 0.18, and above white the cube root goes on as a logarithm, so that the distance of two bright colours
/// depends on their ratio. Negative light counts as none.
std::vector<std::vector<float>> lab_channels(const OIIO::ImageBuf& picture, const Colour& colour,
                                             const ParallelFor& parallel);

/// The same as guide channels: 255 guide units are L = 100, so that all three weigh as they are seen.
std::vector<Raster> lab_guide(const OIIO::ImageBuf& picture, const Colour& colour, const ParallelFor& parallel);

}  // namespace PIMG_ABI
}  // namespace pimg
