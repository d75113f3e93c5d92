// SPDX-License-Identifier: BSD-3-Clause
// Distances from the joints of a partition, and rounded corners.
#include <pimg/mosaic.h>

#include <cmath>

#include <gtest/gtest.h>

using namespace pimg;

namespace {

/// Squares of 20 pixels.
std::vector<Index> squares(int width, int height)
{
    std::vector<Index> labels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            labels.push_back(Index(y / 20 * (width / 20) + x / 20));
    return labels;
}

TEST(Tiling, HasDistancesFromJoints)
{
    const Tiling tiling = tiling_of(squares(60, 60), 60, 60, 9, 0.0f);
    for (int y = 20; y < 40; ++y)
        for (int x = 20; x < 40; ++x) {
            const std::size_t at = std::size_t(y * 60 + x);
            const float left = float(x) - 19.5f, right = 39.5f - float(x), top = float(y) - 19.5f,
                        below = 39.5f - float(y);
            EXPECT_NEAR(tiling.inside[at], std::min(std::min(left, right), std::min(top, below)), 0.51f);
            const float square = tiling.away_x[at] * tiling.away_x[at] + tiling.away_y[at] * tiling.away_y[at];
            EXPECT_NEAR(square, 1.0f, 1e-5f);
        }
    EXPECT_GT(tiling.away_x[30 * 60 + 21], 0.9f) << "away from the joint on the left";
    EXPECT_GT(tiling.inside[0], 15.0f) << "the border is no joint";
}

TEST(Tiling, RoundsCorners)
{
    const std::vector<Index> labels = squares(60, 60);
    const Tiling square = tiling_of(labels, 60, 60, 9, 0.0f), round = tiling_of(labels, 60, 60, 9, 1.0f);
    for (int y = 20; y < 40; ++y)
        for (int x = 20; x < 40; ++x) {
            const std::size_t at = std::size_t(y * 60 + x);
            EXPECT_EQ(round.tile[at], labels[at]);
            EXPECT_LE(round.inside[at], square.inside[at] + 0.51f);
            // What remains of a square is its inscribed disc.
            const float off = std::hypot(float(x) - 29.5f, float(y) - 29.5f);
            EXPECT_NEAR(round.inside[at], 10.0f - off, 1.3f) << x << ", " << y;
        }
}

TEST(Tiling, OfOneTileHasNoJoints)
{
    for (const float rounding : { 0.0f, 0.5f }) {
        const Tiling tiling = tiling_of(std::vector<Index>(12, 0), 4, 3, 1, rounding);
        for (std::size_t i = 0; i < 12; ++i) {
            EXPECT_GT(tiling.inside[i], 1000.0f);
            EXPECT_TRUE(std::isfinite(tiling.inside[i]));
        }
    }
}

}  // namespace
