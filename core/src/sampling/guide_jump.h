// SPDX-License-Identifier: BSD-3-Clause
// How much a guide changes between two pixels: decides which of two diagonals an initial mesh has.
#pragma once

#include <pimg/guide.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The weighted squared differences of all channels between mesh pixels p and q.
inline float squared_jump(const Guide& guide, Index p, Index q)
{
    float sum = 0.0f;
    for (const GuideChannel& c : guide.channels)
        sum += c.weight * (c.samples[p] - c.samples[q]) * (c.samples[p] - c.samples[q]);
    return sum;
}

/// Whether the quad whose upper left pixel is p is cut from there to its lower right: along the smaller jump.
inline bool is_falling(const Guide& guide, Index p)
{
    const Index below = p + Index(guide.width);
    return squared_jump(guide, p, below + 1) <= squared_jump(guide, p + 1, below);
}

}  // namespace PIMG_ABI
}  // namespace pimg
