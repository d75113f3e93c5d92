// SPDX-License-Identifier: BSD-3-Clause
// The inks of a drawing in colours.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// An ink, and how dark it is.
struct Ink {
    std::array<float, 3> colour;  ///< red, green and blue, encoded in sRGB, 0..1
    float lightness = 0.0f;       ///< its L*, 0..100
};

/// The mean colour of a region of a picture.
struct RegionColour {
    std::array<float, 3> lab;  ///< CIELAB with white at L* = 100
    float area;                ///< in pixels
};

/// Inks, and which of them each region is drawn with.
struct InkChoice {
    std::vector<Ink> inks;                    ///< the first is black
    std::vector<std::uint8_t> ink_of_region;  ///< one number for each region
};

/// Chooses at most `count` inks, 1..16, the first of which is black. Ink on white paper makes all mixtures of its colour
/// with white. So regions whose colours lie in about the same direction from white share an ink, and it is about as
/// dark as the darkest of them. Regions of no clear colour are drawn in black.
PIMG_EXPORT InkChoice choose_inks(const std::vector<RegionColour>& regions, int count);

}  // namespace PIMG_ABI
}  // namespace pimg
