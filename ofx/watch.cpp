// SPDX-License-Identifier: BSD-3-Clause
#include "watch.h"

namespace pimg_ofx {

namespace {

using Clock = std::chrono::steady_clock;

/// Work that takes less time shows no progress bar.
constexpr std::chrono::milliseconds kUnnoticed(500);

/// Between two shares shown, for hosts draw each of them.
constexpr std::chrono::milliseconds kBetweenShares(5);

}  // namespace

Watch::Watch(Instance& instance, const char* label, bool at_once)
    : m_instance(instance),
      m_label(label),
      m_at_once(at_once)
{
}

Watch::~Watch()
{
    if (!m_shows)
        return;
    m_instance.host().end_progress(m_instance.handle());
    m_instance.end_of_progress();
}

bool Watch::goes_on()
{
    m_stopped = m_stopped || m_instance.host().is_aborted(m_instance.handle());
    return !m_stopped;
}

bool Watch::goes_on(double done)
{
    const Clock::time_point now = Clock::now();
    if (m_stopped || now - m_shown < kBetweenShares)
        return !m_stopped;
    m_shown = now;
    const Host& host = m_instance.host();
    if (!m_shows && (m_at_once || now - m_begun > kUnnoticed) && m_instance.may_show_progress()) {
        m_shows = true;
        host.begin_progress(m_instance.handle(), m_label);
    }
    if (m_shows && !host.progress(m_instance.handle(), done))
        m_stopped = true;
    return goes_on();
}

}  // namespace pimg_ofx
