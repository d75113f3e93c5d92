// SPDX-License-Identifier: BSD-3-Clause
// Pictures of labels, such as region numbers: the first channel holds whole numbers from 0. Other samples are scaled when
// whole numbers are converted to floats and back (255 becomes 1); labels keep their value.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The metadata of such a picture that says how many labels there are; an int.
constexpr const char kLabelCount[] = "pimg:labels";

/// The largest label up to which a type of sample holds all labels exactly.
PIMG_EXPORT double largest_label(const OIIO::TypeDesc& type);

/// Writes labels to the first channel of `dst`, inside `roi`. `labels` begins with the label of the upper left pixel of
/// `roi`; each row is `stride` labels after the one above. Labels are below `count`. `dst` must hold its pixels in memory.
/// If its type cannot hold all labels, returns false and sets the error of `dst`.
PIMG_EXPORT bool write_labels(OIIO::ImageBuf& dst, OIIO::ROI roi, const Index* labels, std::size_t stride, Index count);

}  // namespace PIMG_ABI
}  // namespace pimg
