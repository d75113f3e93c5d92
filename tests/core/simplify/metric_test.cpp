// SPDX-License-Identifier: BSD-3-Clause
// The error metrics for comparison: valid hierarchies, exact reconstruction, and what each promises.
#include <pimg/simplify.h>

#include <cmath>

#include <gtest/gtest.h>

#include <pimg/rasterize.h>
#include <pimg/sampling.h>

#include "core/pictures.h"

namespace pimg {
namespace {

using test::Picture;

constexpr Metric kMetrics[] = { Metric::volume, Metric::quadric, Metric::exact };

struct Built {
    Hierarchy hierarchy;
    std::vector<Bands> bands;
};

Built build(const Picture& p, Metric metric, Index base_faces = 2)
{
    Built b;
    SimplifyOptions options;
    options.metric = metric;
    options.base_faces = base_faces;
    const Status s = simplify({ p.width, p.height, { { p.samples.data() } } }, options, b.hierarchy, b.bands);
    EXPECT_TRUE(s.ok()) << p.name << ": " << s.error();
    return b;
}

/// Difference of the Gouraud image of a level from the picture.
struct Difference {
    double largest = 0, rms = 0;
};
Difference difference(const Picture& p, const Built& b, Level level)
{
    Mesh mesh;
    EXPECT_TRUE(refine(b.hierarchy, level, mesh).ok());
    const std::vector<float> values = values_at(b.hierarchy, b.bands[0], level);
    std::vector<float> image(p.samples.size());
    EXPECT_EQ(rasterize(mesh, { values.data() }, { image.data() }), 0u);
    Difference d;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const double e = std::fabs(double(image[i]) - double(p.samples[i]));
        d.largest = std::max(d.largest, e);
        d.rms += e * e / double(image.size());
    }
    d.rms = std::sqrt(d.rms);
    return d;
}

TEST(Metric, EveryHierarchyIsValidAndReconstructsThePicture)
{
    for (Metric metric : kMetrics)
        for (const Picture& p : test::awkward_pictures()) {
            const Built b = build(p, metric);
            const Status s = validate(b.hierarchy);
            ASSERT_TRUE(s.ok()) << p.name << ", metric " << int(metric) << ": " << s.error();
            std::vector<float> mesh_pixels(b.hierarchy.mesh_pixels());
            synthesise(b.hierarchy, b.bands[0], mesh_pixels.data());
            const std::vector<float> wanted = to_mesh_pixels(b.hierarchy, p.samples.data());
            for (std::size_t i = 0; i < wanted.size(); ++i)
                ASSERT_NEAR(mesh_pixels[i], wanted[i], 1e-6f * std::fabs(wanted[i]) + 1e-5f) << p.name;
        }
}

TEST(Metric, GoesDownToTheCorners)
{
    for (Metric metric : kMetrics)
        EXPECT_LE(build(test::scene(48, 40), metric).hierarchy.base_vertices(), 6u) << int(metric);
}

TEST(Metric, ExactCostBoundsTheDeviationOfEveryLevel)
{
    const Picture p = test::scene(64, 48);
    const Built b = build(p, Metric::exact);
    const Level levels = b.hierarchy.levels();
    for (Level level : { Level(1), levels / 50, levels / 10, levels / 4, levels / 2, levels - 1 })
        EXPECT_LE(difference(p, b, level).largest, double(b.hierarchy.costs[level]) + 1e-3) << level;
}

TEST(Metric, ExactKeepsVerticesOnPixels)
{
    const Built b = build(test::scene(40, 30), Metric::exact);
    for (const Split& s : b.hierarchy.splits)
        for (Point p : { s.t, s.u })
            EXPECT_TRUE(p.x % kSubpixels == 0 && p.y % kSubpixels == 0);
}

TEST(Metric, EachIsBestAtWhatItMinimises)
{
    // Against each other: volume optimisation in the mean, the exact metric in the maximum.
    const Picture p = test::scene(128, 96);
    Difference d[3];
    for (Metric metric : kMetrics) {
        const Built b = build(p, metric);
        d[int(metric)] = difference(p, b, b.hierarchy.level_of_vertices(0.05 * double(p.samples.size())));
    }
    EXPECT_LT(d[0].rms, d[1].rms);
    EXPECT_LT(d[2].largest, d[0].largest);
    EXPECT_LT(d[2].largest, d[1].largest);
    EXPECT_LT(d[1].rms, 8.0);
}

TEST(Metric, TakesSeveralChannels)
{
    const Picture a = test::scene(50, 40);
    const Picture c = test::make("step", 50, 40, [](int x, int y) { return x + y < 40 ? 20 : 200; });
    for (Metric metric : kMetrics) {
        Hierarchy hierarchy;
        std::vector<Bands> bands;
        SimplifyOptions options;
        options.metric = metric;
        ASSERT_TRUE(
            simplify({ 50, 40, { { a.samples.data() }, { c.samples.data(), 0.5f } } }, options, hierarchy, bands).ok());
        ASSERT_TRUE(validate(hierarchy).ok());
        ASSERT_EQ(bands.size(), 2u);
        std::vector<float> back(a.samples.size());
        synthesise(hierarchy, bands[1], back.data());
        for (std::size_t i = 0; i < back.size(); ++i)
            ASSERT_NEAR(back[i], c.samples[i], 1e-4f);
    }
}

TEST(Metric, OthersThanVolumeRefuseAnInitialMesh)
{
    const Picture p = test::scene(30, 20);
    const Guide guide { p.width, p.height, { { p.samples.data() } } };
    InitialMesh initial;
    ASSERT_TRUE(sample(guide, {}, initial).ok());
    for (Metric metric : { Metric::quadric, Metric::exact }) {
        SimplifyOptions options;
        options.metric = metric;
        options.start = initial;
        Hierarchy hierarchy;
        std::vector<Bands> bands;
        const Status s = simplify(guide, options, hierarchy, bands);
        EXPECT_FALSE(s.ok());
        EXPECT_NE(s.error().find("initial mesh"), std::string::npos) << s.error();
    }
}

TEST(Metric, StopsWhenAsked)
{
    const Picture p = test::scene(120, 100);
    for (Metric metric : kMetrics) {
        SimplifyOptions options;
        options.metric = metric;
        options.progress = [](float) {
            return false;
        };
        Hierarchy hierarchy;
        std::vector<Bands> bands;
        EXPECT_FALSE(simplify({ 120, 100, { { p.samples.data() } } }, options, hierarchy, bands).ok());
    }
}

}  // namespace
}  // namespace pimg
