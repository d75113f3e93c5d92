// SPDX-License-Identifier: BSD-3-Clause
// The whole hierarchy as the edge collapses that lead from the pixels to the base mesh, fine to coarse. A reader starts
// from the pixel grid, whose connectivity takes a bit per quad, and repeats them: the positions of t and u
// are known, only that of s is coded. Vertices go by the pixel they began as; a merged vertex keeps the smaller.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/bands.h>
#include <pimg/codec.h>
#include <pimg/hierarchy.h>

#include "entropy/bytes.h"

namespace pimg {
inline namespace PIMG_ABI {

struct CollapseChunks {
    std::vector<Bytes> chunks;
};

/// Positions are moved onto multiples of 2^lattice_shift lattice units; 0 keeps them.
Status write_collapse_sequence(const Hierarchy& hierarchy, const PictureDesc& desc,
                               const std::vector<ConstStridedChannel>& samples, std::uint32_t lattice_shift,
                               CollapseChunks& chunks);

/// The integer picture, one value per mesh pixel, that predicts the diagonals of the grid's quads.
std::vector<std::int32_t> diagonal_guide(const PictureDesc& desc, const std::vector<ConstStridedChannel>& samples);

/// A chunk's payload.
struct ByteSpan {
    const std::uint8_t* data;
    std::size_t size;
};

/// Repeats the collapses. `channels` hold one value per mesh pixel each; `bands` receives them analysed.
Status read_collapse_sequence(const std::vector<ByteSpan>& chunks, int width, int height,
                              const std::vector<std::int32_t>& guide, const std::vector<const float*>& channels,
                              Hierarchy& hierarchy, std::vector<Bands>& bands);

}  // namespace PIMG_ABI
}  // namespace pimg
