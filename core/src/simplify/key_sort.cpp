// SPDX-License-Identifier: BSD-3-Clause
#include "simplify/key_sort.h"

#include <utility>

#include <pimg/detail/parallel.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// One pass of a radix sort by many threads: parts of `from` are counted, then moved behind each other into `to`. False if
/// all have the same bits, so that nothing was moved.
bool move_by_bits(const FlatArray<KeyedIndex>& from, int shift, int bits, const ParallelFor& parallel,
                  FlatArray<KeyedIndex>& to)
{
    constexpr std::size_t kParts = 16;
    const std::size_t n = from.size(), buckets = std::size_t(1) << bits;
    std::vector<std::vector<std::size_t>> place(kParts);
    const auto for_part = [&](std::size_t part, const auto& visit) {
        for (std::size_t i = n * part / kParts; i < n * (part + 1) / kParts; ++i)
            visit(from[i], place[part][(from[i].key >> shift) & (buckets - 1)]);
    };
    run(parallel, kParts, [&](std::size_t part) {
        place[part].resize(buckets);
        for_part(part, [](const KeyedIndex&, std::size_t& count) { ++count; });
    });
    std::size_t next = 0;
    for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
        const std::size_t before = next;
        for (std::vector<std::size_t>& counts : place)
            next += std::exchange(counts[bucket], next);
        if (next - before == n)
            return false;
    }
    run(parallel, kParts,
        [&](std::size_t part) { for_part(part, [&](const KeyedIndex& item, std::size_t& at) { to[at++] = item; }); });
    return true;
}

}  // namespace

std::vector<Index> sorted(FlatArray<KeyedIndex>&& items, const ParallelFor& parallel)
{
    constexpr int kBits = 11, kPasses = 3;  // for the 32 bits of a float; tables of 2^11 stay in the cache
    FlatArray<KeyedIndex> from = std::move(items), to;
    to.extend(from.size());
    for (int pass = 0; pass < kPasses; ++pass)
        if (move_by_bits(from, pass * kBits, kBits, parallel, to))
            std::swap(from, to);
    std::vector<Index> by_key(from.size());
    in_batches(parallel, from.size(), [&](std::size_t i) { by_key[i] = from[i].index; });
    return by_key;
}

}  // namespace PIMG_ABI
}  // namespace pimg
