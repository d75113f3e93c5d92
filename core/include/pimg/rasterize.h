// SPDX-License-Identifier: BSD-3-Clause
// Gouraud images and wireframes of a mesh M_i.
#pragma once

#include <vector>

#include <pimg/mesh.h>
#include <pimg/types.h>

namespace pimg {

/// Interpolates `channels` values per vertex (channel c of vertex v at values[c][v]) over the mesh and
/// writes them at every pixel centre: samples[c] is row-major, mesh width x height.
/// Returns the number of pixels no triangle covers: 0 for a valid mesh.
std::size_t rasterize(const Mesh& mesh, const std::vector<const float*>& values, const std::vector<float*>& samples,
                      const ParallelFor& parallel = {});

/// Coverage 0..1 of the mesh's edges, drawn `width` pixels wide and anti-aliased, row-major
/// over an image `scale` times the mesh's size.
std::vector<float> wireframe(const Mesh& mesh, float line_width = 1.0f, int scale = 1);

}  // namespace pimg
