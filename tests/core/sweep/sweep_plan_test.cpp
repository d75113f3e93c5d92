// SPDX-License-Identifier: BSD-3-Clause
// A plan must give what plain sweeps give, bit for bit, whatever the hierarchy and the number of threads.
#include <pimg/detail/sweep_plan.h>

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include <pimg/detail/parallel.h>
#include <pimg/sampling.h>
#include <pimg/simplify.h>

#include "core/pictures.h"
#include "core/threads.h"

namespace pimg {
namespace {

/// A detail that depends on its split and on nothing else, as a filter's do.
Detail with_gain(Detail d)
{
    return { 0.5f * d.t, d.u > 0.0f ? 0.25f * d.u : d.u };
}

std::vector<float> by_plan(const SweepPlan& plan, const Hierarchy& h, const Bands& bands, const ParallelFor& parallel)
{
    const std::vector<Detail> details = plan.in_order(bands.details, parallel);
    std::vector<float> values(plan.places()), samples(h.mesh_pixels());
    plan.set_base(bands.base, 1.0f, values.data());
    plan.for_splits(parallel, [&](Level first, Level last) {
        plan.sweep(first, last, values.data(), [&](Level i) { return with_gain(details[i]); });
    });
    plan.scatter(h, values.data(), samples.data(), parallel);
    return samples;
}

std::vector<float> plainly(const Hierarchy& h, const Bands& bands)
{
    std::vector<float> values(h.vertices()), samples(h.mesh_pixels());
    sweep(h, bands, values.data(), h.levels(), [](Level, Detail d) { return with_gain(d); });
    scatter(h, values.data(), samples.data());
    return samples;
}

void expect_same(const Hierarchy& h, const Bands& bands, const std::string& name)
{
    const std::vector<float> expected = plainly(h, bands);
    EXPECT_EQ(by_plan(SweepPlan::unplanned(h), h, bands, {}), expected) << name;
    EXPECT_EQ(by_plan(SweepPlan(h), h, bands, {}), expected) << name;
    for (const unsigned count : { 1u, 2u, 3u, 8u }) {
        const ParallelFor parallel = test::threads(count);
        EXPECT_EQ(by_plan(SweepPlan(h, parallel), h, bands, parallel), expected) << name << ", " << count << " threads";
    }
}

TEST(SweepPlan, GivesTheSweepOfEveryPicture)
{
    std::vector<test::Picture> pictures = test::awkward_pictures();
    pictures.push_back(test::scene(333, 258));  // many tiles, none whole at the right and the bottom, and many stages
    pictures.push_back(test::scene(64, 900));
    pictures.push_back(test::scene(12000, 3));  // too thin for tiles
    for (const test::Picture& p : pictures) {
        Hierarchy h;
        std::vector<Bands> bands;
        ASSERT_TRUE(simplify({ p.width, p.height, { { p.samples.data() } } }, {}, h, bands).ok()) << p.name;
        expect_same(h, bands[0], p.name);
    }
}

TEST(SweepPlan, GivesThePixelsBetweenVertices)
{
    const test::Picture p = test::scene(300, 280);
    const Guide guide { p.width, p.height, { { p.samples.data() } } };
    SimplifyOptions options;
    ASSERT_TRUE(sample(guide, {}, options.start).ok());
    Hierarchy h;
    std::vector<Bands> bands;
    ASSERT_TRUE(simplify(guide, options, h, bands).ok());
    ASSERT_FALSE(h.between.empty());
    expect_same(h, bands[0], "adaptive");
}

/// Splits that depend on the one before and are all in another tile need a stage each: more than a plan has.
TEST(SweepPlan, EndsInOneStageIfThereAreTooMany)
{
    Hierarchy h;
    h.width = 128, h.height = 256;
    h.base_points.resize(3);
    h.splits.resize(h.mesh_pixels() - 3);
    Bands bands { { 1.0f, 2.0f, 3.0f }, {}, {} };
    for (Index v = 0; v < Index(h.mesh_pixels()); ++v)  // left and right half in turn
        h.pixels.push_back((v / 2) / 64 * 128 + (v / 2) % 64 + (v % 2) * 64);
    for (Index u = 3; u < Index(h.mesh_pixels()); ++u) {
        h.stencils.push_back({ u - 1, u - 2, u - 3, u - 3, u - 2, 0.25f, 0.5f, 0.125f, 0.25f });
        bands.details.push_back({ test::noise(u, 1), test::noise(u, 2) });
    }
    expect_same(h, bands, "chain");
}

Hierarchy hierarchy_of_scene()
{
    const test::Picture p = test::scene(333, 258);
    Hierarchy h;
    std::vector<Bands> bands;
    EXPECT_TRUE(simplify({ p.width, p.height, { { p.samples.data() } } }, {}, h, bands).ok());
    return h;
}

TEST(SweepPlan, CallsEverySplitOnce)
{
    const Hierarchy h = hierarchy_of_scene();
    const SweepPlan plan(h);
    ASSERT_EQ(plan.levels(), h.levels());
    std::vector<int> calls(plan.levels());
    std::size_t ranges = 0;
    plan.for_splits({}, [&](Level first, Level last) {
        ++ranges;
        for (Level i = first; i < last; ++i)
            ++calls[i];
    });
    EXPECT_EQ(calls, std::vector<int>(plan.levels(), 1));
    EXPECT_GT(ranges, 4u);  // something to share
    EXPECT_LT(ranges, plan.levels() / 100);
    EXPECT_LE(plan.memory(), 45 * h.mesh_pixels());
}

TEST(SweepPlan, EndsWhenABodyThrows)
{
    const Hierarchy h = hierarchy_of_scene();
    const SweepPlan plan(h);
    // The first range is waited for by all others, the last by none.
    for (Level thrower : { Level(0), plan.levels() / 2, plan.levels() - 1 })
        for (const ParallelFor& parallel : { ParallelFor(), test::threads(4) })
            EXPECT_THROW(plan.for_splits(parallel,
                                         [&](Level first, Level last) {
                                             if (first <= thrower && thrower < last)
                                                 throw std::runtime_error("body");
                                         }),
                         std::runtime_error)
                << thrower;
}

TEST(ParallelFor, ThrowsTheFirstExceptionWhenAllHaveStopped)
{
    // test::threads() itself would end the program if a body threw.
    for (const ParallelFor& parallel : { ParallelFor(), test::threads(4) }) {
        std::atomic<int> begun { 0 }, ended { 0 };
        const auto body = [&](std::size_t i) {
            ++begun;
            if (i == 37) {
                ++ended;
                throw std::runtime_error("body");
            }
            ++ended;
        };
        EXPECT_THROW(run(parallel, 100, body), std::runtime_error);
        EXPECT_GE(begun, 1);
        EXPECT_EQ(begun, ended);
    }
}

}  // namespace
}  // namespace pimg
