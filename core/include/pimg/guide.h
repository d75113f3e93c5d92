// SPDX-License-Identifier: BSD-3-Clause
// What decides the geometry of a progressive image.
#pragma once

#include <vector>

namespace pimg {

/// Most channels that may decide the geometry together.
constexpr int kMaxGuideChannels = 16;

/// One of the channels that decide the geometry: finite samples, one per pixel, row-major. One unit is about one
/// step of an 8-bit picture: |samples| should be of the order of 255 so that noise and features are told apart
/// on the right scale.
struct GuideChannel {
    const float* samples = nullptr;
    float weight = 1.0f;  ///< of its volume error in the cost, > 0
};

/// What decides the geometry. With several channels each keeps its own volume, so its own intensity follows from the
/// position, and the one position they share minimises the weighted sum of their volume errors.
struct Guide {
    int width = 0, height = 0;
    std::vector<GuideChannel> channels;
};

}  // namespace pimg
