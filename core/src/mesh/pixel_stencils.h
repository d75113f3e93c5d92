// SPDX-License-Identifier: BSD-3-Clause
// Which face of the finest mesh holds each pixel that is no vertex.
#pragma once

#include <vector>

#include <pimg/hierarchy.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Stencils of all pixels that are not in `pixels`, increasing. Triangles name their corners by mesh pixel, are
/// positively oriented and cover the picture; the order of triangles and corners does not matter.
std::vector<PixelStencil> pixel_stencils(int width, int height, const std::vector<Index>& pixels,
                                         const std::vector<Triangle>& triangles, const ParallelFor& parallel = {});

}  // namespace PIMG_ABI
}  // namespace pimg
