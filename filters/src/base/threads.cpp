// SPDX-License-Identifier: BSD-3-Clause
// Why these loops do not use OpenImageIO's own parallel_for: a thread that waits there for its loop takes up any task
// from the pool's queue, also one that has nothing to do with the loop. Callers of pool_loop() may hold a lock, for
// example that of a progressive image's caches; a foreign task that asks for the same lock on the same thread would
// wait for ever. So here the calling thread does only its own work, and at the end waits only for those pool threads
// that have already begun to help: these are busy with bodies of this loop and nothing else.
#include <pimg/threads.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/parallel.h>
#include <OpenImageIO/thread.h>

#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// A loop asks the pool for helpers. Those that start after the loop has ended have nothing to do, but stay in the
/// pool's queue until one of its threads takes them out, which may be long if all of them are busy. No helpers are
/// asked for while the queue is longer than this. It is far above what loops that follow each other leave behind (a few
/// per loop), and costs about 50 kB at most.
constexpr std::size_t kLongestQueue = 256;

/// How often a caller who has nothing to do but wait asks whether the work is to stop.
constexpr std::chrono::milliseconds kBetweenQuestions(5);

/// One loop, shared by the calling thread and the pool threads that help it. A helper may be started by the pool long
/// after the loop has ended; it then finds the loop closed and leaves. So the loop outlives its caller, but `body`,
/// which belongs to the caller, is used only by helpers that joined before close() returned.
class SharedLoop {
public:
    SharedLoop(std::size_t n, const std::function<void(std::size_t)>& body) : m_n(n), m_body(&body) { }

    /// Takes the next item until none is left.
    void work()
    {
        for (std::size_t i; (i = m_next.fetch_add(1, std::memory_order_relaxed)) < m_n;)
            m_first.guard([&] {
                stop_point();
                (*m_body)(i);
            });
    }

    /// What a pool thread does.
    void help()
    {
        {
            std::lock_guard<std::mutex> lock(m_mutex);
            if (m_closed)
                return;
            ++m_helping;
        }
        {
            const StopScope::Helper helper(m_stop);
            work();
        }
        std::lock_guard<std::mutex> lock(m_mutex);
        if (--m_helping == 0)
            m_idle.notify_all();
    }

    /// Waits for the helpers that have joined, lets no other join, and throws what a body has thrown.
    void close()
    {
        // Helpers usually end within microseconds of each other, which is less than going to sleep costs.
        constexpr int kYields = 256;
        for (int i = 0; i < kYields && m_helping.load(std::memory_order_relaxed) > 0; ++i)
            std::this_thread::yield();
        std::unique_lock<std::mutex> lock(m_mutex);
        m_closed = true;
        if (m_stop == nullptr)
            m_idle.wait(lock, [&] { return m_helping == 0; });
        while (m_helping != 0) {
            m_idle.wait_until(lock, std::chrono::system_clock::now() + kBetweenQuestions);
            m_stop->goes_on();  // if not, the helpers are told at their next stop point
        }
        m_first.rethrow();
    }

private:
    const std::size_t m_n;
    const std::function<void(std::size_t)>* m_body;
    StopScope* const m_stop = StopScope::current();  ///< the caller's, like m_body
    std::atomic<std::size_t> m_next { 0 };
    std::atomic<int> m_helping { 0 };  ///< changed under the mutex
    std::mutex m_mutex;
    std::condition_variable m_idle;
    bool m_closed = false;
    FirstException m_first;
};

}  // namespace

ParallelFor pool_loop(int nthreads)
{
    const int threads = nthreads > 0 ? nthreads : OIIO::get_int_attribute("threads", 1);
    if (threads <= 1 && StopScope::current() == nullptr)
        return {};
    return [threads](std::size_t n, const std::function<void(std::size_t)>& body) {
        OIIO::thread_pool* const pool = OIIO::default_thread_pool();
        const auto loop = std::make_shared<SharedLoop>(n, body);
        // Within a task of the pool one thread does the loop, as in OpenImageIO.
        const std::size_t wanted = pool->is_worker() ? 1 : std::min(std::size_t(threads), n);
        for (std::size_t t = 1; t < wanted && pool->jobs_in_queue() < kLongestQueue; ++t)
            pool->push([loop](int) { loop->help(); });
        loop->work();
        loop->close();
    };
}

void run_without_foreign_tasks(const std::function<void()>& body)
{
    // OpenImageIO's loops stay on their thread when they are called from within one of its loops, even one of a single
    // item on the calling thread. An exception must not pass through it, or its count of nested loops would stay wrong.
    FirstException first;
    OIIO::parallel_for_chunked(
        std::int64_t(0), std::int64_t(1), 1, [&](std::int64_t, std::int64_t) { first.guard(body); },
        OIIO::paropt(1, OIIO::paropt::SplitDir::Y, 1));
    first.rethrow();
}

}  // namespace PIMG_ABI
}  // namespace pimg
