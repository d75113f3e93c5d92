// SPDX-License-Identifier: BSD-3-Clause
// Ending long work before it is done, because nobody wants its result any more: a user moves on while a compositor renders.
// Whoever begins the work says in a StopScope how to find out; the work asks at its stop points, every few milliseconds.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What stop_point() throws.
class PIMG_EXPORT_DETAIL Stopped : public std::exception {
public:
    const char* what() const noexcept override { return "stopped"; }
};

/// While it lives, what is begun on this thread can be stopped. Only work in such a scope ever throws Stopped.
class PIMG_EXPORT_DETAIL StopScope {
public:
    /// goes_on() says whether the work goes on. It is called on this thread only, and not more often than every few
    /// milliseconds; after it has returned false it is not called again.
    explicit StopScope(std::function<bool()> goes_on);
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;
    ~StopScope();

    /// The scope that work on this thread belongs to; null if it cannot be stopped.
    static StopScope* current();

    /// Whether the work goes on. Other threads than the scope's own are told what goes_on() has said last.
    bool goes_on();

    bool stopped() const { return m_stopped.load(std::memory_order_relaxed); }

    /// Makes `scope`, which may be null, the current one of a thread that helps with its work.
    class Helper {
    public:
        explicit Helper(StopScope* scope);
        Helper(const Helper&) = delete;
        Helper& operator=(const Helper&) = delete;
        ~Helper();

    private:
        StopScope* m_before;
    };

private:
    const std::function<bool()> m_goes_on;
    const std::thread::id m_thread = std::this_thread::get_id();
    std::chrono::steady_clock::time_point m_asked;
    std::atomic<bool> m_stopped { false };
    Helper m_current;
};

/// Throws Stopped if the work on this thread is to stop. It costs some ten nanoseconds, and without a scope next to nothing:
/// loops call it for some thousand items at once. Between two calls there may be at most 10 milliseconds.
PIMG_EXPORT_DETAIL void stop_point();

/// Calls body(first, last) for the ranges of `step` numbers, from 0 on and the last one shorter, that together are those
/// below n; a stop point before each.
template<class Number, class Body>
void in_stages(Number n, Number step, Body&& body)
{
    for (Number first = 0; first < n;) {
        stop_point();
        const Number last = n - first > step ? first + step : n;
        body(first, last);
        first = last;
    }
}

/// Splits, vertices or pixels that are a few milliseconds' work, if each is nanoseconds'.
constexpr std::uint32_t kBetweenStops = 1 << 16;

/// Locks the mutex, for what may be locked for long; a stop point while it waits.
PIMG_EXPORT_DETAIL std::unique_lock<std::mutex> lock_or_stop(std::mutex& mutex);

}  // namespace PIMG_ABI
}  // namespace pimg
