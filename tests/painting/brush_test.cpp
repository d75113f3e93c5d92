// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/brush.h>

#include <cmath>

#include <gtest/gtest.h>

using namespace pimg;

namespace {

constexpr const char* kNames[] = { "round", "flat", "bristle", "knife", "chalk", "wash" };

double mean_alpha(const Brush::Mask& mask)
{
    double sum = 0.0;
    for (int i = 0; i < mask.columns * mask.rows; ++i)
        sum += double(mask.paint[i].alpha);
    return sum / double(mask.columns * mask.rows);
}

TEST(Brush, MasksAreSharesAtEverySize)
{
    EXPECT_TRUE(Brush::named("broom").empty());
    const std::vector<float> spot { 0, 2, 1, -1 };
    std::vector<Brush> brushes { Brush::from_picture(2, 2, spot.data(), nullptr) };
    for (const char* name : kNames)
        brushes.push_back(Brush::named(name));
    for (const Brush& brush : brushes)
        for (const float width : { 1.0f, 3.0f, 20.0f, 500.0f }) {
            const Brush::Mask mask = brush.mask(width, 12345);
            for (float u = -0.1f; u < 1.1f; u += 0.07f)
                for (float v = -0.1f; v < 1.1f; v += 0.07f) {
                    const Paint paint = mask.at(u, v);
                    EXPECT_TRUE(paint.alpha >= 0.0f && paint.alpha <= 1.0001f);
                    EXPECT_TRUE(paint.height >= 0.0f && paint.height <= 1.0001f);
                }
        }
}

TEST(Brush, CoarserMasksCoverTheSameShare)
{
    for (const char* name : kNames) {
        const Brush brush = Brush::named(name);
        const double share = mean_alpha(brush.mask(1000.0f, 3));
        int columns = Brush::kColumns + 1;
        for (const float width : { 1000.0f, 40.0f, 20.0f, 10.0f, 5.0f, 1.0f }) {
            const Brush::Mask mask = brush.mask(width, 3);
            EXPECT_LT(mask.columns, columns) << name << ", " << width;
            EXPECT_NEAR(mean_alpha(mask), share, 1e-5) << name << ", " << width;
            columns = mask.columns;
        }
    }
}

TEST(Brush, RoundIsTheSameFromAllSides)
{
    const Brush brush = Brush::named("round");
    const Brush::Mask mask = brush.mask(1000.0f, 0);
    for (int y = 0; y < mask.rows; ++y)
        for (int x = 0; x < mask.columns; ++x) {
            const auto alpha = [&](int column, int row) {
                return mask.paint[row * mask.columns + column].alpha;
            };
            ASSERT_NEAR(alpha(x, y), alpha(mask.columns - 1 - x, y), 1e-6f);
            ASSERT_NEAR(alpha(x, y), alpha(x, mask.rows - 1 - y), 1e-6f);
        }
    EXPECT_EQ(mask.at(0.5f, 0.5f).alpha, 1.0f);
    EXPECT_EQ(mask.at(0.0f, 0.0f).alpha, 0.0f);
}

TEST(Brush, VariationPicksOneOfSeveralMasks)
{
    const auto differs = [](const Brush::Mask& a, const Brush::Mask& b) {
        for (int i = 0; i < a.columns * a.rows; ++i)
            if (a.paint[i].alpha != b.paint[i].alpha || a.paint[i].height != b.paint[i].height)
                return true;
        return false;
    };
    const Brush bristle = Brush::named("bristle"), again = Brush::named("bristle"), round = Brush::named("round");
    EXPECT_TRUE(differs(bristle.mask(64.0f, 0), bristle.mask(64.0f, 1)));
    EXPECT_FALSE(differs(bristle.mask(64.0f, 5), again.mask(64.0f, 5)));
    EXPECT_FALSE(differs(round.mask(64.0f, 0), round.mask(64.0f, 1)));
}

TEST(Brush, PictureIsStretchedOverTheWholeMask)
{
    const std::vector<float> alpha { 0.25f, 0.75f };
    const Brush brush = Brush::from_picture(2, 1, alpha.data(), nullptr);
    EXPECT_TRUE(brush.stretched());
    const Brush::Mask mask = brush.mask(1000.0f, 7);
    for (const float v : { 0.1f, 0.5f, 0.9f }) {
        EXPECT_EQ(mask.at(0.2f, v).alpha, 0.25f);
        EXPECT_EQ(mask.at(0.8f, v).alpha, 0.75f);
        EXPECT_EQ(mask.at(0.2f, v).height, 0.5f);
    }
}

}  // namespace
