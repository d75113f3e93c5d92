// SPDX-License-Identifier: BSD-3-Clause
// The first stage of building: vertices of the pixel grid that are nearly predicted by two of their neighbours are
// removed without asking which collapse is best. It takes some ten nanoseconds a vertex, where Lindstrom and Turk's
// choice takes more than a microsecond.
//
// The grid is seen as a mesh that longest-edge bisection makes (4-8 mesh; Lindstrom, Koller, Ribarsky, Hodges, Faust and
// Turner, "Real-time, continuous level of detail rendering of height fields", 1996; Duchaineau et al., "ROAMing terrain",
// 1997): every vertex u halves the longest edge t-b of two right-angled triangles, whose other corners are vl and vr.
//
//          vl                 vl
//        / | \              /    \          removing u is the edge collapse u -> t, a vertex split whose u is predicted
//       t--u--b     ──▶    t------b         by the mean of t and b
//        \ | /              \    /
//          vr                 vr
//
// u can only be removed when nothing halves its own four triangles any more. So each vertex has the largest cost of
// those below it, and any limit on costs leaves a conforming mesh.
#pragma once

#include <array>
#include <vector>

#include <pimg/guide.h>
#include <pimg/types.h>

#include "simplify/collapse_record.h"

namespace pimg {
inline namespace PIMG_ABI {

/// How far the first stage goes.
struct BisectionLimits {
    float cost = 0.0f;   ///< largest cost of a removal, in units of Hierarchy::costs
    double share = 1.0;  ///< largest share of all vertices that is removed
};

/// The mesh that the first stage leaves.
class Bisection {
public:
    static constexpr int kDirections = 8;  ///< of edges: right, down right, down and so on

    /// Removes vertices of the grid of `guide`, cheapest first, and appends their collapses to `sequence`.
    Bisection(const Guide& guide, const BisectionLimits& limits, const ParallelFor& parallel,
              CollapseSequence& sequence);

    bool is_left(Index pixel) const { return m_costs[pixel] > m_limit; }
    Index left() const { return m_left; }
    float value(Index pixel, int channel) const
    {
        return channel == 0 ? m_spots[pixel].z
                            : m_more[std::size_t(pixel) * m_more_channels + std::size_t(channel) - 1];
    }
    /// The highest cost of the collapses that moved this vertex or its neighbours.
    float order(Index pixel) const { return m_spots[pixel].order; }

    /// The neighbours of a vertex that is left, by pixel, in ring order, the ghost once; returns how many.
    int ring(Index pixel, Index* ring) const { return ring_from(pixel, 0, kDirections, ring); }

private:
    /// What is known of a vertex, next to each other in memory.
    struct Spot {
        std::array<std::uint8_t, kDirections> reach;  ///< of the edges: 1 + log2 of the pixels across; 0: none
        float z;                                      ///< intensity in the first channel
        float area;                                   ///< twice the area of its fan, in pixels
        float order;
    };

    enum class Diagonal : std::uint8_t { none, falling, rising };

    /// A vertex to be removed: the ends of the edge it halves, and the direction from t to it.
    struct Removal {
        Index t, u, b;
        Point of_t, of_u;
        int direction;
        float area;  ///< twice that of each of the triangles that meet in u
    };

    void find_costs(const Guide& guide, const ParallelFor& parallel);
    void find_costs_of_edges(const Guide& guide, int step, int y);
    void find_costs_of_centres(const Guide& guide, int step, int y);
    std::vector<Index> choose(const BisectionLimits& limits, const ParallelFor& parallel);
    void lay_out(const Guide& guide, const ParallelFor& parallel);
    std::vector<Diagonal> diagonals(const Guide& guide, int y) const;
    Removal removal_of(Index u) const;
    void prefetch(const Removal& r) const;
    CollapseRecord remove(const Removal& r, SplitPair* more);

    bool is_inside(int x, int y) const { return x >= 0 && y >= 0 && x < m_width && y < m_height; }
    Index pixel(int x, int y) const { return Index(y) * Index(m_width) + Index(x); }
    bool leads_outside(Index pixel, int direction) const;
    Index neighbour(Index pixel, int direction) const;
    int ring_from(Index pixel, int first, int count, Index* ring) const;

    int m_width, m_height;
    std::size_t m_more_channels;
    std::array<std::int64_t, kDirections> m_offset;  ///< from a pixel to the next in each direction
    FlatArray<float> m_costs;                        ///< of each vertex, no lower than those that must go before it
    float m_limit = -1.0f;
    Index m_left = 0;
    FlatArray<Spot> m_spots;
    std::vector<float> m_more;  ///< intensities in the other channels, vertex by vertex
};

}  // namespace PIMG_ABI
}  // namespace pimg
