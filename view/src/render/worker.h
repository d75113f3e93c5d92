// SPDX-License-Identifier: BSD-3-Clause
// A thread that does the newest job it was given.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace pimgview {

/// One job runs, and at most one waits; a newer job replaces the one that waits. A user who drags a slider asks for
/// more pictures than can be made, and only the last of them matters.
class Worker {
public:
    /// Jobs look at `stop` now and then, and end early when it is set. They do not throw.
    using Job = std::function<void(const std::atomic<bool>& stop)>;

    Worker();
    ~Worker();  ///< asks the running job to stop, and waits for it
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// `at_once`: the running job is asked to stop, as nobody wants its result any more.
    void post(Job job, bool at_once = false);

    /// Drops the job that waits and asks the running one to stop.
    void cancel();

    bool idle() const;

private:
    void run();

    mutable std::mutex m_mutex;
    std::condition_variable m_wake;
    Job m_next;
    bool m_busy = false, m_end = false;
    std::atomic<bool> m_stop { false };
    std::thread m_thread;
};

}  // namespace pimgview
