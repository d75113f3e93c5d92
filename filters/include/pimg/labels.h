// SPDX-License-Identifier: BSD-3-Clause
// Pictures of labels: whole numbers from 0 in the first channel, not scaled between integers and floats as other pixels
// are.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <pimg/types.h>

namespace pimg {

/// Metadata of such a picture: int, how many labels there are.
constexpr const char kLabelCount[] = "pimg:labels";

/// Largest label that pixels of a type hold exactly, with all smaller ones.
double largest_label(OIIO::TypeDesc type);

/// Writes the labels of `roi`, below `count`, to the first channel of `dst`, which holds its pixels in memory: rows of
/// `stride` labels, the first for the corner of `roi`. False, with an error in `dst`, if its type cannot hold them.
bool write_labels(OIIO::ImageBuf& dst, OIIO::ROI roi, const Index* labels, std::size_t stride, Index count);

}  // namespace pimg
