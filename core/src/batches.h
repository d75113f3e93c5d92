// SPDX-License-Identifier: BSD-3-Clause
// Parallel loops over items too small to be tasks of their own.
#pragma once

#include <algorithm>
#include <cstddef>

#include <pimg/types.h>

namespace pimg {

constexpr std::size_t kBatch = 1 << 14;

inline std::size_t batches_of(std::size_t n)
{
    return (n + kBatch - 1) / kBatch;
}

/// Calls visit(i) for every i below n, a batch of them to a task.
template<class Visit>
void in_batches(const ParallelFor& parallel, std::size_t n, Visit&& visit)
{
    run(parallel, batches_of(n), [&](std::size_t batch) {
        for (std::size_t i = batch * kBatch; i < std::min(n, (batch + 1) * kBatch); ++i)
            visit(i);
    });
}

}  // namespace pimg
