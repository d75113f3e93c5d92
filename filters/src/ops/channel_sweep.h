// SPDX-License-Identifier: BSD-3-Clause
// All colour channels swept together.
#pragma once

#include <vector>

#include "source/progressive_image_data.h"

namespace pimg {
inline namespace PIMG_ABI {

/// What the details of every split, times gains[i] with i the split's number in the hierarchy, add to the base mesh: a raster
/// of mesh pixels for each channel. Residuals are left out.
void sweep_details(ProgressiveImage::Data& data, const PlannedChannels& planned, const std::vector<float>& gains,
                   const ParallelFor& parallel, Channels& results);

/// The values of the vertices of M_i, i = `level`, in each channel. In scene-linear pictures those of coarser levels than the
/// finest are kept from undershooting; see shade_vertices().
Channels values_of_level(const ProgressiveImage::Data& data, const ChannelBands& channels, Level level,
                         const ParallelFor& parallel);

/// Such values refined to all vertices without further details, each new one as the coarser mesh predicts it: a raster of mesh
/// pixels for each channel.
void predict_finest(ProgressiveImage::Data& data, const PlannedChannels& planned, Level level, const Channels& values,
                    const ParallelFor& parallel, Channels& results);

}  // namespace PIMG_ABI
}  // namespace pimg
