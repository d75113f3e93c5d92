// SPDX-License-Identifier: BSD-3-Clause
// The geometry of a progressive image (paper, section 3.3): the base mesh, the vertex splits that refine it, and the
// prediction stencil of each split. It holds no intensities; those are in Bands (bands.h). Once built it does not
// change, so any number of threads may read it. "The paper", here and in all headers, is Lee, Yoon and Lee (2008).
#pragma once

#include <cstddef>
#include <vector>

#include <pimg/mesh.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// One vertex split. Split i divides vertex s into t, which keeps the number of s, and u, which gets the number
/// base_vertices() + i. So the vertices of level i are those with numbers below base_vertices() + i.
struct Split {
    Index s;       ///< the vertex that is split; t keeps its number
    Index vl, vr;  ///< the vertices left and right of t -> u (drawing in mesh.h); kGhost outside the picture
    Point t, u;    ///< positions of t and u
};

/// One number for each of the two vertices that a split makes, such as the size of its piece.
struct SplitPair {
    float t, u;
};

/// How the coarser mesh predicts the intensities of t and u. `at` and `bt` are the other two vertices of the face of s
/// that t lies in, and `wat` and `wbt` their barycentric weights; the weight of s is 1 minus these two. `au`, `bu`,
/// `wau` and `wbu` are the same for u. With the intensities z:
///     prediction of t = z[s] + wat (z[at] - z[s]) + wbt (z[bt] - z[s])
struct Stencil {
    Index s;
    Index at, bt, au, bu;
    float wat, wbt, wau, wbu;
};

/// Value at a point of a triangle whose corners have the values s, a and b; `wa` and `wb` are the point's barycentric
/// weights of a and b. All that is interpolated in a mesh is interpolated by this sum, in this order, so that the same
/// point has the same bits everywhere.
inline float interpolate(float s, float a, float b, float wa, float wb)
{
    return s + (wa * (a - s) + wb * (b - s));
}

/// What the coarser mesh predicts for t and u. `Places` is a Stencil, or has its members and says where the values of
/// the five vertices are in `z`.
template<class Places>
SplitPair predict(const Places& k, const float* z)
{
    const float s = z[k.s];
    return { interpolate(s, z[k.at], z[k.bt], k.wat, k.wbt), interpolate(s, z[k.au], z[k.bu], k.wau, k.wbu) };
}

/// A mesh pixel that is not a vertex of the finest mesh. a, b and c are the mesh pixels at the corners of the face that
/// covers it, the smallest first. wb and wc are the barycentric weights of b and c. With the intensities z:
///     interpolation = z[a] + wb (z[b] - z[a]) + wc (z[c] - z[a])
struct PixelStencil {
    Index pixel, a, b, c;
    float wb, wc;
};

/// A level of a hierarchy: the number of splits applied to the base mesh, 0 .. Hierarchy::levels().
using Level = Index;

/// Base mesh, splits and stencils of one picture. Splits are stored from coarse to fine, and `stencils` and `costs` have
/// one entry per split.
class PIMG_EXPORT Hierarchy {
public:
    int width = 0, height = 0;             ///< size of the picture in pixels
    std::vector<Point> base_points;        ///< positions of the base vertices
    std::vector<Triangle> base_triangles;  ///< triangles of the base mesh
    std::vector<Split> splits;             ///< coarse to fine
    std::vector<Stencil> stencils;         ///< prediction of each split
    std::vector<float> costs;   ///< cost of the collapse that each split undoes; never increases from split to split
    std::vector<Index> pixels;  ///< number (row-major) of the mesh pixel where each vertex is at the finest level
    std::vector<PixelStencil> between;  ///< mesh pixels that are no vertex, increasing; empty with one vertex per pixel

    Index base_vertices() const { return Index(base_points.size()); }
    Level levels() const { return Level(splits.size()); }
    Index vertices() const { return base_vertices() + levels(); }
    bool empty() const { return base_points.empty(); }

    /// Size of the mesh's grid in pixels. It is the picture's, but for pictures one pixel wide or high: these have no
    /// area, so their only column or row is repeated, and the grid is never below 2 x 2.
    int mesh_width() const { return width < 2 ? 2 : width; }
    int mesh_height() const { return height < 2 ? 2 : height; }
    std::size_t mesh_pixels() const { return std::size_t(mesh_width()) * std::size_t(mesh_height()); }
    /// The lower right corner of the grid, in lattice units.
    Point extent() const { return { (mesh_width() - 1) * kSubpixels, (mesh_height() - 1) * kSubpixels }; }

    /// The finest level with at most `count` vertices, or at most `count` faces; level 0 if the base mesh has more. And
    /// the coarsest level from which no further split costs more than `error`, in the units of `costs`.
    Level level_of_vertices(double count) const;
    Level level_of_faces(double count) const;
    Level level_of_error(double error) const;

    /// Bytes held.
    std::size_t memory() const;
};

/// Makes the mesh M_i of level i = `level` by applying the first `level` splits to the base mesh. A level above the finest
/// counts as the finest. If `coarse` is not null, it receives the position that the vertex s of each of these splits had
/// before the split. Fails only on a damaged hierarchy; `mesh` is then unchanged.
PIMG_EXPORT Status refine(const Hierarchy& hierarchy, Level level, Mesh& mesh, std::vector<Point>* coarse = nullptr);

/// Computes `between` from the other members. Files do not store it, so whoever reads a hierarchy from a file calls
/// this afterwards. Fails only on a damaged hierarchy.
PIMG_EXPORT Status find_pixels_between(Hierarchy& hierarchy);

/// Checks a hierarchy: all its numbers, every stencil against the mesh it belongs to, and the finest mesh. For that it
/// replays every split, which is slow; it is meant for tests and tools. The message names what is wrong.
PIMG_EXPORT Status validate(const Hierarchy& hierarchy);

}  // namespace PIMG_ABI
}  // namespace pimg
