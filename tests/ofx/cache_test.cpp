// SPDX-License-Identifier: BSD-3-Clause
// The cache of the effects: bounded, what was used longest ago goes first, and nothing is made twice.
#include "cache.h"

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace pimg_ofx {
namespace {

class Thing : public Kept {
public:
    explicit Thing(std::size_t bytes) : m_bytes(bytes) { }
    std::size_t memory() const override { return m_bytes; }
    void grow(std::size_t bytes) { m_bytes = bytes; }

private:
    std::atomic<std::size_t> m_bytes;
};

bool goes_on()
{
    return false;  // not aborted
}

/// Whether the thing had to be made.
bool is_made(Cache& cache, const std::string& key, std::size_t bytes)
{
    bool made = false;
    std::string error;
    const auto make = [&](std::string&) {
        made = true;
        return std::make_shared<Thing>(bytes);
    };
    EXPECT_NE(cache.get(key, make, goes_on, error), nullptr);
    return made;
}

TEST(Cache, ForgetsWhatWasUsedLongestAgo)
{
    Cache cache(100);
    EXPECT_TRUE(is_made(cache, "a", 40));
    EXPECT_TRUE(is_made(cache, "b", 40));
    EXPECT_FALSE(is_made(cache, "a", 40));
    EXPECT_TRUE(is_made(cache, "c", 40));
    EXPECT_EQ(cache.memory(), 80u);
    EXPECT_FALSE(is_made(cache, "a", 40));
    EXPECT_TRUE(is_made(cache, "b", 40));
}

TEST(Cache, NeverHoldsMoreThanItsLimitButForTheNewest)
{
    Cache cache(1000);
    for (int i = 0; i < 500; ++i) {
        is_made(cache, std::to_string(i % 37), std::size_t(1 + i * 7 % 400));
        EXPECT_LE(cache.memory(), 1000u);
    }
    EXPECT_TRUE(is_made(cache, "large", 5000));
    EXPECT_EQ(cache.memory(), 5000u);
    EXPECT_FALSE(is_made(cache, "large", 5000));
    is_made(cache, "small", 1);
    EXPECT_EQ(cache.memory(), 1u);
}

TEST(Cache, MeasuresWhatHasGrown)
{
    Cache cache(100);
    std::string error;
    const auto thing = std::make_shared<Thing>(10);
    cache.get(
        "grows", [&](std::string&) { return thing; }, goes_on, error);
    is_made(cache, "other", 50);
    thing->grow(90);
    cache.measure("grows");
    EXPECT_LE(cache.memory(), 100u);
    cache.measure("unknown");
}

TEST(Cache, IsEmptyAfterAPurge)
{
    Cache cache(100);
    is_made(cache, "a", 40);
    cache.clear();
    EXPECT_EQ(cache.memory(), 0u);
    EXPECT_TRUE(is_made(cache, "a", 40));
}

TEST(Cache, KeepsNothingThatFailed)
{
    Cache cache(100);
    std::string error;
    const auto fails = [](std::string& why) {
        why = "cannot";
        return std::shared_ptr<const Kept>();
    };
    EXPECT_EQ(cache.get("a", fails, goes_on, error), nullptr);
    EXPECT_EQ(error, "cannot");
    const auto throws = [](std::string&) -> std::shared_ptr<const Kept> {
        throw std::runtime_error("thrown");
    };
    EXPECT_THROW(cache.get("a", throws, goes_on, error), std::runtime_error);
    EXPECT_TRUE(is_made(cache, "a", 1));
}

TEST(Cache, MakesAThingOnceForManyThreads)
{
    Cache cache(100);
    std::atomic<int> makes { 0 };
    std::vector<std::thread> threads;
    threads.reserve(8);
    for (int t = 0; t < 8; ++t)
        threads.emplace_back([&] {
            std::string error;
            const auto make = [&](std::string&) {
                ++makes;
                std::this_thread::sleep_for(std::chrono::milliseconds(30));
                return std::make_shared<Thing>(1);
            };
            EXPECT_NE(cache.get("a", make, goes_on, error), nullptr);
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(makes, 1);
}

TEST(Cache, WaitsNoLongerThanTheHostWants)
{
    Cache cache(100);
    std::atomic<bool> begun { false }, over { false };
    std::thread maker([&] {
        std::string error;
        const auto make = [&](std::string&) {
            begun = true;
            while (!over)
                std::this_thread::yield();
            return std::make_shared<Thing>(1);
        };
        cache.get("a", make, goes_on, error);
    });
    while (!begun)
        std::this_thread::yield();
    std::string error;
    EXPECT_EQ(cache.get(
                  "a", [](std::string&) { return nullptr; }, [] { return true; }, error),
              nullptr);
    over = true;
    maker.join();
}

}  // namespace
}  // namespace pimg_ofx
