// SPDX-License-Identifier: BSD-3-Clause
// From two renditions of a picture to the gains between them, and back.
#pragma once

#include <vector>

#include <OpenImageIO/imagebuf.h>
#include <pimg/gain_map.h>

#include "gain_metadata.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Display-linear RGB, row by row, three samples a pixel.
struct Light {
    int width = 0, height = 0;
    std::vector<float> rgb;
};

/// A map of 1 or 3 channels, 0..1, and its numbers.
struct GainMap {
    GainMetadata metadata;
    OIIO::ImageBuf pixels;
    bool half_colour = false;  ///< made for a stream that keeps colour at half the resolution
};

/// The map that comes closest, in the mean square of stops, to making `rendition` of `base` once it is interpolated to the
/// size of both; scale=0 finds the scale. Its headroom is that of the brightest 0.1 % of the rendition's pixels. All
/// channels share one range: some decoders understand no other.
GainMap make_gain_map(const Light& base, const Light& rendition, const GainMapOptions& options);

/// Changes `light`, the base, to what a display with `headroom` stops above SDR white shows; the whole rendition if that
/// is below 0. The map's samples are interpolated linearly between their centres.
void apply_gain_map(const OIIO::ImageBuf& map, const GainMetadata& metadata, double headroom, Light& light);

}  // namespace PIMG_ABI
}  // namespace pimg
