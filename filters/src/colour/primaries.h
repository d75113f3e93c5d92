// SPDX-License-Identifier: BSD-3-Clause
// Primaries of RGB spaces and the matrices between them. Whites are adapted by the method of Bradford, as
// the conversions of ACES and ICC do. Matrices act on rows, as is usual with Imath: rgb * m, and a * b is first a, then b.
#pragma once

#include <array>

#include <OpenImageIO/Imath.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// CIE xy of red, green, blue and white.
using Chromaticities = std::array<double, 8>;

constexpr Chromaticities kRec709 { 0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290 };
constexpr Chromaticities kRec2020 { 0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290 };
constexpr Chromaticities kP3 { 0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290 };
constexpr Chromaticities kAdobe { 0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.3290 };
constexpr Chromaticities kProPhoto { 0.734699, 0.265301, 0.159597, 0.840403, 0.036598, 0.000105, 0.345704, 0.358540 };
constexpr Chromaticities kAp0 { 0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767 };
constexpr Chromaticities kAp1 { 0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767 };
constexpr Chromaticities kXyzD65 { 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.3127, 0.3290 };

/// False for singular matrices and those with elements that are no numbers.
bool invert(const Imath::M33d& matrix, Imath::M33d& inverse);

/// From linear RGB of these primaries to linear Rec. 709. False for degenerate primaries.
bool matrix_to_rec709(const Chromaticities& primaries, Imath::M33d& matrix);

/// The well-known primaries whose matrix to Rec. 709 is within `tolerance` of this one, else null.
const Chromaticities* known_primaries(const Imath::M33d& to_rec709, double tolerance);

}  // namespace PIMG_ABI
}  // namespace pimg
