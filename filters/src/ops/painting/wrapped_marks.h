// SPDX-License-Identifier: BSD-3-Clause
// Strokes and lines that were planned on a padded picture, as marks of the picture: those that cross a seam are drawn on both
// sides of it.
#pragma once

#include <pimg/drawing.h>
#include <pimg/stroke_file.h>

#include "source/wrap/wrap.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Keeps the strokes whose middle is in the picture, or at most `overlap` pixels beyond a seam, where there might be holes
/// otherwise, and repeats those that reach across. Places stay those of the padded picture. Repeated strokes have the
/// colours and the random changes of the first. Nothing to do without margins.
void wrap_strokes(const Wrap& wrap, float overlap, Strokes& strokes, ShownColours& colours);

/// The same strokes with places in the picture.
Strokes without_margins(const Wrap& wrap, Strokes strokes);

/// A drawing of the picture, of the lines whose middle is in it, repeated where they reach across a seam.
Drawing wrapped_drawing(const Wrap& wrap, const Drawing& drawing);

}  // namespace PIMG_ABI
}  // namespace pimg
