// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a mesh M_i: its values interpolated over its triangles (Gouraud shading), and its edges as lines.
#pragma once

#include <vector>

#include <pimg/mesh.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Interpolates values given at the vertices linearly over each triangle, and writes the result at every pixel centre.
/// values[c][v] is the value of channel c at vertex v. samples[c] receives channel c: one float per pixel of the mesh's
/// grid, row-major; there must be as many entries in `samples` as in `values`. Pixels that no triangle covers are left
/// as they were. Returns their number, which is 0 for a valid mesh. The result does not depend on `parallel`.
PIMG_EXPORT std::size_t rasterize(const Mesh& mesh, const std::vector<const float*>& values,
                                  const std::vector<float*>& samples, const ParallelFor& parallel = {});

/// Draws the mesh's edges as anti-aliased lines. Returns how much of each pixel they cover, from 0 to 1, row-major. The
/// image has `scale` times the width and height of the mesh's grid, where `scale` is 1 or more. `line_width` is above 0,
/// in pixels of that image.
PIMG_EXPORT std::vector<float> wireframe(const Mesh& mesh, float line_width = 1.0f, int scale = 1);

}  // namespace PIMG_ABI
}  // namespace pimg
