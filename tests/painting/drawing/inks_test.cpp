// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/inks.h>

#include <algorithm>

#include <gtest/gtest.h>

using namespace pimg;

namespace {

// CIELAB of sRGB colours.
constexpr std::array<float, 3> kRed { 53.2f, 80.1f, 67.2f }, kPink { 76.0f, 38.6f, 17.0f },
    kBlue { 32.3f, 79.2f, -107.9f }, kGrey { 50.0f, 0.0f, 0.0f }, kNight { 5.0f, 1.0f, -3.0f },
    kWhite { 100.0f, 0.0f, 0.0f };

TEST(Inks, AreOfTheColoursOfTheRegions)
{
    const InkChoice choice = choose_inks({ { kRed, 100 }, { kBlue, 80 }, { kGrey, 500 }, { kNight, 100 } }, 3);
    ASSERT_EQ(choice.inks.size(), 3u);
    EXPECT_EQ(choice.inks[0].lightness, 0.0f);
    const auto& of = choice.ink_of_region;
    EXPECT_EQ(of[2], 0);
    EXPECT_EQ(of[3], 0);
    ASSERT_NE(of[0], of[1]);
    const std::array<float, 3>&red = choice.inks[of[0]].colour, &blue = choice.inks[of[1]].colour;
    EXPECT_GT(red[0], 0.8f);
    EXPECT_LT(red[2], 0.2f);
    EXPECT_LT(blue[0], 0.2f);
    EXPECT_GT(blue[2], 0.8f);
    EXPECT_NEAR(choice.inks[of[0]].lightness, kRed[0], 3.0f);
    EXPECT_NEAR(choice.inks[of[1]].lightness, kBlue[0], 3.0f);
}

TEST(Inks, ATintIsDrawnInTheInkItIsATintOf)
{
    const InkChoice choice = choose_inks({ { kRed, 100 }, { kPink, 100 }, { kBlue, 100 } }, 3);
    EXPECT_EQ(choice.ink_of_region[0], choice.ink_of_region[1]);
    EXPECT_NE(choice.ink_of_region[0], choice.ink_of_region[2]);
}

TEST(Inks, ThereAreNoMoreThanThereAreColours)
{
    EXPECT_EQ(choose_inks({ { kGrey, 100 }, { kNight, 50 }, { kWhite, 10 } }, 8).inks.size(), 1u);
    EXPECT_EQ(choose_inks({ { kRed, 100 }, { kBlue, 100 } }, 8).inks.size(), 3u);
    EXPECT_EQ(choose_inks({ { kRed, 100 }, { kBlue, 100 } }, 1).inks.size(), 1u);
    EXPECT_EQ(choose_inks({}, 4).inks.size(), 1u);
}

TEST(Inks, ShowOnWhite)
{
    for (const Ink& ink : choose_inks({ { kPink, 100 }, { { 95.0f, -20.0f, 40.0f }, 100 } }, 4).inks)
        EXPECT_LT(*std::min_element(ink.colour.begin(), ink.colour.end()), 0.41f);
}

}  // namespace
