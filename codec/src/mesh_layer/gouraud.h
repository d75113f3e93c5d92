// SPDX-License-Identifier: BSD-3-Clause
// Shows a mesh by integers only, so that every reader gets the same samples.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/mesh.h>

namespace pimg {

/// The mesh layer: a coarse mesh and the values of each channel at its vertices (at most 18 bits).
struct MeshLayer {
    Mesh mesh;
    std::vector<std::vector<std::int32_t>> values;
};

/// Its triangles, smallest vertex first, in increasing order.
std::vector<Triangle> ordered_triangles(const Mesh& mesh);

/// Numbers of the triangles that touch each cell of a grid over the pixels.
class TriangleGrid {
public:
    TriangleGrid() = default;
    /// Cells of `cell` pixels; the grid is that of the raster tiles.
    TriangleGrid(const Mesh& mesh, std::uint32_t cell);
    const std::vector<Triangle>& triangles() const { return m_triangles; }
    const std::vector<Index>& at(std::uint32_t column, std::uint32_t row) const
    {
        return m_cells[std::size_t(row) * m_columns + column];
    }

private:
    std::vector<Triangle> m_triangles;
    std::vector<std::vector<Index>> m_cells;
    std::uint32_t m_columns = 0;
};

/// Pixels at which a mesh is sampled: columns xs and rows ys, increasing.
struct SamplePoints {
    std::vector<std::int32_t> xs, ys;
    static SamplePoints rectangle(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height);
    /// width x height points spread over extent_x x extent_y pixels.
    static SamplePoints spread(std::uint32_t extent_x, std::uint32_t extent_y, std::uint32_t width,
                               std::uint32_t height);
};

/// Values of one channel at the sample points, row-major. Where triangles meet, the last in order counts. `numbers`
/// picks from `triangles`, in increasing order.
void fill(const Mesh& mesh, const std::vector<Triangle>& triangles, const std::vector<Index>& numbers,
          const std::vector<std::int32_t>& values, int shift, const SamplePoints& points, std::int32_t* samples);

}  // namespace pimg
