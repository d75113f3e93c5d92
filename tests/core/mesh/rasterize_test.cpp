// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/rasterize.h>

#include <algorithm>

#include <gtest/gtest.h>

namespace pimg {
namespace {

Mesh two_triangles(int width, int height)
{
    Mesh mesh;
    const Point far { (width - 1) * kSubpixels, (height - 1) * kSubpixels };
    EXPECT_TRUE(
        Mesh::from_triangles({ { 0, 0 }, { far.x, 0 }, far, { 0, far.y } }, { { 0, 1, 2 }, { 0, 2, 3 } }, far, mesh)
            .ok());
    return mesh;
}

TEST(Rasterize, ReproducesALinearFunction)
{
    const Mesh mesh = two_triangles(37, 21);
    const auto f = [](double x, double y) {
        return float(2.0 + 0.5 * x - 0.25 * y);
    };
    const float z[4] = { f(0, 0), f(36, 0), f(36, 20), f(0, 20) };
    std::vector<float> out(37 * 21, -1.0f);
    EXPECT_EQ(rasterize(mesh, { z }, { out.data() }), 0u);
    for (int y = 0; y < 21; ++y)
        for (int x = 0; x < 37; ++x)
            ASSERT_NEAR(out[std::size_t(y * 37 + x)], f(x, y), 1e-4);
}

TEST(Rasterize, DoesNotLeaveTheRangeOfTheCorners)
{
    Mesh mesh = two_triangles(64, 64);
    // A sliver with a steep slope.
    ASSERT_TRUE(mesh.split(0, kGhost, 2, { 0, 0 }, { 1, 0 }));
    const float z[5] = { 0.0f, 1.0f, 1.0f, 0.0f, 1.0f };
    std::vector<float> out(64 * 64);
    EXPECT_EQ(rasterize(mesh, { z }, { out.data() }), 0u);
    EXPECT_GE(*std::min_element(out.begin(), out.end()), 0.0f);
    EXPECT_LE(*std::max_element(out.begin(), out.end()), 1.0f);
}

TEST(Wireframe, DrawsEdgesAndNothingElse)
{
    const Mesh mesh = two_triangles(32, 32);
    const std::vector<float> lines = wireframe(mesh);
    EXPECT_FLOAT_EQ(lines[0], 1.0f);
    EXPECT_FLOAT_EQ(lines[16 * 32 + 16], 1.0f);  // on the diagonal
    EXPECT_FLOAT_EQ(lines[5 * 32 + 25], 0.0f);   // inside a triangle
    EXPECT_EQ(wireframe(mesh, 1.0f, 3).size(), 96u * 96u);
}

}  // namespace
}  // namespace pimg
