// SPDX-License-Identifier: BSD-3-Clause
// Properties of the dual pieces: a partition at every level, nested, connected along mesh edges.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include <pimg/dual_pieces.h>
#include <pimg/sampling.h>
#include <pimg/simplify.h>

namespace {

using namespace pimg;

/// A disc on a ramp with some deterministic grain.
std::vector<float> picture(int width, int height)
{
    std::vector<float> z;
    std::uint32_t seed = 1;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            seed = seed * 1664525u + 1013904223u;
            const float r = std::hypot(float(x) - 0.4f * float(width), float(y) - 0.5f * float(height));
            z.push_back((r < 0.25f * float(height) ? 180.0f : 60.0f) + float(x) + float(seed >> 28));
        }
    return z;
}

struct Built {
    Hierarchy hierarchy;
    std::vector<Bands> bands;
    DualPieces pieces;

    Built(int width, int height, const std::vector<float>& z, Index base_faces = 16)
    {
        SimplifyOptions options;
        options.base_faces = base_faces;
        EXPECT_TRUE(simplify({ width, height, { { z.data() } } }, options, hierarchy, bands).ok());
        EXPECT_TRUE(DualPieces::from_hierarchy(hierarchy, pieces).ok());
    }
    Built(int width, int height) : Built(width, height, picture(width, height)) { }
};

std::vector<Level> some_levels(const Hierarchy& h)
{
    std::set<Level> levels { 0, h.levels() / 100, h.levels() / 10, h.levels() / 2, h.levels() };
    if (h.levels() > 0)
        levels.insert({ 1, h.levels() - 1 });
    return { levels.begin(), levels.end() };
}

TEST(DualPieces, EveryPixelIsInExactlyOnePieceAtEveryLevel)
{
    const Built b(37, 29);
    for (Level level = 0; level <= b.hierarchy.levels(); ++level) {
        const std::vector<Index> labels = b.pieces.labels(level);
        ASSERT_EQ(labels.size(), 37u * 29u);
        std::vector<Index> size(b.pieces.count(level), 0);
        for (Index l : labels) {
            ASSERT_LT(l, b.pieces.count(level));
            ++size[l];
        }
        EXPECT_EQ(size, b.pieces.sizes(level)) << "level " << level;
        EXPECT_EQ(std::count(size.begin(), size.end(), 0u), 0) << "level " << level;
    }
}

TEST(DualPieces, AreAsManyAsVerticesOfTheMesh)
{
    const Built b(37, 29);
    for (Level level : some_levels(b.hierarchy)) {
        Mesh mesh;
        ASSERT_TRUE(refine(b.hierarchy, level, mesh).ok());
        EXPECT_EQ(b.pieces.count(level), mesh.size());
    }
}

TEST(DualPieces, AreNested)
{
    const Built b(37, 29);
    std::vector<Index> fine = b.pieces.labels(b.hierarchy.levels());
    for (Level level = b.hierarchy.levels(); level-- > 0;) {
        const std::vector<Index> coarse = b.pieces.labels(level);
        // The one piece that is new at the finer level joins the one it was split from.
        const Index born = b.pieces.count(level), parent = b.hierarchy.splits[level].s;
        for (std::size_t p = 0; p < coarse.size(); ++p)
            ASSERT_EQ(coarse[p], fine[p] == born ? parent : fine[p]) << "level " << level;
        fine = coarse;
    }
}

TEST(DualPieces, AncestorsAgreeWithLabels)
{
    const Built b(37, 29);
    const std::vector<Index> fine = b.pieces.labels(b.hierarchy.levels());
    for (Level level : some_levels(b.hierarchy)) {
        const std::vector<Index> labels = b.pieces.labels(level);
        for (std::size_t p = 0; p < labels.size(); ++p)
            ASSERT_EQ(labels[p], b.pieces.ancestor(fine[p], level));
    }
}

TEST(DualPieces, AreRunsOfOneOrder)
{
    const Built b(37, 29);
    for (Level level : some_levels(b.hierarchy)) {
        const std::vector<Index> labels = b.pieces.labels(level), sizes = b.pieces.sizes(level);
        for (Index v = 0; v < b.pieces.count(level); ++v) {
            const DualPieces::Run run = b.pieces.run_at_birth(v);
            ASSERT_LE(sizes[v], run.size);
            for (Index k = 0; k < sizes[v]; ++k)
                ASSERT_EQ(labels[run.first[k]], v) << "level " << level;
        }
    }
}

/// Parts of the pieces that hang together along the edges of the finest mesh.
Index parts_along_mesh(const Hierarchy& h, const Mesh& finest, const std::vector<Index>& labels)
{
    Index parts = 0;
    std::vector<bool> seen(h.vertices());
    for (Index v = 0; v < h.vertices(); ++v) {
        if (seen[v])
            continue;
        ++parts;
        std::vector<Index> stack { v };
        for (seen[v] = true; !stack.empty();) {
            const Index a = stack.back();
            stack.pop_back();
            for (Index q : finest.ring(a))
                if (q != kGhost && !seen[q] && labels[h.pixels[q]] == labels[h.pixels[a]]) {
                    seen[q] = true;
                    stack.push_back(q);
                }
        }
    }
    return parts;
}

