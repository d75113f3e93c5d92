// SPDX-License-Identifier: BSD-3-Clause
// Scene-linear pictures have no largest value: a lamp may be a thousand times as bright as the wall beside it. A filter
// that interpolates or amplifies such a step undershoots far below zero. These functions turn undershoot into shade.
#pragma once

#include <vector>

#include <pimg/bands.h>
#include <pimg/hierarchy.h>
#include <pimg/simplify.h>
#include <pimg/types.h>

#include "source/progressive_image_data.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Share of the expected light down to which values stay as they are. Chosen by eye: at 1/2 no value falls more than two
/// stops below its surroundings, which looks like shade; at 1/8 rings round lamps are still nearly black.
constexpr float kKnee = 0.5f;

/// What shaded() is below the knee.
float raised_to_shade(float value, float expected);

/// Returns `value` if it is at least half of `expected`, the light that is expected there. Lower values are raised
/// smoothly, so that they stay above a quarter of it. `expected` is above 0.
inline float shaded(float value, float expected)
{
    return value < kKnee * expected ? raised_to_shade(value, expected) : value;
}

/// Raises the values of those vertices of level `level` that have less light than their pieces of the picture: by
/// shaded() with the harmonic mean of the piece's samples as `expected`. In that mean the darkest samples count most,
/// so that a lamp in the piece does not decide. Where a sample is not above 0, the value is at least min(0, the piece's
/// least sample). At the finest level nothing changes. `values` has those of every colour channel, times 2^-exponent.
void shade_vertices(const ProgressiveImage::Data& data, int exponent, Level level, const ParallelFor& parallel,
                    Channels& values);

/// Raises samples of results, one raster per colour channel, to min(0, the least of the source's 3 x 3 samples around).
/// Nothing is done for pictures that are not scene-linear.
void bound_below(const ProgressiveImage::Data& data, const ParallelFor& parallel, Channels& results);

/// Whether the picture is scene-linear. Encoded pictures have a black, so undershoot does not show.
bool is_scene_linear(const ProgressiveImage::Data& data);

}  // namespace PIMG_ABI
}  // namespace pimg
