// SPDX-License-Identifier: BSD-3-Clause
// The guide: the channels of a picture that decide the geometry of its hierarchy.
#pragma once

#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The most channels a guide may have.
constexpr int kMaxGuideChannels = 16;

/// One channel of a guide: finite samples, one per pixel, row-major. The samples should span a range of the order of
/// 255, so that one unit is about one step of an 8-bit picture: heights and distances in pixels are compared with each
/// other during simplification, and this is the scale it was tuned for.
struct GuideChannel {
    const float* samples = nullptr;
    float weight = 1.0f;  ///< factor on its volume error in the cost of a collapse; above 0
};

/// The channels that decide the geometry, 1 to kMaxGuideChannels of them, and their size in pixels. They share the
/// position of each vertex: the one that minimises the weighted sum of the channels' volume errors. At that position
/// every channel has its own intensity, the one that keeps its own volume.
struct Guide {
    int width = 0, height = 0;
    std::vector<GuideChannel> channels;
};

}  // namespace PIMG_ABI
}  // namespace pimg
