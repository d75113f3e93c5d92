// SPDX-License-Identifier: BSD-3-Clause
// The mesh on which the collapse sequence is repeated: rings by pixel number.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <vector>

#include <pimg/detail/ring_edit.h>
#include <pimg/ring.h>
#include <pimg/types.h>

#include "entropy/symbol_coder.h"

namespace pimg {
inline namespace PIMG_ABI {

/// A ring in a cache line of its own.
struct alignas(64) AlignedRing : Ring { };

/// The star that merging t and u leaves.
struct CollapseStar : MergedRing {
    Point points[kMaxDegree] = {};
    std::int64_t areas[kMaxDegree] = {};  ///< twice that of each face of the merged vertex; is_place_ok() finds them
};

class CollapseMesh {
public:
    /// Vertices on the pixels of a width x height grid (2 x 2 at least), not yet connected.
    CollapseMesh(int width, int height);
    /// One flag per quad, row-major: cut from its upper left to its lower right corner.
    void connect(const std::vector<std::uint8_t>& falling);

    Point extent() const { return { (m_width - 1) * kSubpixels, (m_height - 1) * kSubpixels }; }
    Index size() const { return Index(vertices.size()); }
    bool alive(Index v) const { return vertices[v].degree > 0; }
    /// Keeps only these vertices (increasing, all that are alive) and numbers them anew, in the same order, so that the
    /// living are next to each other in memory.
    void keep(const std::vector<Index>& survivors);

    /// False when t and u are no neighbours or merging them would break the mesh.
    bool load_star(Index t, Index u, CollapseStar& star) const;
    /// Whether every triangle stays positive and the sides of the picture keep their vertices.
    bool is_place_ok(CollapseStar& star, Index t, Index u, Point s) const;
    void collapse(const CollapseStar& star, Index t, Index u, Point s);
    /// Neighbours of t with larger numbers, nearest first, then by number.
    struct Candidates {
        int count = 0;
        Index nearest = kGhost;
        std::uint32_t symbol_class = 0;  ///< of the choice: how many there are, and how clearly one is nearest
    };
    Candidates candidates(Index t) const;
    /// Number `choice` of them, or kGhost.
    Index candidate(Index t, std::uint32_t choice) const;

    /// Prefetches what a collapse at v will touch: here its own ring, and in prefetch_ring(), to be called some
    /// collapses later, its neighbours'.
    void prefetch(Index v) const
    {
        __builtin_prefetch(&rings[v]);
        __builtin_prefetch(&vertices[v]);
    }
    void prefetch_ring(Index v) const
    {
        for (int j = 0; j < vertices[v].degree; ++j)
            if (const Index q = rings[v].v[std::size_t(j)]; q != kGhost)
                prefetch(q);
    }

    struct Vertex {
        Point at;
        Index pixel;          ///< that the vertex began as
        std::int32_t degree;  ///< of its ring; 0: merged into another
    };
    std::vector<AlignedRing> rings;
    std::vector<Vertex> vertices;

private:
    int m_width, m_height;
};

/// Classes under which the position of s is coded, and whether its coordinates are coded at all (on a side they are
/// known).
struct CollapseClasses {
    std::uint32_t x, y;
    bool x_free, y_free;
};
CollapseClasses collapse_classes(Point t, Point u, Point extent);

/// Where s is expected: the middle of t and u, or the side of the picture either lies on.
inline std::int32_t expected(std::int32_t t, std::int32_t u, std::int32_t extent)
{
    if (t == 0 || t == extent)
        return t;
    if (u == 0 || u == extent)
        return u;
    return (t + u) >> 1;
}

/// Class of a quad's diagonal: how much its two candidates differ; the prediction is the smaller jump.
struct DiagonalGuess {
    std::uint32_t symbol_class;
    bool falling;
};
inline DiagonalGuess guess_diagonal(const std::int32_t* p, int width)
{
    const std::int64_t down = std::abs(std::int64_t(p[0]) - p[width + 1]), up = std::abs(std::int64_t(p[1]) - p[width]);
    const std::int64_t gap = std::abs(down - up);
    return { class_of(std::uint32_t(gap)), down <= up };
}

}  // namespace PIMG_ABI
}  // namespace pimg
