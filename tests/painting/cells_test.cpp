// SPDX-License-Identifier: BSD-3-Clause
// Cells: a partition into connected parts that know the picture's edges.
#include <pimg/mosaic.h>

#include <cmath>
#include <set>

#include "painting/scene.h"

using namespace pimg;
using test::PaintedScene;

namespace {

std::vector<Index> cells_of(const PaintedScene& scene, double count, Index* vertices = nullptr)
{
    Mesh mesh;
    EXPECT_TRUE(refine(scene.hierarchy, scene.hierarchy.level_of_vertices(count), mesh).ok());
    if (vertices)
        *vertices = mesh.size();
    return grow_cells(mesh, scene.guides);
}

/// Numbers of pixels of the parts that are connected along sides of pixels.
std::vector<int> parts(const std::vector<Index>& labels, int width, int height)
{
    std::vector<int> sizes;
    std::vector<char> seen(labels.size(), 0);
    for (std::size_t start = 0; start < labels.size(); ++start) {
        if (seen[start])
            continue;
        std::vector<std::size_t> stack { start };
        seen[start] = 1;
        sizes.push_back(0);
        while (!stack.empty()) {
            const std::size_t at = stack.back();
            stack.pop_back();
            ++sizes.back();
            const int x = int(at) % width, y = int(at) / width;
            for (const auto& [dx, dy] : { std::pair { 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 } }) {
                if (x + dx < 0 || y + dy < 0 || x + dx >= width || y + dy >= height)
                    continue;
                const std::size_t next = std::size_t((y + dy) * width + x + dx);
                if (!seen[next] && labels[next] == labels[at]) {
                    seen[next] = 1;
                    stack.push_back(next);
                }
            }
        }
    }
    return sizes;
}

TEST(Cells, AreConnectedPartsOfThePicture)
{
    const PaintedScene scene(test::scene(120, 90));
    for (const double count : { 12.0, 150.0, 2000.0 }) {
        Index vertices = 0;
        const std::vector<Index> labels = cells_of(scene, count, &vertices);
        ASSERT_EQ(labels.size(), scene.samples.size());
        const std::set<Index> used(labels.begin(), labels.end());
        EXPECT_LT(*used.rbegin(), vertices);
        EXPECT_EQ(parts(labels, 120, 90).size(), used.size()) << count;
        EXPECT_GT(used.size(), vertices * 8 / 10);
    }
}

/// The perimeter of a cell over that of a disc of its area: cells are rounder than the pieces they grow from.
TEST(Cells, AreRounderThanPieces)
{
    const PaintedScene scene(test::scene(160, 120));
    Mesh mesh;
    ASSERT_TRUE(refine(scene.hierarchy, scene.hierarchy.level_of_vertices(150), mesh).ok());
    const auto joints = [](const std::vector<Index>& labels) {
        int sides = 0;
        for (int y = 0; y < 120; ++y)
            for (int x = 0; x < 160; ++x) {
                const std::size_t at = std::size_t(y * 160 + x);
                sides += x + 1 < 160 && labels[at] != labels[at + 1];
                sides += y + 1 < 120 && labels[at] != labels[at + 160];
            }
        return sides;
    };
    EXPECT_LT(joints(grow_cells(mesh, scene.guides)), joints(tile(mesh).tile) * 95 / 100);
}

TEST(Cells, DoNotCrossAStrongEdge)
{
    const PaintedScene scene(test::make("step", 120, 90, [](int x, int y) { return x + y / 3 < 70 ? 30 : 220; }));
    Index vertices = 0;
    const std::vector<Index> labels = cells_of(scene, 80, &vertices);
    std::vector<int> dark(vertices, 0), bright(vertices, 0);
    for (std::size_t i = 0; i < labels.size(); ++i)
        (scene.samples[i] < 125.0f ? dark : bright)[labels[i]]++;
    int wrong = 0;
    for (Index v = 0; v < vertices; ++v)
        wrong += std::min(dark[v], bright[v]);
    EXPECT_LE(wrong, 90 * 2) << "one or two pixels to a row, as the picture is smoothed a little";
}

TEST(Cells, DoNotDependOnTheOrderOfTheWork)
{
    const PaintedScene scene(test::scene(150, 130));
    Mesh mesh;
    ASSERT_TRUE(refine(scene.hierarchy, scene.hierarchy.level_of_vertices(200), mesh).ok());
    EXPECT_EQ(grow_cells(mesh, scene.guides), grow_cells(mesh, scene.guides, test::backwards));
}

TEST(Cells, CoverEveryAwkwardPicture)
{
    for (const test::Picture& p : test::awkward_pictures()) {
        const PaintedScene scene(p);
        Index vertices = 0;
        for (const Index label : cells_of(scene, 20, &vertices))
            ASSERT_LT(label, vertices) << p.name;
    }
}

}  // namespace
