// SPDX-License-Identifier: BSD-3-Clause
// Colour spaces the engine knows by name, without a configuration.
#pragma once

#include <string>

#include "colour/primaries.h"

namespace pimg {
inline namespace PIMG_ABI {

/// A transfer curve and primaries. The curve is ((v + offset) / (1 + offset))^gamma with a linear start, or a plain
/// power if offset is 0.
struct NamedSpace {
    double gamma = 1.0, offset = 0.0;
    Chromaticities primaries = kRec709;

    bool linear() const { return gamma == 1.0; }
};

constexpr double kSrgbGamma = 2.4, kSrgbOffset = 0.055;             ///< IEC 61966-2-1
constexpr double kRec709Gamma = 1.0 / 0.45, kRec709Offset = 0.099;  ///< Rec. ITU-R BT.709

/// Whether the name is one for sRGB-encoded Rec. 709.
bool names_srgb(const std::string& lower_case);

/// Names of OpenImageIO (2.4: sRGB, Rec709, Gamma2.2; 3.x: lin_rec709, g22_rec709, srgb_rec709_scene), of the Color
/// Interop Forum (lin_ap1_scene), of the ACES configurations (ACEScg, Linear Rec.2020) and of old ones; in lower case.
bool find_named_space(const std::string& lower_case, NamedSpace& space);

/// The name of a space of Rec. 709, lin_rec709_scene, changed for other primaries: lin_ap1_scene; empty if none is agreed
/// on. A name that says nothing of primaries, Linear, stays as it is.
std::string with_primaries(std::string name, const Chromaticities& primaries);

}  // namespace PIMG_ABI
}  // namespace pimg
