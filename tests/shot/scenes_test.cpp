// SPDX-License-Identifier: BSD-3-Clause
// Cuts, fades, flashes and black frames, told from what frames measure.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenes.h"

namespace pimg {
namespace {

constexpr double kBlack = -1000.0;

/// Roles of frames 1, 2, ... of this light, in stops, as text: the scene's number where steady, else a dot.
std::string roles(const std::vector<double>& stops, const std::vector<int>& told = {}, bool finds_cuts = true)
{
    std::vector<FrameFigures> frames;
    frames.reserve(stops.size());
    for (const double s : stops)
        frames.push_back(
            { int(frames.size()) + 1, s == kBlack ? std::vector<double>() : std::vector<double> { s, 1.0 } });
    std::string text;
    for (const FrameRole& role : find_scenes(frames, told, finds_cuts))
        text += role.steady ? char('0' + role.scene) : '.';
    return text;
}

TEST(Scenes, DriftAndSwingAreNoEvent)
{
    std::vector<double> stops;
    stops.reserve(40);
    for (int i = 0; i < 40; ++i)
        stops.push_back(0.03 * i + 0.15 * std::sin(i / 3.0));
    EXPECT_EQ(roles(stops), std::string(40, '0'));
}

TEST(Scenes, BlackFramesAreNotSteady)
{
    EXPECT_EQ(roles({ 0, 0, 0, kBlack, 0, 0, 0 }), "000.000");
    EXPECT_EQ(roles({ 0, 0, 0, -14, 0, 0, 0 }), "000.000");  // noise
    EXPECT_EQ(roles({ kBlack, kBlack }), "..");
    EXPECT_EQ(roles({ 3 }), "0");
    EXPECT_EQ(roles({}), "");
}

TEST(Scenes, FadesAreNotSteady)
{
    EXPECT_EQ(roles({ 0, 0, 0, -0.3, -0.7, -1.3, -2.3, kBlack }), "000.....");
    EXPECT_EQ(roles({ kBlack, -2.3, -1.3, -0.7, -0.3, 0, 0, 0 }), ".....000");
    EXPECT_EQ(roles({ 0, 0, 0, -0.3, -0.7, -1.3, -2.3 }), "000....");
    EXPECT_EQ(roles({ 0, 0, 0.02, 0.01, kBlack, 0, 0.01 }), "0000.00");  // next to black, but no fade
}

TEST(Scenes, FlashesAreNotSteady)
{
    EXPECT_EQ(roles({ 0, 0.1, 0, 3, 0, 0.1, 0, 0.1 }), "000.0000");
    EXPECT_EQ(roles({ 0, 0.1, 0, 0.1, 3, 3, 0.1, 0, 0.1, 0 }), "0000..0000");
}

TEST(Scenes, CutsBeginScenes)
{
    EXPECT_EQ(roles({ 0, 0, 0, 0, 2, 2, 2, 2 }), "00001111");
    EXPECT_EQ(roles({ 0, 0, 0, 0, 2, 2, 2, 2 }, {}, false), "00000000");
    EXPECT_EQ(roles({ 0, 0, 0, 0, 0, 0 }, { 1, 4 }, false), "000111");
    EXPECT_EQ(roles({ 0, 0, 0, -0.7, -2, kBlack, 0, 1.4, 2, 2, 2 }), "000.....111");
}

}  // namespace
}  // namespace pimg
