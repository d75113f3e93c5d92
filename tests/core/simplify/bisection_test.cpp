// SPDX-License-Identifier: BSD-3-Clause
// The first stage of building, seen through simplify().
#include <pimg/simplify.h>

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include <pimg/rasterize.h>

#include "core/pictures.h"
#include "core/threads.h"

namespace pimg {
namespace {

using test::Picture;

constexpr float kLimit = 32.0f;  ///< of a pixel that is two units from the mean of its neighbours

struct Built {
    Hierarchy hierarchy;
    std::vector<Bands> bands;
    SimplifyStats stats;
};

Built build(const Guide& guide, float bisection, const ParallelFor& parallel = {})
{
    Built b;
    SimplifyOptions options;
    options.bisection = bisection;
    options.parallel = parallel;
    const Status s = simplify(guide, options, b.hierarchy, b.bands, &b.stats);
    EXPECT_TRUE(s.ok()) << s.error();
    return b;
}

Built build(const Picture& p, float bisection)
{
    return build({ p.width, p.height, { { p.samples.data() } } }, bisection);
}

/// Soft forms, an edge, and a little noise, as photographs have them.
Picture landscape(int width, int height)
{
    return test::make("landscape", width, height, [=](int x, int y) {
        const float hill = 0.5f * float(height) + 20.0f * std::sin(float(x) * 0.05f);
        const float sky = 180.0f - 60.0f * float(y) / float(height);
        const float ground = 70.0f + 25.0f * std::sin(float(x) * 0.3f) * std::sin(float(y) * 0.25f);
        return (float(y) < hill ? sky : ground) + 1.5f * (test::noise(x, y) - 0.5f);
    });
}

double psnr_of_level(const Picture& p, const Built& b, double share)
{
    const Level level = b.hierarchy.level_of_vertices(Index(share * double(b.hierarchy.vertices())));
    Mesh mesh;
    EXPECT_TRUE(refine(b.hierarchy, level, mesh).ok());
    std::vector<float> out(p.samples.size());
    const std::vector<float> z = values_at(b.hierarchy, b.bands[0], level);
    rasterize(mesh, { z.data() }, { out.data() });
    double sum = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i)
        sum += (double(out[i]) - p.samples[i]) * (double(out[i]) - p.samples[i]);
    return 10.0 * std::log10(255.0 * 255.0 * double(out.size()) / sum);
}

double volume(const Built& b, Level level)
{
    Mesh mesh;
    EXPECT_TRUE(refine(b.hierarchy, level, mesh).ok());
    const std::vector<float> z = values_at(b.hierarchy, b.bands[0], level);
    double sum = 0;
    for (const Triangle& t : mesh.triangles())
        sum += double(doubled_area(mesh.point(t[0]), mesh.point(t[1]), mesh.point(t[2])))
            * (double(z[t[0]]) + z[t[1]] + z[t[2]]) / 6.0;
    return sum / (double(mesh.extent().x) * mesh.extent().y);
}

TEST(Bisection, HierarchiesAreValidAndExact)
{
    for (const Picture& p : test::awkward_pictures()) {
        const Built b = build(p, kLimit);
        const Status s = validate(b.hierarchy);
        EXPECT_TRUE(s.ok()) << p.name << ": " << s.error();
        std::vector<float> out(b.hierarchy.mesh_pixels());
        synthesise(b.hierarchy, b.bands[0], out.data());
        const std::vector<float> in = to_mesh_pixels(b.hierarchy, p.samples.data());
        for (std::size_t i = 0; i < out.size(); ++i)
            ASSERT_NEAR(out[i], in[i], 1e-6f * 255.0f) << p.name << " at " << i;
    }
}

TEST(Bisection, EverySizeGivesAConformingMesh)
{
    for (int width : { 2, 3, 4, 5, 63, 64, 65, 66, 129, 131 })
        for (int height : { 2, 3, 64, 65, 100, 130 }) {
            const Picture p = landscape(width, height);
            const Status s = validate(build(p, 1e6f).hierarchy);
            EXPECT_TRUE(s.ok()) << width << " x " << height << ": " << s.error();
        }
}

TEST(Bisection, KeepsTheVolumeAtEveryLevel)
{
    const Picture p = landscape(120, 90);
    const Built b = build(p, kLimit);
    const Level finest = b.hierarchy.levels();
    const double whole = volume(b, finest);
    for (Level level : { finest - 1, finest - 100, finest * 2 / 3, finest / 2, finest / 10, Level(0) })
        EXPECT_NEAR(volume(b, level), whole, 1e-3) << "level " << level;
}

// What bisection removes is not chosen edge by edge, and coarser levels are as good as without it.
TEST(Bisection, SavesEvaluationsAndNoQualityBelow)
{
    const Picture p = landscape(256, 256);
    const Built plain = build(p, 0.0f), quick = build(p, kLimit);
    EXPECT_LT(double(quick.stats.evaluations), 0.6 * double(plain.stats.evaluations));
    EXPECT_EQ(quick.hierarchy.vertices(), plain.hierarchy.vertices());
    for (double share : { 0.1, 0.02 })
        EXPECT_GT(psnr_of_level(p, quick, share), psnr_of_level(p, plain, share) - 0.3) << share;
}

TEST(Bisection, RemovesAtMostTwoThirds)
{
    const Picture flat = test::make("flat", 200, 150, [](int, int) { return 10.0f; });
    const Built b = build(flat, 1e30f);
    EXPECT_GT(b.stats.evaluations, 200u * 150u / 3u - 1u);
}

// A step is left to the edge collapses: no level that bisection reaches loses it.
TEST(Bisection, LeavesEdgesAlone)
{
    const Picture step = test::make("step", 97, 80, [](int x, int y) { return x * 2 + y < 130 ? 20.0f : 200.0f; });
    EXPECT_GT(psnr_of_level(step, build(step, kLimit), 0.35), 90.0);
}

TEST(Bisection, ChannelsShareTheMesh)
{
    const Picture a = landscape(90, 70);
    const Picture b =
        test::make("wave", 90, 70, [](int x, int y) { return 100.0f + 50.0f * std::sin(float(x - y) * 0.2f); });
    const Built built = build(Guide { 90, 70, { { a.samples.data(), 1.0f }, { b.samples.data(), 0.5f } } }, kLimit);
    EXPECT_TRUE(validate(built.hierarchy).ok());
    std::vector<Bands> again;
    ASSERT_TRUE(analyse(built.hierarchy, { a.samples.data(), b.samples.data() }, again).ok());
    for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t i = 0; i < again[c].details.size(); ++i) {
            ASSERT_NEAR(again[c].details[i].t, built.bands[c].details[i].t, 2e-3f) << c << ", " << i;
            ASSERT_NEAR(again[c].details[i].u, built.bands[c].details[i].u, 2e-3f) << c << ", " << i;
        }
}

