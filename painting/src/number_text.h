// SPDX-License-Identifier: BSD-3-Clause
// Numbers in the text of files: with a point, whatever the locale, and no more digits than needed.
#pragma once

#include <array>
#include <string>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Appends a number rounded to hundredths, or to thousandths.
void append_number(std::string& text, double value, int decimals = 2);

/// "#rrggbb" of an sRGB-encoded colour; values outside 0..1 count as the nearer end.
std::string hexadecimal(const std::array<float, 3>& colour);

/// The nearest of 256 steps; values outside 0..1 count as the nearer end.
int byte_of(float value);

}  // namespace PIMG_ABI
}  // namespace pimg
