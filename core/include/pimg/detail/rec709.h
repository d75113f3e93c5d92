// SPDX-License-Identifier: BSD-3-Clause
// Colours with the primaries of Rec. ITU-R BT.709: the weights of their luminance, the curve of sRGB, and lightness. Like
// the functions of elementary.h these have the same bits on every machine.
#pragma once

#include <array>

#include <pimg/detail/elementary.h>

namespace pimg {
inline namespace PIMG_ABI {
namespace elementary {

/// The weights of linear red, green and blue in the luminance.
inline constexpr std::array<float, 3> kRec709Weights { 0.2126f, 0.7152f, 0.0722f };

/// Linear light of a number that the curve of sRGB (IEC 61966-2-1) encodes. Below 0 the curve is a straight line, and above
/// 1 it continues.
inline double srgb_decoded(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : power((encoded + 0.055) / 1.055, 2.4);
}

/// The inverse of srgb_decoded().
inline double srgb_encoded(double light)
{
    return light <= 0.0031308 ? 12.92 * light : 1.055 * power(light, 1.0 / 2.4) - 0.055;
}

/// L* of a luminance of 0 or more, where white is 1 and has L* = 100 (CIE 15).
inline float lightness(float luminance)
{
    return luminance > 216.0f / 24389.0f ? 116.0f * float(cube_root(double(luminance))) - 16.0f
                                         : luminance * (24389.0f / 27.0f);
}

}  // namespace elementary
}  // namespace PIMG_ABI
}  // namespace pimg
