// SPDX-License-Identifier: BSD-3-Clause
// Feature-preserving smoothing by strength: what is small in contrast for its size goes, edges and thin lines stay.
//
//     picture ──▶ piece means ──sweep──▶ feature picture ──┐ says where the edges are
//        └─────────────────────────────────┴── mixed ──────┴─diffuse─▶ ─diffuse by itself─▶ result
//
// The hierarchy sees features at every size but leaves the shape of its pieces; diffusion over the finest mesh leaves
// no shape but reaches only a few pixels. Each makes up for the other. Why each part is as it is, and what was tried
// instead: docs/smoothing.md.
#pragma once

#include <cstddef>
#include <vector>

#include <pimg/channels.h>
#include <pimg/dual_pieces.h>
#include <pimg/hierarchy.h>

namespace pimg {

/// What smoothing needs to know of a picture. Computed once; every strength is then one sweep and one diffusion.
struct SmoothingSource {
    Channels samples;                 ///< one to four channels, a finite value per mesh pixel
    std::vector<PieceMeans> means;    ///< of each channel
    std::vector<SplitPair> evidence;  ///< squared sizes, in pixels, of the pieces of t and u of each split

    std::size_t memory() const;
};

/// All channels are smoothed by one decision.
SmoothingSource analyse_for_smoothing(const Hierarchy& hierarchy, Channels samples);

struct SmoothingOptions {
    float strength = 0.03f;  ///< 0 or more, in units of the samples
    ParallelFor parallel;    ///< the result does not depend on it
};

/// Smooths away what deviates from its surroundings by up to about `strength`, as the root mean square over the
/// channels. Small things need more contrast to stay, large ones less: features are told from texture by volume,
/// contrast times pixels, which is what the hierarchy was built by. 0 returns the samples.
void smooth(const Hierarchy& hierarchy, const SmoothingSource& source, const SmoothingOptions& options,
            Channels& result);

/// The first half of smooth(): coarse to fine, each vertex takes from its piece's mean what the vertices made so far do
/// not predict and is not shrunk away. So what the coarser levels lost is found again where the finer ones show it, and
/// no deviation above the tolerance is ever lost. One value per mesh pixel.
void feature_sweep(const Hierarchy& hierarchy, const SmoothingSource& source, float strength, Channels& features);

/// samples + (gain - 1) (samples - smooth()), with less of it on edges: where the smoothed picture has a gradient g, in
/// strength per pixel, the share 1 / (1 + 4 g^2)^2. That keeps halos under a hundredth of a step, and soft
/// edges from reversing.
void enhance(const Hierarchy& hierarchy, const SmoothingSource& source, const SmoothingOptions& options, float gain,
             Channels& result);

/// Standard deviation of the noise of a picture, as if white: from the median absolute mixed second difference.
/// A multiple of it is a natural strength. 0 for pictures under 2 x 2 pixels.
float noise_level(const Channels& samples, int width, int height);

}  // namespace pimg
