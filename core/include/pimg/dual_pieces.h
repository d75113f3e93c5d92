// SPDX-License-Identifier: BSD-3-Clause
// Dual pieces (paper, section 4.2): a partition of the picture's pixels at every level. The piece of a vertex of M_i is
// the set of pixels whose vertices were merged into it. A split divides one piece in two; so pieces are nested, and each
// is a union of pieces of any finer level.
#pragma once

#include <vector>

#include <pimg/hierarchy.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The pieces of all levels of one hierarchy, stored in three numbers per vertex and two per pixel.
///
/// The pixels are put in an order, the nested order, in which *every piece of every level is one contiguous run*. A
/// vertex's run begins with its own pixels; the runs of the vertices that were split from it follow, the youngest first.
/// When a vertex is split, its piece loses the end of its run to the new vertex.
///
/// A piece has the number of its vertex, 0 .. count(level) - 1. In a split, t keeps the number of s, so the piece of a
/// number becomes smaller from level to level but stays in its place. No piece is empty, but for pictures one pixel wide
/// or high: their mesh repeats the row or column, and a vertex of the copy may own no pixel of the picture.
///
/// If the initial mesh had fewer vertices than pixels, a pixel that is no vertex belongs to that corner of its face which
/// has the largest barycentric weight.
///
/// A piece is connected along the edges of the finest mesh. With a vertex for every pixel, these are the sides of pixels
/// and one diagonal of every square of four pixels. A piece may therefore consist of several 4-connected parts;
/// connected_parts() gives these numbers of their own.
class PIMG_EXPORT DualPieces {
public:
    DualPieces() = default;

    /// Makes the pieces of a hierarchy, which is not needed afterwards. Fails only on a damaged hierarchy.
    static Status from_hierarchy(const Hierarchy& hierarchy, DualPieces& pieces);

    int width() const { return m_width; }
    int height() const { return m_height; }
    Level levels() const { return Level(m_parents.size()) - m_base; }
    /// The number of pieces at a level 0 .. levels(): that of the vertices of M_i.
    Index count(Level level) const { return m_base + level; }

    /// The piece of every pixel of the picture at a level, row-major. Takes time proportional to the number of pixels.
    std::vector<Index> labels(Level level) const;

    /// The piece at `level` that contains piece `v` of a finer level; `v` itself if it is a piece of `level`.
    Index ancestor(Index v, Level level) const;

    /// The pixels of piece `v` at the level where vertex v appears (0 for a base vertex), as row-major pixel numbers in
    /// nested order. At a finer level, piece v consists of the first sizes(level)[v] of them. Valid as long as this
    /// object.
    struct Run {
        const Index* first;
        Index size;
        const Index* begin() const { return first; }
        const Index* end() const { return first + size; }
    };
    Run run_at_birth(Index v) const { return { m_order.data() + m_first[v], m_span[v] }; }

    /// The number of pixels of every piece at a level. Takes time proportional to the number of pieces.
    std::vector<Index> sizes(Level level) const;

private:
    int m_width = 0, m_height = 0;
    Index m_base = 0;
    std::vector<Index> m_parents;    ///< vertex that each vertex was split from; for base vertices their own number
    std::vector<Index> m_vertex_of;  ///< finest vertex of each pixel of the picture
    std::vector<Index> m_order;      ///< pixels of the picture in nested order
    std::vector<Index> m_first;      ///< start of each vertex's run in m_order
    std::vector<Index> m_span;       ///< pixels of each vertex's run at its birth
};

/// The means of one channel over the dual pieces of all levels. They differ from the values of the vertices: a mean over
/// a large piece no longer shows its texture, while the value of a vertex may.
struct PieceMeans {
    std::vector<float> base;        ///< mean of the piece of each base vertex
    std::vector<SplitPair> splits;  ///< means of the pieces of t and u, for each split
};

/// A border: two labels whose pixels touch along pixel sides, a < b.
struct Border {
    Index a, b;
    Index length;  ///< number of pixel sides they share
};

/// All borders of a label image (row-major, width x height), sorted by a, then by b.
PIMG_EXPORT std::vector<Border> borders(const std::vector<Index>& labels, int width, int height);

/// Replaces labels by numbers of connected parts: every 4-connected part of every label gets a number of its own, from 0
/// in the order of the parts' first pixels (row-major). Returns how many parts there are.
PIMG_EXPORT Index connected_parts(std::vector<Index>& labels, int width, int height);

/// The mean of a channel over each label 0 .. count - 1; 0 for a label without pixels. `samples` are finite, one per entry
/// of `labels`.
PIMG_EXPORT std::vector<float> label_means(const std::vector<Index>& labels, Index count, const float* samples);

/// A centre of gravity, in pixels.
struct Centroid {
    float x, y;
};

/// The centre of gravity of each label 0 .. count - 1; (0, 0) for a label without pixels. `width` is that of the picture.
PIMG_EXPORT std::vector<Centroid> label_centroids(const std::vector<Index>& labels, Index count, int width);

}  // namespace PIMG_ABI
}  // namespace pimg
