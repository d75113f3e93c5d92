// SPDX-License-Identifier: BSD-3-Clause
// Diffusion along the edges of the finest mesh, the pixels' grid, that stops where another picture has an edge
// (Perona and Malik 1990), in the large unequal steps of a fast explicit scheme (Grewenig, Weickert, Bruhn 2010).
#pragma once

#include <vector>

#include <pimg/channels.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// How values flow. The conductance of an edge of the grid is
///     1 / (1 + (d / contrast)^2)^2
/// where d is the difference of the guide along the edge: the root of the mean square over its channels.
struct DiffusionOptions {
    int width = 0, height = 0;  ///< of all channels
    float contrast = 0.1f;      ///< difference across which a quarter of the flow is left; > 0, in units of the guide
    int steps = 7;              ///< 1 or more; n steps reach as far as a Gaussian of variance (n^2 + n) / 6, in pixels
    ParallelFor parallel;       ///< the result does not depend on it
    /// Below 1, what diffuses is guide + share (picture - guide); picture and guide then have as many channels.
    float share = 1.0f;
};

/// Diffuses every channel of `picture`, which may be the guide itself; the conductances are those of the guide as
/// given. The mean is preserved. After the last step no value is outside the range of the picture by more than
/// rounding.
PIMG_EXPORT_DETAIL void diffuse(const Channels& guide, const DiffusionOptions& options, const Channels& picture,
                                Channels& result);

}  // namespace PIMG_ABI
}  // namespace pimg
