// SPDX-License-Identifier: BSD-3-Clause
// Loops on OpenImageIO's pool: every item once, exceptions, and no deadlock when filters of one image are called from
// threads of the program and from tasks of the pool at the same time.
#include <pimg/threads.h>

#include <atomic>
#include <future>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <OpenImageIO/parallel.h>
#include <OpenImageIO/thread.h>

#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>
#include <pimg/imagebufalgo.h>
#include <pimg/labels.h>

#include "filters/pictures.h"
#include "watchdog.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;

/// Resizes the pool, which on a machine of two processors has one thread, for one test.
class PoolOf {
public:
    explicit PoolOf(int threads) : m_before(OIIO::default_thread_pool()->size())
    {
        OIIO::default_thread_pool()->resize(threads);
    }
    ~PoolOf() { OIIO::default_thread_pool()->resize(m_before); }

private:
    int m_before;
};

TEST(PoolLoop, CallsTheBodyOnceForEveryItem)
{
    const PoolOf pool(4);
    for (const int threads : { 0, 1, 2, 8, 100 })
        for (const std::size_t n : { 0u, 1u, 2u, 3u, 1000u }) {
            std::vector<std::atomic<int>> calls(n);
            run(pool_loop(threads), n, [&](std::size_t i) { ++calls[i]; });
            for (const std::atomic<int>& count : calls)
                EXPECT_EQ(count, 1) << threads << " threads, " << n << " items";
        }
}

TEST(PoolLoop, ThrowsWhatABodyThrows)
{
    const Watchdog watchdog("a loop that throws");
    const PoolOf pool(4);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const auto body = [](std::size_t i) {
            if (i == 50)
                throw std::runtime_error("fifty");
        };
        EXPECT_THROW(pool_loop(4)(100, body), std::runtime_error);
        EXPECT_THROW(run_without_foreign_tasks([] { throw std::runtime_error("within"); }), std::runtime_error);
    }
    // Still parallel afterwards: OpenImageIO counts how deeply its loops are nested. It would also stay on one thread
    // with a long queue, so that must be empty.
    while (OIIO::default_thread_pool()->jobs_in_queue() > 0)
        std::this_thread::yield();
    std::atomic<int> met { 0 };
    OIIO::parallel_for_chunked(
        std::int64_t(0), std::int64_t(2), 1,
        [&](std::int64_t, std::int64_t) {
            ++met;
            while (met < 2)
                std::this_thread::yield();
        },
        OIIO::paropt(2, OIIO::paropt::SplitDir::Y, 1));
}

TEST(PoolLoop, NeedsNoThreadOfThePool)
{
    const Watchdog watchdog("a loop beside a blocked pool");
    const PoolOf pool(1);
    std::promise<void> promise;
    const std::shared_future<void> release = promise.get_future().share();
    const auto blocked = OIIO::default_thread_pool()->push([release](int) { release.wait(); });
    std::atomic<int> sum { 0 };
    pool_loop(4)(100, [&](std::size_t i) { sum += int(i); });
    EXPECT_EQ(sum, 4950);
    promise.set_value();
    blocked.wait();
}

/// What OpenImageIO's own loops do: a foreign task on a thread that waits. Ours must not, even with a lock held.
TEST(PoolLoop, TakesUpNoForeignTask)
{
    const Watchdog watchdog("a loop under a lock that foreign tasks ask for");
    const PoolOf pool(2);
    std::mutex mutex;
    for (int repeat = 0; repeat < 200; ++repeat) {
        std::vector<std::future<void>> foreign;
        {
            std::lock_guard<std::mutex> lock(mutex);
            for (int i = 0; i < 6; ++i)
                foreign.push_back(
                    OIIO::default_thread_pool()->push([&](int) { std::lock_guard<std::mutex> f(mutex); }));
            std::atomic<int> sum { 0 };
            pool_loop(4)(64, [&](std::size_t i) { sum += int(i); });
            EXPECT_EQ(sum, 2016);
            const auto here = std::this_thread::get_id();
            run_without_foreign_tasks([&] {
                const auto item = [&](std::int64_t, std::int64_t) {
                    EXPECT_EQ(std::this_thread::get_id(), here);
                };
                OIIO::parallel_for_chunked(std::int64_t(0), std::int64_t(16), 1, item,
                                           OIIO::paropt(4, OIIO::paropt::SplitDir::Y, 1));
            });
        }
        for (std::future<void>& task : foreign)
            task.wait();
    }
}

constexpr int kFiltered = 6;

/// The caches each of these fills: log bands and plans, channel bands, smoothing data, the tree of regions, what painters
/// plan by, envelopes.
ImageBuf filtered(const ProgressiveImage& image, int which, int threads)
{
    switch (which % kFiltered) {
    case 0:
        return ImageBufAlgo::hdr_compress(image, {}, {}, threads);
    case 1: {
        FeatureLowpassOptions options;
        options.fraction = 0.2f;
        return ImageBufAlgo::feature_lowpass(image, options, {}, threads);
    }
    case 2: {
        DetailEnhanceOptions options;
        options.strength = 0.05f;
        return ImageBufAlgo::detail_enhance(image, options, {}, threads);
    }
    case 3:
        return ImageBufAlgo::segment(image, {}, {}, threads);
    case 4:
        return ImageBufAlgo::paint(image, {}, {}, threads);
    default: {
        HdrCompressOptions options;
        options.coherence = 0.5f;
        options.beta = 0.5f;
        return ImageBufAlgo::hdr_compress(image, options, {}, threads);
    }
    }
}

