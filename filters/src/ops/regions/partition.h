// SPDX-License-Identifier: BSD-3-Clause
// What the filters make of a partition of the picture: its labels, means or boundaries.
#pragma once

#include <string>
#include <vector>

#include "frame/image_filter.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Every pixel's part, of the picture without margins.
struct Partition {
    Index count = 0;            ///< of the parts
    std::vector<Index> labels;  ///< row-major, 0 .. count - 1
};

/// prepare() for the output "labels", "mean" or "boundaries": one channel, or all of the source's.
bool prepare_partition(OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI& roi, const std::string& output);

/// Writes the output to `dst`. False, with an error there, if its pixels cannot hold the labels.
bool write_partition(OIIO::ImageBuf& dst, const ProgressiveImage::Data& data, OIIO::ROI roi,
                     const ParallelFor& parallel, const Partition& partition, const std::string& output);

}  // namespace PIMG_ABI
}  // namespace pimg
