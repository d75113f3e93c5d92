// SPDX-License-Identifier: BSD-3-Clause
// The exposure of a shot's frames, of what was measured in them.
#include "shot.h"

#include <cmath>

#include <gtest/gtest.h>

namespace pimg {
namespace {

TEST(Shot, SmoothFollowsADriftToItsEndsAndLockDoesNot)
{
    Shot shot;
    for (int frame = 1; frame <= 24; ++frame) {
        const float drift = std::exp2(0.02f * float(frame)), noise = std::exp2(frame % 2 ? 0.05f : -0.05f);
        shot.add(frame, { 4.0f, drift * noise, 0.0f });
    }
    ShotOptions smooth, lock;
    lock.mode = "lock";
    for (int frame : { 1, 2, 12, 23, 24 }) {
        EXPECT_NEAR(std::log2(shot.anchors(frame, smooth).key), 0.02f * float(frame), 0.015f) << frame;
        EXPECT_NEAR(std::log2(shot.anchors(frame, lock).key), 0.25f, 1e-3f) << frame;
        EXPECT_FLOAT_EQ(shot.anchors(frame, smooth).dmax, 4.0f);
        EXPECT_EQ(shot.anchors(frame, smooth).white, 0.0f);  // none was found in any
    }
}

}  // namespace
}  // namespace pimg
