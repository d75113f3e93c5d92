// SPDX-License-Identifier: BSD-3-Clause
// The neighbours of one vertex, in order, in one cache line.
#pragma once

#include <array>
#include <cstdint>

#include <pimg/types.h>

namespace pimg {

/// Most neighbours a vertex may have. A collapse that would exceed it is
/// refused; under a hundredth of a percent of them are.
constexpr int kMaxDegree = 16;

/// Neighbours of a vertex in order of increasing angle (x towards y): each pair of
/// successive entries and the vertex form a positively oriented triangle, the
/// last entry being followed by the first. A border vertex has kGhost once.
struct Ring {
    std::array<Index, kMaxDegree> v;
};

}  // namespace pimg
