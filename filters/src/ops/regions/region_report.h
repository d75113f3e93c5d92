// SPDX-License-Identifier: BSD-3-Clause
// Figures of each region of a segmentation, for spreadsheets and programs.
#pragma once

#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/types.h>

namespace pimg {

/// Writes one record per region to `filename`: JSON if its extension says so, else CSV with a header line. Fields:
/// label, pixels, centroid x and y, bounding box xmin ymin xmax ymax (inclusive), and mean and standard deviation of
/// every channel of `picture` (float, local), in the picture's own coordinates and units. Returns false with a line in
/// `error` when the file cannot be written.
bool write_region_report(const OIIO::ImageBuf& picture, const std::vector<Index>& labels, Index regions,
                         const std::string& filename, std::string& error);

}  // namespace pimg
