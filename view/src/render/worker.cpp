// SPDX-License-Identifier: BSD-3-Clause
#include "render/worker.h"

#include <utility>

namespace pimgview {

Worker::Worker() : m_thread([this] { run(); }) { }

Worker::~Worker()
{
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_next = nullptr;
        m_end = true;
        m_stop = true;
    }
    m_wake.notify_one();
    m_thread.join();
}

void Worker::post(Job job, bool at_once)
{
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_next = std::move(job);
        m_stop = m_stop || (at_once && m_busy);
    }
    m_wake.notify_one();
}

void Worker::cancel()
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_next = nullptr;
    m_stop = m_busy;
}

bool Worker::idle() const
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    return !m_busy && !m_next;
}

void Worker::run()
{
    std::unique_lock<std::mutex> lock(m_mutex);
    for (;;) {
        m_wake.wait(lock, [this] { return m_end || m_next; });
        if (m_end)
            return;
        const Job job = std::exchange(m_next, nullptr);
        m_busy = true;
        lock.unlock();
        job(m_stop);
        lock.lock();
        m_busy = false;
        if (!m_end)
            m_stop = false;
    }
}

}  // namespace pimgview