TEST(DualPieces, AreConnectedAlongMeshEdges)
{
    const Built b(61, 47);
    Mesh finest;
    ASSERT_TRUE(refine(b.hierarchy, b.hierarchy.levels(), finest).ok());
    for (Level level : some_levels(b.hierarchy))
        EXPECT_EQ(parts_along_mesh(b.hierarchy, finest, b.pieces.labels(level)), b.pieces.count(level));
}

TEST(DualPieces, TouchWhereTheMeshHasEdges)
{
    // A collapse is a contraction, so pieces that share a pixel side are ends of an edge of M_i.
    const Built b(37, 29);
    for (Level level : some_levels(b.hierarchy)) {
        Mesh mesh;
        ASSERT_TRUE(refine(b.hierarchy, level, mesh).ok());
        for (const Border& border : borders(b.pieces.labels(level), 37, 29)) {
            const RingView ring = mesh.ring(border.a);
            EXPECT_NE(std::find(ring.begin(), ring.end(), border.b), ring.end());
        }
    }
}

TEST(DualPieces, HandleThinAndConstantPictures)
{
    for (const auto& [width, height] : { std::pair { 1, 1 }, { 1, 40 }, { 40, 1 }, { 2, 2 }, { 16, 16 } }) {
        const std::vector<float> z(std::size_t(width * height), 7.0f);
        const Built b(width, height, z, 2);
        for (Level level : some_levels(b.hierarchy)) {
            const std::vector<Index> labels = b.pieces.labels(level);
            const std::vector<Index> sizes = b.pieces.sizes(level);
            ASSERT_EQ(labels.size(), z.size());
            Index sum = 0;
            for (Index v = 0; v < b.pieces.count(level); ++v)
                sum += sizes[v];
            EXPECT_EQ(sum, z.size());
            for (Index l : labels)
                EXPECT_LT(l, b.pieces.count(level));
        }
    }
}

TEST(DualPieces, ShareOutThePixelsBetweenTheVerticesOfASimplerMesh)
{
    const int w = 40, h = 30;
    const std::vector<float> z = picture(w, h);
    const Guide guide { w, h, { { z.data() } } };
    SamplingOptions sampling;
    sampling.density = 0.25;
    SimplifyOptions options;
    ASSERT_TRUE(sample(guide, sampling, options.start).ok());
    Hierarchy hierarchy;
    std::vector<Bands> bands;
    ASSERT_TRUE(simplify(guide, options, hierarchy, bands).ok());
    ASSERT_LT(hierarchy.vertices(), Index(w * h / 2));
    DualPieces pieces;
    ASSERT_TRUE(DualPieces::from_hierarchy(hierarchy, pieces).ok());
    const std::vector<Index> finest = pieces.labels(pieces.levels());
    for (Index v = 0; v < hierarchy.vertices(); ++v)
        EXPECT_EQ(finest[hierarchy.pixels[v]], v);
    std::vector<Index> finer = finest;
    for (Level level : { hierarchy.levels() / 2, hierarchy.levels() / 10, Level(0) }) {
        const std::vector<Index> labels = pieces.labels(level), sizes = pieces.sizes(level);
        std::vector<Index> counted(pieces.count(level), 0);
        for (std::size_t p = 0; p < labels.size(); ++p) {
            ASSERT_LT(labels[p], counted.size());
            ++counted[labels[p]];
            EXPECT_EQ(labels[p], pieces.ancestor(finer[p], level));
        }
        EXPECT_EQ(counted, sizes);
        EXPECT_EQ(std::count(sizes.begin(), sizes.end(), 0u), 0);
        finer = labels;
    }
}

TEST(DualPieces, RefuseADamagedHierarchy)
{
    Built b(8, 8);
    b.hierarchy.splits[2].s = b.hierarchy.vertices();
    DualPieces pieces;
    EXPECT_FALSE(DualPieces::from_hierarchy(b.hierarchy, pieces).ok());
}

TEST(Labels, BordersCountSharedSides)
{
    const std::vector<Index> labels = { 0, 0, 1,  //
                                        2, 0, 1,  //
                                        2, 2, 1 };
    const std::vector<Border> found = borders(labels, 3, 3);
    ASSERT_EQ(found.size(), 3u);
    const Index expected[3][3] = { { 0, 1, 2 }, { 0, 2, 3 }, { 1, 2, 1 } };
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(found[i].a, expected[i][0]);
        EXPECT_EQ(found[i].b, expected[i][1]);
        EXPECT_EQ(found[i].length, expected[i][2]);
    }
}

TEST(Labels, PartsThatOnlyTouchAtCornersAreApart)
{
    std::vector<Index> labels = { 5, 7,  //
                                  7, 5 };
    EXPECT_EQ(connected_parts(labels, 2, 2), 4u);
    EXPECT_EQ(labels, (std::vector<Index> { 0, 1, 2, 3 }));
}

TEST(Labels, MeansAndCentroids)
{
    const std::vector<Index> labels = { 0, 0, 2, 2 };
    const float samples[] = { 1, 3, 10, 20 };
    EXPECT_EQ(label_means(labels, 3, samples), (std::vector<float> { 2, 0, 15 }));
    const std::vector<Centroid> c = label_centroids(labels, 3, 2);
    EXPECT_FLOAT_EQ(c[0].x, 0.5f);
    EXPECT_FLOAT_EQ(c[0].y, 0.0f);
    EXPECT_FLOAT_EQ(c[2].y, 1.0f);
}

}  // namespace
