// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

namespace pimgtool {

/// A line on the terminal for work that takes over a second; nothing at all when standard error goes
/// elsewhere. The line is wiped when the work ends, so that what follows starts on a clean one.
class ProgressBar {
public:
    explicit ProgressBar(std::string label);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// From now on no bar is shown: the lines of several frames at a time would overwrite each other.
    static void disable();

    /// Shows the share done, 0..1.
    void show(float done);

private:
    using Clock = std::chrono::steady_clock;

    std::string m_label;
    bool m_terminal;
    std::size_t m_shown = 0;  ///< characters on the line
    Clock::time_point m_next;
};

}  // namespace pimgtool
