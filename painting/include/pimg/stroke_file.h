// SPDX-License-Identifier: BSD-3-Clause
// Strokes as SVG or JSON text, for other programs.
#pragma once

#include <string>
#include <vector>

#include <pimg/strokes.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The colours of strokes as they are shown: colours[c][i] is channel c (red, green, blue) of stroke i, encoded in sRGB,
/// 0..1. Values outside are clipped. With one channel the strokes are grey, and with none they are black.
using ShownColours = std::vector<std::vector<float>>;
using ShownColors [[deprecated("renamed: ShownColours")]] = ShownColours;

/// An SVG drawing. Every stroke is a path with round ends, in the order of painting. Pixel (0, 0) is the unit square at
/// the origin. `opacity`, 0..1, is that of every stroke. `ground` is the colour behind them, such as "#ffffff", or empty
/// for none.
PIMG_EXPORT std::string strokes_to_svg(const Strokes& strokes, const ShownColours& colours, float opacity,
                                       const std::string& ground);

/// A JSON object: {"width", "height", "strokes": [{"points": [[x, y], ...], "width", "color": [r, g, b], "level",
/// "vertex"}, ...]}, where the centres of pixels have whole coordinates. A stroke's ends lie half its width beyond its
/// first and last points. A stroke that only fills gaps has the vertex -1.
PIMG_EXPORT std::string strokes_to_json(const Strokes& strokes, const ShownColours& colours, float opacity);

}  // namespace PIMG_ABI
}  // namespace pimg
