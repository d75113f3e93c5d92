// SPDX-License-Identifier: BSD-3-Clause
// Compression of details, Eq. (2) of the paper, on vectors of them. Every instruction set gives the same bits.
#pragma once

#include <cstddef>

#include <pimg/bands.h>

namespace pimg {

/// h(d) = s0 + (1 - s0) (1 - d / dmax)^beta; details beyond dmax take s0.
struct DetailGain {
    float s0, beta, dmax;

    /// Turns `count` contrasts into their gains.
    void apply(float* contrasts, std::size_t count) const;

    /// Multiplies `count` details by the gains of their contrasts, or, without contrasts, each t and u by that of its
    /// own size.
    void apply(const Detail* details, const float* contrasts, std::size_t count, Detail* compressed) const;
};

}  // namespace pimg
