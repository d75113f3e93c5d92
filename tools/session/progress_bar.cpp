// SPDX-License-Identifier: BSD-3-Clause
#include "session/progress_bar.h"

#include <algorithm>
#include <cstdio>

#include <unistd.h>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

namespace pimgtool {

namespace {

bool disabled = false;

}  // namespace

void ProgressBar::disable()
{
    disabled = true;
}

ProgressBar::ProgressBar(std::string label)
    : m_label(std::move(label)),
      m_terminal(!disabled && isatty(STDERR_FILENO) != 0),
      m_next(Clock::now() + std::chrono::seconds(1))
{
}

ProgressBar::~ProgressBar()
{
    if (m_shown != 0)
        std::fprintf(stderr, "\r%*s\r", int(m_shown), "");
}

void ProgressBar::show(float done)
{
    if (!m_terminal || Clock::now() < m_next)
        return;
    m_next = Clock::now() + std::chrono::milliseconds(100);
    constexpr std::size_t kWidth = 32;
    const float share = std::clamp(done, 0.0f, 1.0f);
    const std::size_t filled = std::size_t(share * float(kWidth));
    const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
    const std::string line = pimg::format("{} [{}] {:3.0f} %", m_label, bar, share * 100.0f);
    std::fprintf(stderr, "\r%s", line.c_str());
    std::fflush(stderr);
    m_shown = std::max(m_shown, line.size());
}

}  // namespace pimgtool
