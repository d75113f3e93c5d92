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

using Triangle = std::array<Index, 3>;

/// The neighbours of a vertex as a range.
struct RingView {
    const Index* first;
    int degree;
    const Index* begin() const { return first; }
    const Index* end() const { return first + degree; }
    Index operator[](int i) const { return first[i]; }
};

/// A triangulation of the rectangle [0, width-1] x [0, height-1] pixels.
/// Vertices are numbered 0 .. size()-1 and all are in use.
class Mesh {
public:
    Mesh() = default;

    /// From positively oriented triangles over `points`; `extent` is the lower
    /// right corner. Fails when they are no such triangulation.
    static Status from_triangles(std::vector<Point> points, const std::vector<Triangle>& triangles, Point extent,
                                 Mesh& mesh);

    Index size() const { return Index(m_points.size()); }
    Point extent() const { return m_extent; }
    Point point(Index v) const { return m_points[v]; }
    RingView ring(Index v) const { return { m_rings[v].v.data(), m_degrees[v] }; }

    /// Every triangle once, smallest vertex number first, in order of that vertex.
    std::vector<Triangle> triangles() const;
    /// Number of triangles: 2 n - 2 - border vertices.
    std::size_t triangle_count() const;

    /// Splits s into t (number s, at `t`) and u (number size(), at `u`). vl and vr must be
    /// neighbours of s; either may be kGhost. Returns false, leaving the mesh
    /// untouched, when they are not or a ring would outgrow kMaxDegree.
    bool split(Index s, Index vl, Index vr, Point t, Point u);

    /// Inverse of the last split: merges vertex size()-1 into its neighbour s at `p`.
    /// Returns false when the edge does not exist or the link condition fails.
    bool collapse(Index s, Point p);

    /// Checks every invariant: symmetric rings, one ghost per border vertex, closed
    /// fans, positive triangles, corners in place, border on the sides, and area
    /// equal to the rectangle's (so nothing overlaps and nothing is uncovered).
    Status validate() const;

    void reserve(std::size_t vertices);

    /// Asks for the memory of a vertex, or of its neighbours, ahead of a split or collapse; of none if there is no such
    /// vertex.
    void prefetch(Index v) const;
    void prefetch_around(Index v) const;

private:
    std::vector<Point> m_points;
    std::vector<Ring> m_rings;
    std::vector<std::uint8_t> m_degrees;
    Point m_extent;
};

}  // namespace pimg
