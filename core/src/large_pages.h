// SPDX-License-Identifier: BSD-3-Clause
// Large pages where the system gives them on request: with small ones a tenth of building a large picture goes into
// page faults and address look-ups.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pimg {

/// To be called before the memory is touched.
inline void advise_large_pages([[maybe_unused]] void* block, [[maybe_unused]] std::size_t bytes)
{
#ifdef __linux__
    constexpr std::uintptr_t kPage = 4096, kWorthIt = 4 << 20;
    const std::uintptr_t first = (reinterpret_cast<std::uintptr_t>(block) + kPage - 1) / kPage * kPage;
    const std::uintptr_t last = (reinterpret_cast<std::uintptr_t>(block) + bytes) / kPage * kPage;
    if (last > first + kWorthIt)
        madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

/// v.resize(n) for an empty vector that will be large.
template<class T>
void resize_on_large_pages(std::vector<T>& v, std::size_t n)
{
    v.reserve(n);
    advise_large_pages(v.data(), n * sizeof(T));
    v.resize(n);
}

}  // namespace pimg
