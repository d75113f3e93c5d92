// SPDX-License-Identifier: BSD-3-Clause
// The light of a scene with another luminance, for what comes between a scene and its display: in * 2^gain.
#pragma once

#include "frame/image_filter.h"

namespace pimg {
inline namespace PIMG_ABI {

/// The factor on the light of every pixel; its base-2 logarithm is slope * compressed - guide / kUnitsPerStop + offset.
/// Both rasters are of the picture's size.
struct LightGain {
    float slope, offset;
    const float *compressed, *guide;
};

/// Writes the logarithms to the only channel of `dst`.
void write_gain(OIIO::ImageBuf& dst, const ProgressiveImage::Data& data, const OIIO::ROI& roi,
                const ParallelFor& parallel, const LightGain& gain);

/// Writes the picture times the factor, decoded if it is encoded. `all_light`: the colours of every layer that holds light
/// (holds_light()) get the same factor, so that what added up still does.
void write_scene_light(OIIO::ImageBuf& dst, const ProgressiveImage::Data& data, const OIIO::ROI& roi,
                       const ParallelFor& parallel, const LightGain& gain, bool all_light);

}  // namespace PIMG_ABI
}  // namespace pimg
