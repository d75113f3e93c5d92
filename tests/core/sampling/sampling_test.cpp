// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/sampling.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <pimg/hierarchy.h>
#include <pimg/simplify.h>

#include "core/pictures.h"
#include "core/threads.h"

namespace pimg {
namespace {

using test::Picture;

Guide guide_of(const Picture& p)
{
    return { p.width, p.height, { { p.samples.data(), 1.0f } } };
}

/// Pixels kept by chance, and the corners.
std::vector<Index> random_pixels(int width, int height, float share, std::uint32_t seed)
{
    std::vector<Index> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (test::noise(std::uint32_t(x), std::uint32_t(y), seed) < share
                || ((x == 0 || x == width - 1) && (y == 0 || y == height - 1)))
                pixels.push_back(Index(y * width + x));
    return pixels;
}

Index next_edge(Index e)
{
    return e % 3 == 2 ? e - 2 : e + 1;
}

/// Whether triangles are positive, twins agree, and the rectangle is covered exactly once.
::testing::AssertionResult is_triangulation(const InitialMesh& mesh)
{
    std::int64_t area = 0;
    for (Index e = 0; e < Index(mesh.corners.size()); ++e) {
        const Point a = mesh.pixel(mesh.corners[e]), b = mesh.pixel(mesh.corners[next_edge(e)]);
        const Point c = mesh.pixel(mesh.corners[next_edge(next_edge(e))]);
        if (doubled_area(a, b, c) <= 0)
            return ::testing::AssertionFailure() << "empty or flipped triangle " << e / 3;
        area += doubled_area(a, b, c);
        const Index twin = mesh.twins[e];
        const bool on_side =
            (a.x == b.x && (a.x == 0 || a.x == mesh.width - 1)) || (a.y == b.y && (a.y == 0 || a.y == mesh.height - 1));
        if ((twin == kGhost) != on_side)
            return ::testing::AssertionFailure() << "open edge inside, or closed one on the side: " << e;
        if (twin != kGhost && (mesh.twins[twin] != e || mesh.corners[twin] != mesh.corners[next_edge(e)]))
            return ::testing::AssertionFailure() << "twins disagree at " << e;
    }
    if (area != 6 * std::int64_t(mesh.width - 1) * (mesh.height - 1))
        return ::testing::AssertionFailure() << "the rectangle is not covered once";
    return ::testing::AssertionSuccess();
}

std::vector<int> degrees(const InitialMesh& mesh)
{
    std::vector<int> degree(mesh.pixels.size());
    for (std::size_t e = 0; e < mesh.corners.size(); ++e)
        degree[mesh.corners[e]] += mesh.twins[e] == kGhost ? 3 : 1;
    return degree;
}

/// Whether d lies inside the circle through the positively oriented a, b, c.
bool in_circle(Point a, Point b, Point c, Point d)
{
    __extension__ using Wide = __int128;
    const Wide ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
    return (ax * ax + ay * ay) * (bx * cy - cx * by) + (bx * bx + by * by) * (cx * ay - ax * cy)
        + (cx * cx + cy * cy) * (ax * by - bx * ay)
        > 0;
}

/// Number of triangles whose circle holds another vertex.
std::size_t violations(const InitialMesh& mesh)
{
    std::size_t count = 0;
    for (std::size_t t = 0; t < mesh.triangles(); ++t)
        for (Index v = 0; v < mesh.vertices(); ++v)
            if (in_circle(mesh.pixel(mesh.corners[3 * t]), mesh.pixel(mesh.corners[3 * t + 1]),
                          mesh.pixel(mesh.corners[3 * t + 2]), mesh.pixel(v))) {
                ++count;
                break;
            }
    return count;
}

TEST(Delaunay, EveryCircleIsEmpty)
{
    std::size_t checked = 0;
    for (std::uint32_t seed = 1; seed <= 12; ++seed)
        for (float share : { 0.02f, 0.1f, 0.4f, 0.9f }) {
            const Picture p = test::scene(17 + int(seed), 30 - int(seed));
            const InitialMesh mesh = triangulate(random_pixels(p.width, p.height, share, seed), guide_of(p));
            ASSERT_TRUE(is_triangulation(mesh)) << seed << " " << share;
            const std::vector<int> d = degrees(mesh);
            if (*std::max_element(d.begin(), d.end()) == kMaxDegree)
                continue;  // edges may have been flipped away
            ASSERT_EQ(violations(mesh), 0u) << seed << " " << share;
            ++checked;
        }
    EXPECT_GT(checked, 40u);
}

TEST(Delaunay, IsExactForTheWidestPicture)
{
    const int width = 1 << 20, height = 3;
    const Picture p = test::make("wide", width, height, [](int, int) { return 0.0f; });
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        const InitialMesh mesh = triangulate(random_pixels(width, height, 4e-5f, seed), guide_of(p));
        ASSERT_GT(mesh.vertices(), 20u);
        EXPECT_TRUE(is_triangulation(mesh));
        const std::vector<int> d = degrees(mesh);
        if (*std::max_element(d.begin(), d.end()) < kMaxDegree) {
            EXPECT_EQ(violations(mesh), 0u);
        }
    }
}

TEST(Delaunay, FullGridTakesTheDiagonalOfTheSmallerJump)
{
    const Picture p = test::scene(40, 33);
    std::vector<Index> all(p.samples.size());
    for (Index i = 0; i < Index(all.size()); ++i)
        all[i] = i;
    const InitialMesh mesh = triangulate(all, guide_of(p));
    ASSERT_TRUE(is_triangulation(mesh));
    EXPECT_EQ(mesh.triangles(), 2u * 39 * 32);
    for (Index e = 0; e < Index(mesh.corners.size()); ++e) {
        const Point a = mesh.pixel(mesh.corners[e]), b = mesh.pixel(mesh.corners[next_edge(e)]);
        if (std::abs(a.x - b.x) + std::abs(a.y - b.y) < 2)
            continue;
        const auto at = [&](int x, int y) {
            return p.samples[std::size_t(y * p.width + x)];
        };
        EXPECT_LE(std::fabs(at(a.x, a.y) - at(b.x, b.y)), std::fabs(at(a.x, b.y) - at(b.x, a.y)));
    }
}

TEST(Delaunay, NoVertexHasTooManyNeighbours)
{
    // All of the border and one pixel inside: without flips, that pixel sees everything.
    const int width = 90, height = 70;
    const Picture flat = test::make("flat", width, height, [](int, int) { return 0.0f; });
    std::vector<Index> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (x == 0 || y == 0 || x == width - 1 || y == height - 1 || (x == 44 && y == 31))
                pixels.push_back(Index(y * width + x));
    const InitialMesh mesh = triangulate(pixels, guide_of(flat));
    EXPECT_TRUE(is_triangulation(mesh));
    const std::vector<int> d = degrees(mesh);
    EXPECT_LE(*std::max_element(d.begin(), d.end()), kMaxDegree);
    EXPECT_TRUE(std::includes(mesh.pixels.begin(), mesh.pixels.end(), pixels.begin(), pixels.end()));
}

TEST(Sampling, HostileControlMaps)
{
    const int width = 130, height = 97;
    const Picture p = test::scene(width, height);
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<std::pair<const char*, std::function<float(int, int)>>> maps {
        { "constant",
          [](int, int) {
              return 3.0f;
          } },
        { "zero",
          [](int, int) {
              return 0.0f;
          } },
        { "one bright pixel",
          [](int x, int y) {
              return x == 60 && y == 41 ? 1.0f : 0.0f;
          } },
        { "line",
          [](int, int y) {
              return y == 40 ? 1.0f : 0.0f;
          } },
        { "diagonal",
          [](int x, int y) {
              return x == y ? 1.0f : 0.0f;
          } },
        { "border",
          [=](int x, int y) {
              return x == 0 || y == 0 || x == width - 1 || y == height - 1 ? 1.0f : 0.0f;
          } },
        { "half",
          [](int x, int) {
              return x < 60 ? 1.0f : 0.0f;
          } },
        { "not a number",
          [=](int x, int y) {
              return (x + y) % 3 == 0 ? nan : (x + y) % 3 == 1 ? inf : -1.0f;
          } },
    };
    for (const auto& [name, f] : maps)
        for (double density : { 1.0, 0.33, 0.1, 0.01, 1e-4, 1e-12 }) {
            const Picture map = test::make(name, width, height, f);
            SamplingOptions options;
            options.density = density;
            options.map = map.samples.data();
            InitialMesh mesh;
            ASSERT_TRUE(sample(guide_of(p), options, mesh).ok());
            ASSERT_TRUE(is_triangulation(mesh)) << name << " " << density;
            const std::vector<int> d = degrees(mesh);
            EXPECT_LE(*std::max_element(d.begin(), d.end()), kMaxDegree) << name << " " << density;
            SimplifyOptions from;
            from.start = mesh;
            Hierarchy h;
            std::vector<Bands> bands;
            ASSERT_TRUE(simplify(guide_of(p), from, h, bands).ok());
            const Status s = validate(h);
            EXPECT_TRUE(s.ok()) << name << " " << density << ": " << s.error();
        }
}

TEST(Sampling, KeepsTheFractionAskedFor)
{
    const Picture p = test::scene(256, 200);
    for (double density : { 0.05, 0.1, 1.0 / 3, 0.6, 1.0 })
        for (Control control : { Control::gradient, Control::curvature }) {
            SamplingOptions options;
            options.density = density;
            options.control = control;
            InitialMesh mesh;
            ASSERT_TRUE(sample(guide_of(p), options, mesh).ok());
            EXPECT_NEAR(double(mesh.vertices()) / double(p.samples.size()), density, 0.015);
        }
}

TEST(Sampling, DensityIsFollowed)
{
    std::vector<float> map(300 * 200);
    for (std::size_t i = 0; i < map.size(); ++i)
        map[i] = i % 300 < 100 ? 1.0f : i % 300 < 200 ? 0.25f : 0.0f;
    to_density(map, 0.2);
    EXPECT_NEAR(map[50] - map[250], 4.0f * (map[150] - map[250]), 1e-3f);
    EXPECT_NEAR((map[50] + map[150] + map[250]) / 3.0f, 0.2f, 1e-3f);
    std::size_t kept[3] = {};
    for (Index p : halftone(map, 300, 200))
        ++kept[p % 300 / 100];
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(double(kept[k]) / 20000.0, double(map[50 + 100 * k]), 0.02);
}

TEST(Sampling, ThreadsDoNotChangeTheMesh)
{
    const Picture p = test::scene(300, 400);
    InitialMesh one, many;
    ASSERT_TRUE(sample(guide_of(p), {}, one).ok());
    SamplingOptions options;
    options.parallel = test::threads(5);
    ASSERT_TRUE(sample(guide_of(p), options, many).ok());
    EXPECT_EQ(one.pixels, many.pixels);
    EXPECT_EQ(one.corners, many.corners);
    EXPECT_EQ(one.twins, many.twins);
}

TEST(Sampling, RefusesWhatMakesNoSense)
{
    const Picture p = test::scene(20, 20);
    InitialMesh mesh;
    for (double density : { 0.0, -1.0, 1.5, std::nan("") }) {
        SamplingOptions options;
        options.density = density;
        EXPECT_FALSE(sample(guide_of(p), options, mesh).ok());
    }
    EXPECT_FALSE(sample({ 1, 20, guide_of(p).channels }, {}, mesh).ok());
    SamplingOptions stop;
    stop.progress = [](float) {
        return false;
    };
    EXPECT_FALSE(sample(guide_of(p), stop, mesh).ok());
}

}  // namespace
}  // namespace pimg
