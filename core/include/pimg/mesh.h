// SPDX-License-Identifier: BSD-3-Clause
// Topology of a height-field triangle mesh M_i: vertices, their rings, and the two inverse
// operations of the paper (section 3.1), edge collapse and vertex split.
//
//            vl                         vl
//          /  |  \                     / \ .
//         /   |   \     collapse      /   \ .
//       t ----+---- u   -------->    |  s  |          t keeps its number and is then called s
//         \   |   /     <--------     \   /           vl is left of t -> u, vr right
//          \  |  /        split        \ /
//            vr                         vr
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <pimg/ring.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// A triangle by the numbers of its three vertices, positively oriented (doubled_area() in types.h is above 0).
using Triangle = std::array<Index, 3>;

/// The neighbours of one vertex, in the order of its Ring. Valid until the mesh changes.
struct RingView {
    const Index* first;
    int degree;
    const Index* begin() const { return first; }
    const Index* end() const { return first + degree; }
    Index operator[](int i) const { return first[i]; }
};

/// A triangulation of the rectangle between the centres of the picture's four corner pixels, [0, width-1] x
/// [0, height-1]. Vertices are numbered 0 .. size()-1, and all of these numbers are in use.
class PIMG_EXPORT Mesh {
public:
    Mesh() = default;

    /// Makes a mesh of positively oriented triangles over `points`. `extent` is the lower right corner of the
    /// rectangle, in lattice units; the upper left one is (0, 0). Fails when the triangles do not triangulate the
    /// rectangle; `mesh` is then unchanged.
    static Status from_triangles(std::vector<Point> points, const std::vector<Triangle>& triangles, Point extent,
                                 Mesh& mesh);

    Index size() const { return Index(m_points.size()); }
    Point extent() const { return m_extent; }
    Point point(Index v) const { return m_points[v]; }
    RingView ring(Index v) const { return { m_rings[v].v.data(), m_degrees[v] }; }

    /// Every triangle once, beginning with its smallest vertex number, sorted by that number.
    std::vector<Triangle> triangles() const;
    /// Number of triangles: with n vertices, b of them on the border, 2 n - 2 - b.
    std::size_t triangle_count() const;

    /// Splits vertex s in two. One of them keeps the number s and moves to position `t`; the other gets the number
    /// size() and position `u`. vl and vr must be different neighbours of s; either may be kGhost. Returns false and
    /// leaves the mesh as it was when they are not, or when a vertex would get more than kMaxDegree neighbours.
    bool split(Index s, Index vl, Index vr, Point t, Point u);

    /// The inverse of the last split: removes vertex size()-1 by merging it into its neighbour s, which moves to `p`.
    /// Returns false and leaves the mesh as it was when the two are no neighbours, when the link condition fails, that is
    /// when they have other common neighbours than vl and vr, and when a vertex would get too many or too few
    /// neighbours (fewer than 3, or more than kMaxDegree).
    bool collapse(Index s, Point p);

    /// Checks every invariant of a mesh. Neighbourhood is mutual, and every ring closes. A border vertex has the ghost
    /// as a neighbour once, and lies on a side of the rectangle. The four corners are vertices. Triangles are positively
    /// oriented, and their areas add up to the rectangle's, so they cover it once. The message names what is wrong.
    Status validate() const;

    /// Reserves memory for a mesh that will grow to `vertices` vertices.
    void reserve(std::size_t vertices);

    /// Hints to the processor that vertex v, or its neighbours, will be used soon. This only affects speed. Nothing
    /// happens if there is no such vertex.
    void prefetch(Index v) const;
    void prefetch_around(Index v) const;

private:
    std::vector<Point> m_points;
    std::vector<Ring> m_rings;
    std::vector<std::uint8_t> m_degrees;
    Point m_extent;
};

}  // namespace PIMG_ABI
}  // namespace pimg
