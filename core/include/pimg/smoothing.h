// SPDX-License-Identifier: BSD-3-Clause
// Smoothing that preserves features, controlled by one strength: what has little contrast for its size is removed, and
// edges and thin lines stay.
//
//     picture ──▶ piece means ──sweep──▶ feature picture ──┐ says where the edges are
//        └─────────────────────────────────┴── mixed ──────┴─diffuse─▶ ─diffuse by itself─▶ result
//
// The hierarchy sees features of every size, but the shapes of its pieces would show in the result. Diffusion over the
// pixels' grid leaves no such shapes, but reaches only a few pixels far. Each makes up for the other's weakness.
// docs/smoothing.md says why each part is as it is, and what else was tried.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <pimg/channels.h>
#include <pimg/dual_pieces.h>
#include <pimg/hierarchy.h>

namespace pimg {
inline namespace PIMG_ABI {

class SweepPlan;

/// What smoothing needs to know of a picture. It is computed once; each strength then takes one sweep and a few steps of
/// diffusion.
struct PIMG_EXPORT SmoothingSource {
    Channels samples;                 ///< one to four channels, each with a finite value per mesh pixel, row-major
    std::vector<PieceMeans> means;    ///< of each channel
    std::vector<SplitPair> evidence;  ///< squares of the sizes in pixels of the pieces of t and u, for each split
    /// Made for many strengths: what is there for each split is in the order of this plan. Null: in the hierarchy's.
    std::shared_ptr<const SweepPlan> plan;

    /// Bytes held.
    std::size_t memory() const;
};

/// Makes a SmoothingSource of one to four channels with a finite value per mesh pixel. The channels are smoothed
/// together: what stays in one of them stays in all.
PIMG_EXPORT SmoothingSource analyse_for_smoothing(const Hierarchy& hierarchy, Channels samples);

struct SmoothingOptions {
    float strength = 0.03f;  ///< in units of the samples, 0 or more; 0 changes nothing
    ParallelFor parallel;    ///< the result does not depend on it
};

/// Removes what deviates from its surroundings by up to about `strength`, where deviations are root mean squares over the
/// channels. Small things need more contrast to stay, and large ones less: features are told from texture by their
/// volume, that is contrast times pixels, which is also the measure that the hierarchy was built by. A strength of 0 or
/// less returns the samples unchanged. `result` has the shape of source.samples.
PIMG_EXPORT void smooth(const Hierarchy& hierarchy, const SmoothingSource& source, const SmoothingOptions& options,
                        Channels& result);

/// The first half of smooth(). From coarse to fine, each vertex gets the value that the coarser vertices predict, plus a
/// share of how much the mean of its piece deviates from this. The share is near 1 if that deviation times the size of
/// the piece is well above 8 pixels times `strength`, 1/2 if it is equal to it, and near 0 below. The prediction is made
/// from values that were reduced in this way, so a feature that coarser levels lost comes back at the first finer level
/// that shows it clearly. `features` receives one value per mesh pixel and channel.
PIMG_EXPORT void feature_sweep(const Hierarchy& hierarchy, const SmoothingSource& source, float strength,
                               Channels& features);

/// Amplifies what smooth() removes: samples + (gain - 1) (samples - smoothed), less on edges. Where the smoothed picture
/// has the gradient g, in multiples of the strength per pixel, only the share 1 / (1 + 4 g^2)^2 of this is added. This
/// keeps halos at an edge below 1 % of its height, and soft edges from reversing.
PIMG_EXPORT void enhance(const Hierarchy& hierarchy, const SmoothingSource& source, const SmoothingOptions& options,
                         float gain, Channels& result);

/// Estimates the standard deviation of a picture's noise, in units of its samples, as the root mean square over the
/// channels. It assumes white noise, and takes the median of the absolute mixed second differences. A small multiple of
/// it is a good strength for smooth(). Returns 0 for pictures of fewer than 2 x 2 pixels.
PIMG_EXPORT float noise_level(const Channels& samples, int width, int height);

}  // namespace PIMG_ABI
}  // namespace pimg
