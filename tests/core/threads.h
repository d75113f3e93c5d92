// SPDX-License-Identifier: BSD-3-Clause
// Threads that hand out the work in an order of their own.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include <pimg/types.h>

namespace pimg::test {

inline ParallelFor threads(unsigned count)
{
    return [count](std::size_t n, const std::function<void(std::size_t)>& body) {
        std::atomic<std::size_t> next { 0 };
        std::vector<std::thread> pool;
        for (unsigned t = 0; t < count; ++t)
            pool.emplace_back([&] {
                for (std::size_t i = next++; i < n; i = next++)
                    body(n - 1 - i);
            });
        for (std::thread& t : pool)
            t.join();
    };
}

}  // namespace pimg::test
