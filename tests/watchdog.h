// SPDX-License-Identifier: BSD-3-Clause
// Ends a test that hangs, with a message, long before the whole suite's time is over.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>

namespace pimg::test {

/// While one of these exists, the program must not take more than `seconds`; else it ends with status 1.
class Watchdog {
public:
    explicit Watchdog(const char* what, int seconds = 60)
        : m_thread([=] {
              std::unique_lock<std::mutex> lock(m_mutex);
              if (m_end.wait_for(lock, std::chrono::seconds(seconds), [&] { return m_over; }))
                  return;
              std::fprintf(stderr, "%s: not finished after %d seconds: deadlock\n", what, seconds);
              std::_Exit(1);
          })
    {
    }
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;
    ~Watchdog()
    {
        {
            std::lock_guard<std::mutex> lock(m_mutex);
            m_over = true;
        }
        m_end.notify_all();
        m_thread.join();
    }

private:
    std::mutex m_mutex;
    std::condition_variable m_end;
    bool m_over = false;
    std::thread m_thread;  ///< last: it uses the others
};

}  // namespace pimg::test