TEST(Bisection, ThreadsDoNotChangeABit)
{
    const Picture p = landscape(300, 200);
    const Guide guide { p.width, p.height, { { p.samples.data() } } };
    const Built one = build(guide, kLimit);
    for (int threads : { 2, 5 }) {
        const Built many = build(guide, kLimit, test::threads(threads));
        ASSERT_EQ(one.hierarchy.splits.size(), many.hierarchy.splits.size());
        EXPECT_EQ(0,
                  std::memcmp(one.hierarchy.splits.data(), many.hierarchy.splits.data(),
                              one.hierarchy.splits.size() * sizeof(Split)));
        EXPECT_EQ(one.hierarchy.costs, many.hierarchy.costs);
        EXPECT_EQ(0,
                  std::memcmp(one.bands[0].details.data(), many.bands[0].details.data(),
                              one.bands[0].details.size() * sizeof(Detail)));
    }
}

TEST(Bisection, SamplesThatOverflowAreLeftAlone)
{
    const Picture p = test::make("huge", 40, 30, [](int x, int y) { return (x + y) % 3 == 0 ? 3e38f : -3e38f; });
    SimplifyOptions options;
    options.bisection = kLimit;
    Hierarchy hierarchy;
    std::vector<Bands> bands;
    EXPECT_TRUE(simplify({ 40, 30, { { p.samples.data() } } }, options, hierarchy, bands).ok());
    options.bisection = std::nanf("");
    EXPECT_NE(simplify({ 40, 30, { { p.samples.data() } } }, options, hierarchy, bands).error().find("bisection"),
              std::string::npos);
}

}  // namespace
}  // namespace pimg
