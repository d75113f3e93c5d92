// SPDX-License-Identifier: BSD-3-Clause
// The neighbours of one vertex, in order. They fit in one cache line of 64 bytes.
#pragma once

#include <array>
#include <cstdint>

#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The most neighbours a vertex may have, the ghost vertex included. A collapse that would exceed it is refused, which
/// happens to less than 0.01 % of the collapses.
constexpr int kMaxDegree = 16;

/// The neighbours of a vertex in order of increasing angle, from the x axis (right) towards the y axis (down). The
/// vertex forms a positively oriented triangle with each two successive entries; the first entry follows the last. A
/// border vertex has kGhost once among them, where the outside of the picture is. Only the first entries count, as many
/// as the vertex has neighbours; the mesh keeps that number.
struct Ring {
    std::array<Index, kMaxDegree> v;
};

}  // namespace PIMG_ABI
}  // namespace pimg
