// SPDX-License-Identifier: BSD-3-Clause
// The channels of a picture in memory: Raster and Channels own their samples, and ChannelsView points at samples that
// somebody else owns. Samples are floats, one per pixel, row-major, without gaps. The channels that decide the geometry
// have a type of their own, Guide (guide.h). So have samples of other types and layouts: StridedChannel (codec.h).
#pragma once

#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// One channel that knows its size in pixels.
struct Raster {
    int width = 0, height = 0;
    std::vector<float> samples;  ///< width * height of them, row-major
};

/// The samples of all channels of one picture: one vector per channel. The size is known from elsewhere, for example
/// from a hierarchy.
using Channels = std::vector<std::vector<float>>;

/// A view of channels that somebody else owns and keeps alive. All have the same size in pixels.
struct ChannelsView {
    int width = 0, height = 0;
    std::vector<const float*> channels;
};

using Rasters [[deprecated("use Channels")]] = Channels;

}  // namespace PIMG_ABI
}  // namespace pimg
