// SPDX-License-Identifier: BSD-3-Clause
// The geometry of a progressive image (paper, section 3.3): the base mesh, the vertex splits that refine it, and
// the prediction stencil of each split. It holds no intensities; those are in Bands (bands.h). It does not change
// once built, so threads may share it.
#pragma once

#include <cstddef>
#include <vector>

#include <pimg/mesh.h>
#include <pimg/types.h>

namespace pimg {

/// One vertex split. Split i makes vertex base_vertices + i (= u) out of s,
/// whose number t keeps; so level i uses exactly the vertices below base_vertices + i.
struct Split {
    Index s;       ///< vertex that is split; keeps its number as t
    Index vl, vr;  ///< cut vertices, left and right of t -> u; kGhost on the border
    Point t, u;    ///< positions after the split
};

/// One number for each of the two vertices a split makes.
struct SplitPair {
    float t, u;
};

/// Where t and u lie in the coarser mesh: the face (s, a, b) and two of the
/// three barycentric weights, that of s being 1 - wa - wb.
///     prediction of t = z[s] + wat (z[at] - z[s]) + wbt (z[bt] - z[s])
struct Stencil {
    Index s;
    Index at, bt, au, bu;
    float wat, wbt, wau, wbu;
};

/// A pixel that is not a vertex of the finest mesh. a, b and c are the mesh pixels of the corners of the face that
/// covers it, the smallest first; wb and wc are the barycentric weights of b and c.
///     interpolation = z[a] + wb (z[b] - z[a]) + wc (z[c] - z[a])
struct PixelStencil {
    Index pixel, a, b, c;
    float wb, wc;
};

/// Level of a hierarchy: the number of splits applied to the base mesh.
using Level = Index;

class Hierarchy {
public:
    int width = 0, height = 0;       ///< size of the picture in pixels
    std::vector<Point> base_points;  ///< positions of the base vertices
    std::vector<Triangle> base_triangles;
    std::vector<Split> splits;      ///< coarse to fine
    std::vector<Stencil> stencils;  ///< of each split
    std::vector<float> costs;       ///< volume error each split removes; never increases
    std::vector<Index> pixels;      ///< mesh pixel (row-major) each vertex is at the finest level
    std::vector<PixelStencil>
        between;  ///< the other pixels, increasing: none unless the initial mesh was a simpler one

    Index base_vertices() const { return Index(base_points.size()); }
    Level levels() const { return Level(splits.size()); }
    Index vertices() const { return base_vertices() + levels(); }
    bool empty() const { return base_points.empty(); }

    /// Size of the mesh's grid. A picture one pixel wide or high has no area: its mesh repeats
    /// the row or column, so that the grid is never below 2 x 2.
    int mesh_width() const { return width < 2 ? 2 : width; }
    int mesh_height() const { return height < 2 ? 2 : height; }
    std::size_t mesh_pixels() const { return std::size_t(mesh_width()) * std::size_t(mesh_height()); }
    Point extent() const { return { (mesh_width() - 1) * kSubpixels, (mesh_height() - 1) * kSubpixels }; }

    /// Level with at most the given number of vertices or faces (at least the base), or
    /// the coarsest level whose remaining splits all cost no more than `error`.
    Level level_of_vertices(double count) const;
    Level level_of_faces(double count) const;
    Level level_of_error(double error) const;

    std::size_t memory() const;
};

/// Makes the mesh M_i of level i = `level`, with its topology, by replaying the first `level` splits. `coarse`, if not
/// null, receives for each of these splits the position of the vertex s before the split. Fails only on a damaged
/// hierarchy.
Status refine(const Hierarchy& hierarchy, Level level, Mesh& mesh, std::vector<Point>* coarse = nullptr);

/// Computes `between` from the other members. A file does not store it, so call this after reading a hierarchy from
/// one. Fails only on a damaged hierarchy.
Status find_pixels_between(Hierarchy& hierarchy);

/// Checks all numbers and stencils, and the topology by replaying every split. It is slow, and meant for tests and
/// tools.
Status validate(const Hierarchy& hierarchy);

}  // namespace pimg
