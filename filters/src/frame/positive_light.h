// SPDX-License-Identifier: BSD-3-Clause
// Scene-linear pictures have no white above which nothing is: a lamp is a thousand times as bright as the wall beside it,
// and what interpolates or amplifies such a step undershoots far below zero. Here undershoot becomes shade.
#pragma once

#include <vector>

#include <pimg/bands.h>
#include <pimg/hierarchy.h>
#include <pimg/simplify.h>
#include <pimg/types.h>

#include "source/progressive_image_data.h"

namespace pimg {

/// `value` down to half of the light expected there; what is below, smoothly, stays above a quarter of it. `expected`
/// is above 0.
float shaded(float value, float expected);

/// Values of the vertices of level `level`, changed where they are less light than their pieces of the picture have:
/// shaded() with the harmonic mean of the piece's samples, in which the darkest count most, since the light of a lamp in
/// the piece says nothing of its surroundings. Where a sample is not above 0, the value is at least min(0, the piece's
/// least sample). At the finest level nothing changes.
void shade_vertices(const Hierarchy& hierarchy, const Bands& bands, Level level, float* values);

/// Raises samples of results, one raster per colour channel, to min(0, the least of the source's 3 x 3 samples around).
/// Nothing is done for pictures that are not scene-linear.
void bound_below(const ProgressiveImage::Data& data, const ParallelFor& parallel, Channels& results);

/// Whether the filters above apply: encoded pictures have a black.
bool is_scene_linear(const ProgressiveImage::Data& data);

}  // namespace pimg
