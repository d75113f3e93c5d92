// SPDX-License-Identifier: BSD-3-Clause
// The finest mesh of a hierarchy that does not start from every pixel: which pixels are its vertices, and its
// triangles. Such meshes are Delaunay but for ties and a few flips, so a triangle costs next to nothing: Delaunay's
// rule names the vertex that belongs to an edge, and only where it is wrong is the right one written.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/hierarchy.h>

#include "entropy/bytes.h"
#include "sequence/collapse_mesh.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Writes the finest mesh of `h` and connects `mesh` the way reading will. `guide` is diagonal_guide().
Bytes write_initial_mesh(const Hierarchy& h, const Mesh& finest, const std::vector<std::int32_t>& guide,
                         CollapseMesh& mesh);

/// Connects the vertices of `mesh` that were chosen; the others stay dead. False when the bytes are damaged.
bool read_initial_mesh(const std::uint8_t* data, std::size_t size, const std::vector<std::int32_t>& guide,
                       CollapseMesh& mesh);

}  // namespace PIMG_ABI
}  // namespace pimg
