// SPDX-License-Identifier: BSD-3-Clause
// The channels of a picture in memory: one that owns its samples, several that do, and a view of some that others own.
// Samples are floats, one per pixel, row-major, without gaps. What decides the geometry is a Guide (guide.h); samples
// of any type in the caller's own layout are StridedChannels (codec.h).
#pragma once

#include <vector>

namespace pimg {

/// One channel and its size in pixels.
struct Raster {
    int width = 0, height = 0;
    std::vector<float> samples;  ///< width * height of them
};

/// The samples of all channels of one picture, whose size is known from elsewhere, such as a hierarchy.
using Channels = std::vector<std::vector<float>>;

/// Channels that somebody else owns and keeps alive, all of one size in pixels.
struct ChannelsView {
    int width = 0, height = 0;
    std::vector<const float*> channels;
};

using Rasters [[deprecated("use Channels")]] = Channels;

}  // namespace pimg
