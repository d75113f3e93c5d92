// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/stop.h>

#include <utility>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

using Clock = std::chrono::steady_clock;

/// Between two questions, which may cost the host a lock: a tenth of the 50 milliseconds in which compositors expect work
/// to end.
constexpr std::chrono::milliseconds kBetweenQuestions(5);

/// Between two attempts to lock; what is locked for long takes hundreds of them.
constexpr std::chrono::milliseconds kBetweenAttempts(1);

thread_local StopScope* current_scope = nullptr;

}  // namespace

StopScope::StopScope(std::function<bool()> goes_on) : m_goes_on(std::move(goes_on)), m_current(this) { }

StopScope::~StopScope() = default;

StopScope::Helper::Helper(StopScope* scope) : m_before(std::exchange(current_scope, scope)) { }

StopScope::Helper::~Helper()
{
    current_scope = m_before;
}

StopScope* StopScope::current()
{
    return current_scope;
}

bool StopScope::goes_on()
{
    if (!stopped() && std::this_thread::get_id() == m_thread) {
        const Clock::time_point now = Clock::now();
        if (now - m_asked >= kBetweenQuestions) {
            m_asked = now;
            if (!m_goes_on())
                m_stopped.store(true, std::memory_order_relaxed);
        }
    }
    return !stopped();
}

void stop_point()
{
    if (current_scope != nullptr && !current_scope->goes_on())
        throw Stopped();
}

std::unique_lock<std::mutex> lock_or_stop(std::mutex& mutex)
{
    if (current_scope == nullptr)
        return std::unique_lock<std::mutex>(mutex);
    std::unique_lock<std::mutex> lock(mutex, std::try_to_lock);
    while (!lock.owns_lock()) {
        stop_point();
        std::this_thread::sleep_for(kBetweenAttempts);
        lock = std::unique_lock<std::mutex>(mutex, std::try_to_lock);
    }
    return lock;
}

}  // namespace PIMG_ABI
}  // namespace pimg
