// SPDX-License-Identifier: BSD-3-Clause
// The dots of a drawing.
#pragma once

#include <cstdint>

#include <pimg/drawing.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What dots are made of.
struct StippleOptions {
    float pen = 2.0f;                                   ///< width of the pen in pixels
    float least = 0.04f;                                ///< share of the paper below which there are no dots
    const std::vector<std::uint8_t>* ink_of = nullptr;  ///< ink of each pixel; null: the first
    std::uint32_t seed = 1;
};

/// Adds dots to a drawing of the size of `cover`, the share of the paper that they are to cover, 0..1. They are the centres
/// of a weighted Voronoi diagram (Secord 2002), and each is as large as its cell asks for.
void add_stipple(const Raster& cover, const StippleOptions& options, Drawing& drawing);

}  // namespace PIMG_ABI
}  // namespace pimg
