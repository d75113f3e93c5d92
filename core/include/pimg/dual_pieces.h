// SPDX-License-Identifier: BSD-3-Clause
// Dual pieces (paper, section 4.2): the partition of the pixels at any level. The piece of a vertex of M_i is the
// set of pixels whose vertices were merged into it. Pieces are nested: a split divides one piece in two,
// so a piece is a union of pieces at every finer level.
#pragma once

#include <vector>

#include <pimg/hierarchy.h>
#include <pimg/types.h>

namespace pimg {

/// The pieces of all levels of one hierarchy in one structure of three numbers per vertex.
///
/// The pixels are put in an order in which *every piece of every level is one contiguous run*: a vertex's own, then
/// what it gave birth to, youngest first. A piece only ever loses the end of its run, to the vertex being born.
///
/// A piece has the number of its vertex, 0 .. count(level) - 1, and t keeps the number of s; so a number means
/// the same place at all levels. No piece is empty, but for pictures one pixel wide or high: their mesh repeats the row
/// or column, and a vertex of the copy may own no pixel of the picture.
///
/// A pixel that is no vertex of the finest mesh, when the initial mesh was a simpler one, belongs to the nearest corner
/// of its face, by barycentric weight.
///
/// A piece is connected along the edges of the finest mesh: with a vertex for every pixel, through pixel sides and one
/// diagonal per pixel quad. It may fall apart into several 4-connected parts; connected_parts() tells them apart.
class DualPieces {
public:
    DualPieces() = default;

    /// Fails only on a damaged hierarchy. The hierarchy is not kept.
    static Status from_hierarchy(const Hierarchy& hierarchy, DualPieces& pieces);

    int width() const { return m_width; }
    int height() const { return m_height; }
    Level levels() const { return Level(m_parents.size()) - m_base; }
    /// Pieces at a level = vertices of M_i.
    Index count(Level level) const { return m_base + level; }

    /// Piece of every pixel of the picture, row-major. O(pixels).
    std::vector<Index> labels(Level level) const;

    /// The piece at `level` that holds piece `v` of a finer level.
    Index ancestor(Index v, Level level) const;

    /// Pixels of piece `v` when vertex v is born (level 0 for a base vertex): a run in nested order.
    /// Later pieces of the same number are its first sizes(level)[v] pixels.
    struct Run {
        const Index* first;
        Index size;
        const Index* begin() const { return first; }
        const Index* end() const { return first + size; }
    };
    Run run_at_birth(Index v) const { return { m_order.data() + m_first[v], m_span[v] }; }

    /// Number of pixels of every piece at a level. O(level).
    std::vector<Index> sizes(Level level) const;

private:
    int m_width = 0, m_height = 0;
    Index m_base = 0;
    std::vector<Index> m_parents;    ///< vertex each was split from; itself for base vertices
    std::vector<Index> m_vertex_of;  ///< finest vertex of each pixel of the picture
    std::vector<Index> m_order;      ///< pixels of the picture in nested order
    std::vector<Index> m_first;      ///< start of each vertex's run in m_order
    std::vector<Index> m_span;       ///< pixels of each vertex's run at its birth
};

/// Means of one channel over the dual pieces of all levels. The larger a piece, the less texture its mean carries,
/// which the value of its vertex does not have.
struct PieceMeans {
    std::vector<float> base;        ///< of the pieces of the base vertices
    std::vector<SplitPair> splits;  ///< of the pieces of t and u of each split
};

/// Two pieces (or regions) that touch along pixel sides; a < b.
struct Border {
    Index a, b;
    Index length;  ///< pixel sides they share
};

/// All borders of a label image, ordered by (a, b).
std::vector<Border> borders(const std::vector<Index>& labels, int width, int height);

/// Gives every 4-connected part of every label a number of its own, 0-based, in order of its first pixel
/// (row-major). Returns their number.
Index connected_parts(std::vector<Index>& labels, int width, int height);

/// Mean of a channel (row-major, finite) over each of `count` labels; 0 for a label without pixels.
std::vector<float> label_means(const std::vector<Index>& labels, Index count, const float* samples);

/// Centre of gravity of each of `count` labels in pixels; (0, 0) for a label without pixels.
struct Centroid {
    float x, y;
};
std::vector<Centroid> label_centroids(const std::vector<Index>& labels, Index count, int width);

}  // namespace pimg
