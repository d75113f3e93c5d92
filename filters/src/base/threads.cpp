// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/threads.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/parallel.h>

namespace pimg {

ParallelFor pool_loop(int nthreads)
{
    const int threads = nthreads > 0 ? nthreads : OIIO::get_int_attribute("threads", 1);
    if (threads <= 1)
        return {};
    return [threads](std::size_t n, const std::function<void(std::size_t)>& body) {
        // Each thread takes the next item until none is left: OpenImageIO's own chunks would keep
        // to the number of threads only when it chooses their size.
        std::atomic<std::size_t> next { 0 };
        std::mutex mutex;
        std::exception_ptr thrown;  // the pool would swallow it
        const auto worker = [&](std::int64_t, std::int64_t) {
            try {
                for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < n;)
                    body(i);
            } catch (...) {
                std::lock_guard<std::mutex> lock(mutex);
                thrown = std::current_exception();
                next = n;
            }
        };
        const std::int64_t workers = std::int64_t(std::min(std::size_t(threads), n));
        OIIO::parallel_for_chunked(std::int64_t(0), workers, 1, worker,
                                   OIIO::paropt(threads, OIIO::paropt::SplitDir::Y, 1));
        if (thrown)
            std::rethrow_exception(thrown);
    };
}

}  // namespace pimg
