// SPDX-License-Identifier: BSD-3-Clause
// Samples <-> the integers the file codes: a bijection per type, then a reversible colour transform.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/codec.h>

#include "entropy/bytes.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Reversible transforms of the first three channels.
constexpr std::size_t kTransformChannels = 3;  ///< the first so many are transformed together

enum class Transform : std::uint8_t {
    none = 0,
    ycocg = 1,  ///< YCoCg-R (Malvar & Sullivan 2003)
    green = 2   ///< differences from the second channel
};

/// A rectangle of integers, one vector per channel, row-major.
struct Integers {
    std::uint32_t width = 0, height = 0;
    std::vector<std::vector<std::int32_t>> channels;
};

/// Whether `transform` may be applied to a picture: three channels of the same type of at most 16 bits.
bool allows(const PictureDesc& desc, Transform transform);

/// Ordered integer of a sample given as its bits, and back.
std::int32_t to_integer(SampleType type, std::uint32_t bits);
std::uint32_t to_bits(SampleType type, std::int32_t integer);

/// Right shift that takes a channel's integers to the mesh layer's, which have at most 18 bits.
int mesh_shift(SampleType type);

/// Reads width x height samples of every channel, starting at (x, y).
Integers gather(const PictureDesc& desc, const std::vector<ConstStridedChannel>& channels, std::uint32_t x,
                std::uint32_t y, std::uint32_t width, std::uint32_t height);

/// In place, on the first three channels.
void forward(Transform transform, std::vector<std::vector<std::int32_t>>& channels);
void inverse(Transform transform, std::vector<std::vector<std::int32_t>>& channels);

/// Writes the integers of channel c, untransformed, as samples at (x, y) of `channel`. With `clamp`, values outside the
/// type's range are brought back into it: for the mesh layer alone. The integers are used up.
void scatter(SampleType type, std::vector<std::int32_t>& integers, std::uint32_t width, std::uint32_t height,
             bool clamp, const StridedChannel& channel, std::uint32_t x, std::uint32_t y);

/// XXH64 of all samples: rows top down, pixels left to right, channels in order, each little-endian.
std::uint64_t hash_samples(const PictureDesc& desc, const std::vector<ConstStridedChannel>& channels);

}  // namespace PIMG_ABI
}  // namespace pimg
