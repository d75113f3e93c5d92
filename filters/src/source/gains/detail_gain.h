// SPDX-License-Identifier: BSD-3-Clause
// Compression of details, Eq. (2) of the paper, on vectors of them. Every instruction set gives the same bits.
#pragma once

#include <cstddef>

#include <pimg/bands.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What decides the gains of some splits; each array has a number for every split.
struct SplitTraits {
    const float* contrast = nullptr;    ///< null: each t and u has the gain of its own size
    const float* visibility = nullptr;  ///< null: all are visible
    const float* factor = nullptr;      ///< on the gain; null: 1
};

/// The gain of a detail that belongs to a contrast c, Eq. (2) of the paper but for the gain of the smallest details:
///     h(c) = s0 + (g - s0) (1 - c / dmax)^beta,   s0 from dmax on
///     g    = quiet + visibility (detail - quiet)
/// Visibility is 0 where a detail is noise and 1 where it is not. With detail = 1 and no noise this is Eq. (2).
struct DetailGain {
    float s0, beta, dmax;
    float detail = 1.0f;  ///< gain of the smallest details
    float quiet = 1.0f;   ///< gain of noise

    /// Turns `count` contrasts into their gains, all visible.
    void apply(float* contrasts, std::size_t count) const;

    /// Multiplies `count` details by their gains.
    void apply(const Detail* details, const SplitTraits& traits, std::size_t count, Detail* compressed) const;
};

}  // namespace PIMG_ABI
}  // namespace pimg
