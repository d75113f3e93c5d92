// SPDX-License-Identifier: BSD-3-Clause
// Long work of an action as the user sees it: whether it is to stop, and how far it is.
#pragma once

#include <chrono>

#include "instance.h"

namespace pimg_ofx {

/// Lives on the thread of the action, which alone may ask the host. A bar is closed when this ends.
class Watch {
public:
    /// `label` is that of the bar, which appears if work takes long, or with the first share of it if `at_once`.
    Watch(Instance& instance, const char* label, bool at_once = false);
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;
    ~Watch();

    /// Asks the host; false if the work is to stop.
    bool goes_on();

    /// The same, and shows the share of the work that is done.
    bool goes_on(double done);

    bool stopped() const { return m_stopped; }

private:
    Instance& m_instance;
    const char* const m_label;
    const bool m_at_once;
    const std::chrono::steady_clock::time_point m_begun = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point m_shown {};
    bool m_shows = false, m_stopped = false;
};

}  // namespace pimg_ofx
