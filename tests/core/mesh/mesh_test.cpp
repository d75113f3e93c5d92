// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/mesh.h>

#include <algorithm>

#include <gtest/gtest.h>

namespace pimg {
namespace {

/// The place of pixel (x, y) on the lattice.
constexpr Point at(int x, int y)
{
    return { x * kSubpixels, y * kSubpixels };
}

//   0 ---- 1       a square with a vertex in the middle
//   | \  / |
//   |  4   |
//   | /  \ |
//   3 ---- 2
Mesh square()
{
    Mesh mesh;
    const Status s = Mesh::from_triangles({ at(0, 0), at(4, 0), at(4, 4), at(0, 4), at(2, 2) },
                                          { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } }, at(4, 4), mesh);
    EXPECT_TRUE(s.ok()) << s.error();
    return mesh;
}

TEST(Mesh, CountsAndRings)
{
    const Mesh mesh = square();
    EXPECT_EQ(mesh.size(), 5u);
    EXPECT_EQ(mesh.triangle_count(), 4u);
    EXPECT_EQ(mesh.triangles().size(), 4u);
    EXPECT_EQ(mesh.ring(4).degree, 4);
    EXPECT_EQ(std::count(mesh.ring(0).begin(), mesh.ring(0).end(), kGhost), 1);
}

TEST(Mesh, SplitOfAnInnerVertexAddsTwoTriangles)
{
    Mesh mesh = square();
    ASSERT_TRUE(mesh.split(4, 0, 2, at(1, 3), at(3, 1)));
    EXPECT_TRUE(mesh.validate().ok()) << mesh.validate().error();
    EXPECT_EQ(mesh.triangle_count(), 6u);
    EXPECT_EQ(mesh.point(4), at(1, 3));
    EXPECT_EQ(mesh.point(5), at(3, 1));
}

TEST(Mesh, CollapseUndoesSplit)
{
    for (Index vl = 0; vl < 4; ++vl)
        for (Index vr = 0; vr < 4; ++vr) {
            if (vl == vr)
                continue;
            Mesh mesh = square();
            const auto before = mesh.triangles();
            ASSERT_TRUE(mesh.split(4, vl, vr, at(2, 2), { at(2, 2).x + 1, at(2, 2).y + 1 }));
            ASSERT_TRUE(mesh.collapse(4, at(2, 2)));
            EXPECT_TRUE(mesh.validate().ok());
            EXPECT_EQ(mesh.triangles(), before);
        }
}

TEST(Mesh, SplitOfACornerAlongTheBorder)
{
    Mesh mesh = square();
    // Right of 0 -> new vertex on the upper side is the inside, left of it the ghost.
    ASSERT_TRUE(mesh.split(0, kGhost, 4, at(0, 0), at(2, 0)));
    EXPECT_TRUE(mesh.validate().ok()) << mesh.validate().error();
    EXPECT_EQ(mesh.triangle_count(), 5u);
}

TEST(Mesh, RefusesWhatIsNoNeighbour)
{
    Mesh mesh = square();
    EXPECT_FALSE(mesh.split(4, 0, 0, {}, {}));
    EXPECT_FALSE(mesh.split(4, kGhost, 1, {}, {}));
    EXPECT_FALSE(mesh.split(0, 2, 1, {}, {}));
    EXPECT_TRUE(mesh.validate().ok());
}

TEST(Mesh, ValidateFindsAFlippedTriangle)
{
    Mesh mesh = square();
    ASSERT_TRUE(mesh.split(4, 0, 2, at(3, 1), at(1, 3)));  // t and u on the wrong sides
    EXPECT_FALSE(mesh.validate().ok());
}

TEST(Mesh, RefusesBrokenTriangulations)
{
    const std::vector<Point> corners { at(0, 0), at(4, 0), at(4, 4), at(0, 4) };
    const Point extent = at(4, 4);
    Mesh mesh;
    EXPECT_FALSE(Mesh::from_triangles(corners, { { 0, 1, 2 } }, extent, mesh).ok()) << "half is uncovered";
    EXPECT_FALSE(Mesh::from_triangles(corners, { { 0, 2, 1 }, { 0, 3, 2 } }, extent, mesh).ok()) << "wrong way round";
    EXPECT_FALSE(Mesh::from_triangles(corners, { { 0, 1, 2 }, { 0, 1, 2 } }, extent, mesh).ok()) << "twice the same";
    EXPECT_FALSE(Mesh::from_triangles(corners, { { 0, 1, 7 } }, extent, mesh).ok()) << "no such vertex";
    EXPECT_TRUE(Mesh::from_triangles(corners, { { 0, 1, 2 }, { 0, 2, 3 } }, extent, mesh).ok());
}

}  // namespace
}  // namespace pimg
