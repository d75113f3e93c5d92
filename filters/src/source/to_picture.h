// SPDX-License-Identifier: BSD-3-Clause
// From meshes back to rasters of the picture's size.
#pragma once

#include <vector>

#include <pimg/hierarchy.h>

namespace pimg {
inline namespace PIMG_ABI {

/// From a raster of the mesh's size to one of the picture's: the same, but for pictures one pixel wide or high.
void crop_to_picture(const Hierarchy& hierarchy, std::vector<float>& samples);

/// Multiplies samples by 2^exponent.
void scale_by_power(int exponent, std::vector<float>& samples);

}  // namespace PIMG_ABI
}  // namespace pimg
