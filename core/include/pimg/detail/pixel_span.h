// SPDX-License-Identifier: BSD-3-Clause
// Scan conversion of a triangle on the lattice, by integers only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// a / b rounded down; b is positive.
inline std::int64_t floor_div(std::int64_t a, std::int64_t b)
{
    return a / b - (a % b != 0 && a < 0);
}

/// First and last pixel of a row; none when `last` is below `first`.
struct PixelSpan {
    std::int64_t first, last;
};

/// The pixels of row y whose centres lie in the triangle, those on its border included. They may reach beyond the
/// picture where the triangle does not reach the row.
inline PixelSpan pixel_span(const Point (&p)[3], std::int64_t y)
{
    PixelSpan s { std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max() };
    for (int k = 0; k < 3; ++k) {
        const Point a = p[k], b = p[(k + 1) % 3];
        // Inside is where rise * x <= limit, x in lattice units.
        const std::int64_t rise = b.y - a.y;
        const std::int64_t limit = std::int64_t(b.x - a.x) * (y * kSubpixels - a.y) + rise * a.x;
        if (rise > 0)
            s.last = std::min(s.last, floor_div(limit, rise * kSubpixels));
        else if (rise < 0)
            s.first = std::max(s.first, -floor_div(limit, -rise * kSubpixels));
        else if (limit < 0)
            return { 0, -1 };
    }
    return s;
}

}  // namespace PIMG_ABI
}  // namespace pimg
