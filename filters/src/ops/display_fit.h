// SPDX-License-Identifier: BSD-3-Clause
// Compression and exposure: from log luminance of any range to display luminance, middle grey and white placed.
#pragma once

#include <vector>

#include <pimg/options.h>

#include "ops/display_curve.h"

namespace pimg {

/// What s0, dmax and contrast are where they are 0: dmax a share of the picture's dynamic range, `range` stops, and the
/// others all from dmax, so that pictures compressed with one dmax are treated alike.
void find_compression(float range, HdrCompressOptions& options);

/// The dynamic range, in stops, that dmax stands for.
float range_of(const HdrCompressOptions& options);

/// Fills in key and white of otherwise resolved options where they are 0. `overview` holds the log2 luminances of the
/// compressed overview's lit cells, which are `dark` if there are none.
void find_exposure(std::vector<float> overview, float dark, HdrCompressOptions& options);

/// Display luminance at which the shoulder of resolved options reaches white.
float shoulder_white(const HdrCompressOptions& options);

}  // namespace pimg
