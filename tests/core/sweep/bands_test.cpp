// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/bands.h>

#include <gtest/gtest.h>

#include <pimg/simplify.h>

#include "core/pictures.h"

namespace pimg {
namespace {

struct BandsOnScene : testing::Test {
    void SetUp() override
    {
        ASSERT_TRUE(
            simplify({ picture.width, picture.height, { { picture.samples.data() } } }, {}, hierarchy, built).ok());
        guide = built[0];
    }
    const test::Picture picture = test::scene(120, 90);
    Hierarchy hierarchy;
    std::vector<Bands> built;
    Bands guide;
};

TEST_F(BandsOnScene, AnalysisOfTheGuideAgreesWithTheEngine)
{
    std::vector<Bands> bands;
    ASSERT_TRUE(analyse(hierarchy, { picture.samples.data() }, bands).ok());
    double sum = 0, difference = 0;
    for (std::size_t i = 0; i < bands[0].details.size(); ++i) {
        sum += std::fabs(guide.details[i].t) + std::fabs(guide.details[i].u);
        difference += std::fabs(guide.details[i].t - bands[0].details[i].t)
            + std::fabs(guide.details[i].u - bands[0].details[i].u);
    }
    EXPECT_LT(difference, 1e-4 * sum);
}

TEST_F(BandsOnScene, SynthesisUndoesAnalysisOfOtherChannels)
{
    const test::Picture noise = test::make("noise", 120, 90, [](int x, int y) { return test::noise(x, y, 7); });
    const test::Picture ramp =
        test::make("ramp", 120, 90, [](int x, int y) { return 0.3f * float(x) - 0.1f * float(y); });
    std::vector<Bands> bands;
    ASSERT_TRUE(analyse(hierarchy, { noise.samples.data(), ramp.samples.data() }, bands).ok());
    std::vector<float> out(hierarchy.mesh_pixels());
    synthesise(hierarchy, bands[0], out.data());
    for (std::size_t i = 0; i < out.size(); ++i)
        ASSERT_NEAR(out[i], noise.samples[i], 1e-6f);
    synthesise(hierarchy, bands[1], out.data());
    for (std::size_t i = 0; i < out.size(); ++i)
        ASSERT_NEAR(out[i], ramp.samples[i], 36.0f * 1e-6f);
    // A ramp is linear: every mesh predicts it, so nothing but rounding is left in the details.
    EXPECT_LT(bands[1].largest_detail(), 1e-3f);
}

TEST_F(BandsOnScene, GainOneIsTheSweepWithoutGain)
{
    std::vector<float> a(hierarchy.vertices()), b(hierarchy.mesh_pixels()), c(hierarchy.mesh_pixels());
    sweep(hierarchy, guide, a.data(), hierarchy.levels(), [](Level, Detail d) {
        return Detail { d.t * 1.0f, d.u * 1.0f };
    });
    scatter(hierarchy, a.data(), b.data());
    synthesise(hierarchy, guide, c.data());
    EXPECT_EQ(b, c);
}

TEST_F(BandsOnScene, SynthesisIsLinear)
{
    Bands twice = guide;
    for (float& v : twice.base)
        v *= 2.0f;
    for (Detail& d : twice.details)
        d = { 2.0f * d.t, 2.0f * d.u };
    std::vector<float> a(hierarchy.mesh_pixels()), b(hierarchy.mesh_pixels());
    synthesise(hierarchy, guide, a.data());
    synthesise(hierarchy, twice, b.data());
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_EQ(2.0f * a[i], b[i]);
}

TEST_F(BandsOnScene, RebaseForgetsSplitsOnly)
{
    Hierarchy h = hierarchy;
    std::vector<Bands> b { guide };
    ASSERT_TRUE(rebase(h, b, 500).ok());
    EXPECT_EQ(h.levels() + 500, hierarchy.levels());
    EXPECT_EQ(h.vertices(), hierarchy.vertices());
    EXPECT_TRUE(validate(h).ok()) << validate(h).error();
    std::vector<float> out(hierarchy.mesh_pixels());
    synthesise(h, b[0], out.data());
    EXPECT_EQ(out, picture.samples);
}

TEST_F(BandsOnScene, LevelsByCountAndError)
{
    EXPECT_EQ(hierarchy.level_of_vertices(1e9), hierarchy.levels());
    EXPECT_EQ(hierarchy.level_of_vertices(0), 0u);
    EXPECT_EQ(hierarchy.level_of_error(1e30), 0u);
    EXPECT_EQ(hierarchy.level_of_error(-1), hierarchy.levels());
    Mesh mesh;
    const Level level = hierarchy.level_of_faces(700);
    ASSERT_TRUE(refine(hierarchy, level, mesh).ok());
    EXPECT_LE(mesh.triangle_count(), 700u);
    EXPECT_GE(mesh.triangle_count(), 698u);
}

TEST_F(BandsOnScene, DamagedHierarchiesAreRefused)
{
    Mesh mesh;
    Hierarchy h = hierarchy;
    h.splits[40].vl = h.splits[40].vr;
    EXPECT_FALSE(refine(h, 100, mesh).ok());
    h = hierarchy;
    h.splits[40].s = 1u << 30;
    EXPECT_FALSE(refine(h, 100, mesh).ok());
    EXPECT_FALSE(validate(h).ok());
    h = hierarchy;
    h.stencils[10].wat += 0.1f;
    EXPECT_FALSE(validate(h).ok());
    h = hierarchy;
    std::swap(h.costs.front(), h.costs.back());
    EXPECT_FALSE(validate(h).ok());
}

}  // namespace
}  // namespace pimg