/// The worst moment: no thread of the pool is free, and tasks that filter the same image come into its queue all the
/// time, also while a filter has the lock of the image's caches and starts a loop.
TEST(ProgressiveImage, FilterNeedsNoneOfTheTasksInTheQueue)
{
    const Watchdog watchdog("a filter whose image is asked for by tasks in the queue", 100);
    const PoolOf pool(2);
    OIIO::thread_pool* const tasks = OIIO::default_thread_pool();
    const ImageBuf scene = hdr_scene(120, 90);
    for (int which = 0; which < kFiltered; ++which) {
        ProgressiveImage image;
        ASSERT_TRUE(image.build(scene, {}, 1)) << image.error();
        std::promise<void> promise;
        const std::shared_future<void> release = promise.get_future().share();
        std::atomic<int> blocked { 0 };
        std::vector<std::future<void>> waiting;
        waiting.reserve(2);
        for (int i = 0; i < 2; ++i)
            waiting.push_back(tasks->push([&, release](int) {
                ++blocked;
                release.wait();
            }));
        while (blocked < 2)
            std::this_thread::yield();
        std::atomic<bool> over { false };
        std::thread feeder([&] {
            while (!over) {
                if (tasks->jobs_in_queue() < 4)
                    waiting.push_back(tasks->push([&](int) { filtered(image, which, 4); }));
                std::this_thread::sleep_for(std::chrono::microseconds(100));
            }
        });
        const ImageBuf result = filtered(image, which, 4);
        EXPECT_FALSE(result.has_error()) << result.geterror();
        over = true;
        feeder.join();
        promise.set_value();
        for (std::future<void>& task : waiting)
            task.wait();
    }
}

TEST(ProgressiveImage, FiltersInTasksAndThreadsDoNotWaitForEachOther)
{
    const Watchdog watchdog("filters of one image in threads and in tasks of the pool", 100);
    const PoolOf pool(3);
    const ImageBuf scene = hdr_scene(120, 90);
    std::vector<std::vector<float>> expected;
    {
        ProgressiveImage image;
        ASSERT_TRUE(image.build(scene)) << image.error();
        for (int which = 0; which < kFiltered; ++which)
            expected.push_back(pixels(filtered(image, which, 1)));
    }
    for (int repeat = 0; repeat < 10; ++repeat) {
        ProgressiveImage image;  // with empty caches
        ASSERT_TRUE(image.build(scene)) << image.error();
        std::atomic<int> wrong { 0 };
        const auto check = [&](int which, int threads) {
            if (!identical(pixels(filtered(image, which, threads)), expected[std::size_t(which % kFiltered)]))
                ++wrong;
        };
        std::vector<std::thread> threads;
        threads.reserve(8);
        for (int t = 0; t < 8; ++t)
            threads.emplace_back([&, t] {
                // No more: OpenImageIO's loops would leave the pool alone if its queue were long.
                std::future<void> task = OIIO::default_thread_pool()->push([&, t](int) { check(t + repeat + 1, 4); });
                check(t + repeat, 4);
                if (t % 4 == 0) {
                    ProgressiveImage rebuilt;
                    if (!rebuilt.build(scene, {}, 4))
                        ++wrong;
                }
                task.wait();
            });
        for (std::thread& thread : threads)
            thread.join();
        EXPECT_EQ(wrong, 0);
    }
}

TEST(PoolLoop, StopsOnEveryThread)
{
    const Watchdog watchdog("a loop that is stopped");
    const PoolOf pool(4);
    const std::thread::id own = std::this_thread::get_id();
    for (const int threads : { 1, 4 }) {
        std::atomic<int> calls { 0 };
        const StopScope scope([&] {
            EXPECT_EQ(std::this_thread::get_id(), own);
            return calls < 20;
        });
        // The first items take for ever, on whatever thread they are.
        const auto body = [&](std::size_t) {
            ++calls;
            for (;;) {
                stop_point();
                if (calls < 20)
                    return;
                std::this_thread::yield();
            }
        };
        EXPECT_THROW(run(pool_loop(threads), 1000, body), Stopped);
        EXPECT_LT(calls, 30);
    }
}

/// Stopped at the first question, at the second and so on, until nobody asks any more.
TEST(ProgressiveImage, BuildsAndFiltersStop)
{
    const Watchdog watchdog("builds and filters that are stopped", 100);
    const ImageBuf scene = hdr_scene(120, 90);
    int most = 0;
    for (int which = 0; which < kFiltered; ++which) {
        ProgressiveImage whole;
        ASSERT_TRUE(whole.build(scene)) << whole.error();
        const std::vector<float> expected = pixels(filtered(whole, which, 2));
        for (int moment = 0;; ++moment) {
            int asked = 0;
            const StopScope scope([&] { return asked++ < moment; });
            ProgressiveImage image;
            ImageBuf result;
            if (image.build(scene))
                result = filtered(image, which, 2);
            most = std::max(most, asked);
            if (!scope.stopped()) {
                EXPECT_TRUE(identical(pixels(result), expected));
                break;
            }
            EXPECT_EQ(image.initialized() ? result.geterror() : image.error(), "stopped");
        }
    }
    EXPECT_GT(most, 1);
}

}  // namespace
}  // namespace pimg
