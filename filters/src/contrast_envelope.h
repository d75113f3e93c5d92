// SPDX-License-Identifier: BSD-3-Clause
// Compression of details: Eq. (2) of the paper, and the contrast it is applied to.
#pragma once

#include <vector>

#include <pimg/bands.h>

namespace pimg {

/// Eq. (2): h(d) = s0 + (1 - s0) (1 - d / dmax)^beta; details beyond dmax take s0.
struct DetailGain {
    float s0, beta, dmax;
    float operator()(float contrast) const;
};

/// For every split, the contrast its details belong to: the larger of the two details and of `coherence` times the contrast
/// of the coarser mesh around, which is the span of its values at the stencils' vertices.
///
/// Why: a step edge is made of large details and of many small ones that correct the slopes the coarse mesh had
/// beside it. Eq. (2) on each detail's own size compresses the step, but not the corrections, which then overshoot:
/// halos and reversed gradients. Measured by the face it corrects, a correction of a steep face is as
/// compressed as the face itself, and the texture on a plateau, whose faces are flat, is left alone.
std::vector<float> contrast_envelope(const Hierarchy& hierarchy, const Bands& bands, float coherence);

/// Values at the finest level, in vertex order, of the compressed bands: the base scaled by gain.s0, both details of
/// split i by gain(envelope[i]), or each by the gain of its own size if there is no envelope.
void compress(const Hierarchy& hierarchy, const Bands& bands, const DetailGain& gain,
              const std::vector<float>* envelope, float* values);

}  // namespace pimg
