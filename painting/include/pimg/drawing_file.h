// SPDX-License-Identifier: BSD-3-Clause
// Drawings as SVG or JSON text, for printers, plotters and other programs.
#pragma once

#include <string>

#include <pimg/drawing.h>

namespace pimg {
inline namespace PIMG_ABI {

/// A sheet of paper in millimetres, each side above 0.
struct Paper {
    double width = 210.0, height = 148.0;
};

/// Millimetres of paper to a pixel when a picture fills the paper as far as it can. The paper is turned if that makes the
/// drawing larger.
PIMG_EXPORT double millimetres_per_pixel(const Drawing& drawing, Paper& paper);

/// An SVG drawing on a white sheet of `paper`, in the middle and as large as it fits, in millimetres. There is one group
/// for each ink, which Inkscape and programs of plotters show as a layer, in the order of the inks from the last to the
/// first, which is black. Every line is a closed path round what the pen covers, and a dot is a circle.
PIMG_EXPORT std::string drawing_to_svg(const Drawing& drawing, Paper paper);

/// The same for a plotter that draws with pens of one width: the middle lines, each as a path with that stroke width, a dot
/// as a path of no length. `pen` is in pixels. There is no sheet behind them.
PIMG_EXPORT std::string drawing_to_plot(const Drawing& drawing, Paper paper, float pen);

/// A JSON object: {"width", "height", "inks": [[r, g, b], ...], "lines": [{"ink": number, "points": [[x, y, width],
/// ...]}, ...]}, in pixels, where the centres of pixels have whole coordinates.
PIMG_EXPORT std::string drawing_to_json(const Drawing& drawing);

}  // namespace PIMG_ABI
}  // namespace pimg
