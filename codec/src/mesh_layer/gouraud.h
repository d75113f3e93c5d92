// SPDX-License-Identifier: BSD-3-Clause
// Shows a mesh by integers only, so that every reader gets the same samples.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/mesh.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The mesh layer: a coarse mesh and the values of each channel at its vertices (at most 18 bits).
struct MeshLayer {
    Mesh mesh;
    std::vector<std::vector<std::int32_t>> values;
};

/// Its triangles, smallest vertex first, in increasing order.
std::vector<Triangle> ordered_triangles(const Mesh& mesh);

/// A run of numbers in memory that someone else keeps.
struct IndexRun {
    const Index *first = nullptr, *last = nullptr;
    const Index* begin() const { return first; }
    const Index* end() const { return last; }
};

/// Numbers of the triangles that touch each cell of a grid over the pixels. The cells are the raster tiles, or squares
/// of 2, 4, 8 ... of them by as many where the lists of all tiles would be long for so few triangles: memory is
/// proportional to the triangles, whatever their shape and the size of the picture.
class TriangleGrid {
public:
    TriangleGrid() = default;
    /// Raster tiles of `tile` pixels.
    TriangleGrid(const Mesh& mesh, std::uint32_t tile);
    const std::vector<Triangle>& triangles() const { return m_triangles; }
    /// Numbers, increasing, among them those of all triangles that touch this tile.
    IndexRun at(std::uint32_t column, std::uint32_t row) const
    {
        const std::size_t cell = std::size_t(row >> m_shift) * m_columns + (column >> m_shift);
        return { m_numbers.data() + m_starts[cell], m_numbers.data() + m_starts[cell + 1] };
    }
    std::size_t entries() const { return m_numbers.size(); }

private:
    bool count(const Mesh& mesh, std::int64_t side, std::size_t cells);

    std::vector<Triangle> m_triangles;
    std::vector<std::size_t> m_starts;  ///< of each cell's numbers, and where the last ones end
    std::vector<Index> m_numbers;
    std::uint32_t m_columns = 0;
    int m_shift = 0;
};

/// Rows of pixels that the triangles cross, summed over them, when `rows` of the picture's `of_rows` are shown: what
/// showing them takes. A hostile mesh is all slivers from top to bottom.
std::uint64_t crossed_rows(const Mesh& mesh, const std::vector<Triangle>& triangles, std::uint32_t rows,
                           std::uint32_t of_rows);

/// The most rows that may be crossed to show so many pixels (docs/format.md, section 5). The writer keeps to it.
inline std::uint64_t most_crossed_rows(std::uint64_t pixels, std::size_t triangles)
{
    return 16 * pixels + 8 * std::uint64_t(triangles) + 65536;
}

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
void fill(const Mesh& mesh, const std::vector<Triangle>& triangles, IndexRun numbers,
          const std::vector<std::int32_t>& values, int shift, const SamplePoints& points, std::int32_t* samples);

}  // namespace PIMG_ABI
}  // namespace pimg
