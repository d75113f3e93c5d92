// SPDX-License-Identifier: BSD-3-Clause
// Writes strokes as SVG or JSON text, for other programs.
#pragma once

#include <string>
#include <vector>

#include <pimg/strokes.h>

namespace pimg {

/// Colours of strokes as shown: colors[c][i] is channel c (red, green, blue) of stroke i, encoded as sRGB, 0..1. Values
/// outside are clipped. With one channel the strokes are grey, with none they are black.
using ShownColors = std::vector<std::vector<float>>;

/// A drawing: every stroke is a path in the order of painting, round at the ends, pixel (0, 0) being the unit
/// square at the origin. `ground` is a colour such as "#ffffff", or empty for none.
std::string strokes_to_svg(const Strokes& strokes, const ShownColors& colors, float opacity, const std::string& ground);

/// {"width", "height", "strokes": [{"points": [[x, y], ...], "width", "color": [r, g, b], "level", "vertex"}, ...]};
/// pixel centres are whole numbers, a stroke's ends lie half a width beyond its points; a stroke that only fills
/// gaps has vertex -1.
std::string strokes_to_json(const Strokes& strokes, const ShownColors& colors, float opacity);

}  // namespace pimg
