// SPDX-License-Identifier: BSD-3-Clause
// A stable sort by costs, for many threads.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include <pimg/detail/flat_array.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// An index and the bits of a float that is not negative, which are ordered like the floats.
struct KeyedIndex {
    std::uint32_t key;
    Index index;

    KeyedIndex(float cost, Index of) : key(), index(of) { std::memcpy(&key, &cost, sizeof key); }
};

/// The indices by increasing key; those of equal keys stay in the order of `items`.
std::vector<Index> sorted(FlatArray<KeyedIndex>&& items, const ParallelFor& parallel);

}  // namespace PIMG_ABI
}  // namespace pimg
