// SPDX-License-Identifier: BSD-3-Clause
// Curves as the values of options: "position:value,position:value,...".
#pragma once

#include <string_view>
#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// A point that a curve passes through.
struct CurvePoint {
    double position, value;
};

/// The points of a curve. Numbers may have a sign. Returns false if `text` is anything else than pairs of finite numbers.
bool parse_curve(std::string_view text, std::vector<CurvePoint>& points);

}  // namespace PIMG_ABI
}  // namespace pimg
