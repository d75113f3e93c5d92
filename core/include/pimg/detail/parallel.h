// SPDX-License-Identifier: BSD-3-Clause
// Loops on a ParallelFor: over items, over batches of items too small to be tasks of their own, over rows.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>

#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Keeps the first exception of bodies that run at once, for the thread that waits for them.
class FirstException {
public:
    /// Runs body() unless one has thrown already.
    template<class Body>
    void guard(Body&& body)
    {
        if (m_thrown.load(std::memory_order_relaxed))
            return;
        try {
            body();
        } catch (...) {
            if (!m_thrown.exchange(true))
                m_exception = std::current_exception();
        }
    }

    /// To be called when no body runs any more.
    void rethrow() const
    {
        if (m_exception)
            std::rethrow_exception(m_exception);
    }

private:
    std::atomic<bool> m_thrown { false };
    std::exception_ptr m_exception;
};

/// Runs body(i) for every i below n; one after the other without `parallel`. When a body throws, no other is begun, and
/// the first exception is thrown again when all have ended, whatever `parallel` does about exceptions.
inline void run(const ParallelFor& parallel, std::size_t n, const std::function<void(std::size_t)>& body)
{
    if (!parallel || n <= 1) {
        for (std::size_t i = 0; i < n; ++i)
            body(i);
        return;
    }
    FirstException first;
    parallel(n, [&](std::size_t i) { first.guard([&] { body(i); }); });
    first.rethrow();
}

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

/// Calls body(y) for every y in [begin, end), several rows to a task.
template<class Body>
void for_rows(const ParallelFor& parallel, int begin, int end, Body&& body)
{
    constexpr int kRowsPerTask = 16;
    if (begin >= end)
        return;
    run(parallel, std::size_t((end - begin + kRowsPerTask - 1) / kRowsPerTask), [&](std::size_t task) {
        const int first = begin + int(task) * kRowsPerTask;
        for (int y = first; y < std::min(end, first + kRowsPerTask); ++y)
            body(y);
    });
}

}  // namespace PIMG_ABI
}  // namespace pimg
