// SPDX-License-Identifier: BSD-3-Clause
// Figures of each region of a segmentation, for spreadsheets and programs.
#pragma once

#include <string>
#include <vector>

#include "ops/regions/partition.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Writes one record per region to `filename`: JSON if its extension says so, else CSV with a header line. Fields:
/// label, pixels, centroid x and y, bounding box xmin ymin xmax ymax (inclusive), and mean and standard deviation of
/// every channel, in the picture's own coordinates and units. Where sides of the picture meet, the centroid of a region
/// that crosses the seam is the mean on the circle. Returns false with a line in `error` when the file cannot be written.
bool write_region_report(const ProgressiveImage::Data& data, const Partition& regions, const std::string& filename,
                         std::string& error);

}  // namespace PIMG_ABI
}  // namespace pimg
