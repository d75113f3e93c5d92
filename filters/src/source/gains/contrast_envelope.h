// SPDX-License-Identifier: BSD-3-Clause
// The contrast that details belong to, by which they are compressed.
#pragma once

#include <memory>
#include <vector>

#include <pimg/bands.h>
#include <pimg/detail/sweep_plan.h>

#include "source/gains/detail_gain.h"
#include "source/gains/feature_size.h"
#include "source/samples/noise.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Bands ready to be swept again and again: details in the order of a plan. If that is the hierarchy's, they are those of
/// `bands`, which must live as long.
struct PlannedBands {
    std::shared_ptr<const SweepPlan> shared;
    const SweepPlan& plan;
    std::vector<float> base;
    std::vector<Detail> ordered;  ///< empty if the order is the hierarchy's
    const Detail* details;

    PlannedBands(std::shared_ptr<const SweepPlan> plan, const Bands& bands, const ParallelFor& parallel);
    PlannedBands(const PlannedBands&) = delete;
    PlannedBands& operator=(const PlannedBands&) = delete;
};

/// What decides the gain of every split, in the order of the plan.
struct Envelope {
    std::vector<float> contrast;    ///< the contrast that the details of the split belong to; empty: their own
    std::vector<float> visibility;  ///< 0: no more than noise, 1: clearly more; empty: all are 1
    std::vector<FeatureSize> size;  ///< of the features that the split adds; empty if it was not asked for
};

/// How an Envelope is made.
struct EnvelopeOptions {
    float coherence = 0.75f;  ///< share of the contrast that is inherited; 0: details have their own only
    float range = 0.0f;       ///< contrast that the base mesh has: the dynamic range of the picture, in guide units
    NoiseModel noise;         ///< of the samples
    float diagonal = 0.0f;    ///< of the picture, in pixels, by which sizes are measured; 0: sizes are not asked for

    bool operator==(const EnvelopeOptions& other) const
    {
        return coherence == other.coherence && range == other.range && noise == other.noise
            && diagonal == other.diagonal;
    }
};

/// The contrast of a split is
///     e = coherence * inherited + (1 - coherence) * own
/// own: the larger of the two details and of the span of the coarser mesh's values at the stencils' vertices.
/// inherited: what the splits that made those vertices had, by the weights the details are predicted with.
///
/// Why own is not just the detail: a step edge is made of large details and of many small ones that correct the slopes
/// the coarse mesh had beside it. Eq. (2) on each detail's own size compresses the step, but not the corrections, which
/// then overshoot: halos and reversed gradients. Measured by the face it corrects, a correction of a steep
/// face is as compressed as the face itself, and the texture on a plateau, whose faces are flat, is left alone.
/// Why anything is inherited: the mesh of a coarse level is one of many that would do as well, and a gain that follows
/// its accidents makes pictures that differ by one pixel, or by a scale, come out visibly different far away.
///
/// Its visibility compares its own contrast with the noise there.
Envelope contrast_envelope(const PlannedBands& bands, const EnvelopeOptions& options, const ParallelFor& parallel);

/// The compressed bands at the finest level, in the places of the plan: the base scaled by gain.s0, both details of a
/// split by the gain of its contrast, visibility and size, or each by that of its own magnitude if the envelope has no
/// contrasts. `sizes` raises all gains of an envelope with sizes.
void compress(const PlannedBands& bands, const DetailGain& gain, const SizeGains& sizes, const Envelope& envelope,
              const ParallelFor& parallel, float* values);

/// Adds the compressed residual to the compressed finest mesh: by the gain of its own size, or of `coherence` times the
/// span of its face if that is larger. Both rasters are of the picture's size; nothing to do without a residual.
void compress_residual(const Hierarchy& hierarchy, const Bands& bands, const DetailGain& gain, float coherence,
                       const std::vector<float>& picture, std::vector<float>& compressed);

}  // namespace PIMG_ABI
}  // namespace pimg
