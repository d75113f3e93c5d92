// SPDX-License-Identifier: BSD-3-Clause
// Work that is stopped: who is asked, how often, and what happens to those who help.
#include <pimg/detail/stop.h>

#include <future>

#include <gtest/gtest.h>

namespace pimg {
namespace {

using std::chrono::milliseconds;

/// Passes stop points for some time; false if one of them throws.
bool works_for(milliseconds time)
{
    const auto end = std::chrono::steady_clock::now() + time;
    try {
        while (std::chrono::steady_clock::now() < end)
            stop_point();
    } catch (const Stopped&) {
        return false;
    }
    return true;
}

TEST(Stop, NothingStopsWithoutAScope)
{
    EXPECT_EQ(StopScope::current(), nullptr);
    EXPECT_NO_THROW(stop_point());
}

TEST(Stop, WorkEndsWhenItIsNotToGoOn)
{
    int asked = 0;
    {
        const StopScope scope([&] { return ++asked < 3; });
        EXPECT_FALSE(works_for(milliseconds(1000)));
        EXPECT_TRUE(scope.stopped());
        EXPECT_THROW(stop_point(), Stopped);  // and goes on ending
    }
    EXPECT_EQ(asked, 3);  // but who said no is not asked again
    EXPECT_NO_THROW(stop_point());
}

TEST(Stop, QuestionsAreRare)
{
    int asked = 0;
    const StopScope scope([&] { return ++asked > 0; });
    EXPECT_TRUE(works_for(milliseconds(50)));
    EXPECT_GE(asked, 1);
    EXPECT_LE(asked, 11);
}

TEST(Stop, TheInnerScopeCounts)
{
    const StopScope outer([] { return false; });
    {
        const StopScope inner([] { return true; });
        EXPECT_TRUE(works_for(milliseconds(20)));
    }
    EXPECT_FALSE(works_for(milliseconds(1000)));
}

TEST(Stop, HelpersAreToldAndNeverAsk)
{
    const std::thread::id own = std::this_thread::get_id();
    bool asked_elsewhere = false;
    StopScope scope([&] {
        asked_elsewhere = asked_elsewhere || std::this_thread::get_id() != own;
        return false;
    });
    std::promise<void> asked;
    auto helping = std::async(std::launch::async, [&, ready = asked.get_future()] {
        const StopScope::Helper helper(&scope);
        const bool before = works_for(milliseconds(20));
        ready.wait();
        return before && !works_for(milliseconds(1000));
    });
    std::this_thread::sleep_for(milliseconds(40));
    EXPECT_FALSE(scope.goes_on());
    asked.set_value();
    EXPECT_TRUE(helping.get());
    EXPECT_FALSE(asked_elsewhere);
}

TEST(Stop, WaitingForALockEnds)
{
    std::mutex mutex;
    const std::unique_lock<std::mutex> held(mutex);
    auto waiting = std::async(std::launch::async, [&] {
        const StopScope scope([] { return false; });
        EXPECT_THROW(lock_or_stop(mutex), Stopped);
    });
    EXPECT_EQ(waiting.wait_for(std::chrono::seconds(10)), std::future_status::ready);
    auto patient = std::async(std::launch::async, [] {
        std::mutex free;
        const StopScope scope([] { return true; });
        return lock_or_stop(free).owns_lock();
    });
    EXPECT_TRUE(patient.get());
}

}  // namespace
}  // namespace pimg
