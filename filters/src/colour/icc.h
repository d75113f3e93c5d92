// SPDX-License-Identifier: BSD-3-Clause
// ICC profiles of pictures: primaries and transfer curves, read with Little CMS, which OpenColorIO does not do.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "colour/primaries.h"

namespace pimg {
inline namespace PIMG_ABI {

/// An RGB space as a matrix and a curve for each channel.
struct IccSpace {
    static constexpr std::size_t kSamples = 4096;  ///< of a curve, with straight lines between them: exact to 16 bits

    Chromaticities primaries {};               ///< adapted to D50, as profiles hold them
    std::array<std::vector<float>, 3> curves;  ///< linear light at kSamples equal steps from 0 to 1
    bool linear = false, srgb = false;         ///< whether the curves are straight; whether the space is sRGB
    std::string name;                          ///< as the profile describes itself
};

/// False if the data are no profile of RGB or grey pictures, or if its colours are given by a table instead of a
/// matrix.
bool read_icc(const void* profile, std::size_t size, IccSpace& space);

/// The profile of Display P3: the primaries of DCI-P3, the white of D65 and the curve of sRGB.
std::string display_p3_profile();

}  // namespace PIMG_ABI
}  // namespace pimg
