// SPDX-License-Identifier: BSD-3-Clause
// The mesh while it is being simplified. A vertex takes one cache line for itself, one for its ring, and a key.
// Vertices are numbered tile by tile (tiles in Morton order), so that a tile's vertices lie together in memory;
// survivors are renumbered in the same order whenever half of them are gone, and four tiles then become one.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/ring.h>
#include <pimg/sampling.h>
#include <pimg/simplify.h>

#include "simplify/bisection.h"
#include "simplify/collapse_cost.h"
#include <pimg/detail/flat_array.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The block that a vertex started in, in units of half a finest tile. It never changes, and says which tile owns the
/// vertex.
struct Home {
    std::uint16_t x = 0, y = 0;
};

/// Four quarters. The first holds what start_tile() reads of neighbours, which it does not change.
struct alignas(64) Node {
    Home home;
    float z;       ///< intensity
    Point p;       ///< position
    FanSums sums;  ///< of its fan, origin at the vertex
    Index name;    ///< name of the vertex whose number it keeps: its mesh pixel, or its place in the initial mesh
    float order;   ///< cost of its last collapse, but no lower than that of any collapse this one depends on
    std::uint8_t degree;  ///< 0: merged into another
    std::uint8_t side;    ///< Side
};
static_assert(sizeof(Node) == 64, "a vertex is one cache line");

/// What a further guide channel adds to a node.
struct alignas(32) MoreOfNode {
    ChannelSums sums;
    float value;  ///< the channel's intensity
};

/// Vertices [first, last) belong to the tile at (x, y) of the current tile grid.
struct Tile {
    Index first, last;
    std::uint32_t x, y;
};

/// Rectangle of blocks a tile may touch: itself and half of each tile around it. Tiles of one
/// of the four colours never share a block, so they can be worked on at once.
struct Zone {
    std::int32_t x0, y0, x1, y1;  ///< half open
};
constexpr Zone kEverywhere = { 0, 0, 1 << 16, 1 << 16 };  ///< 2^20 pixels are 2^16 blocks

/// Fills a ring after its last neighbour. It is neither a vertex nor the ghost.
constexpr Index kNoVertex = kGhost - 1;

class WorkingMesh {
public:
    /// Side of a finest tile in pixels, and of a block.
    static constexpr int kTile = 32, kBlock = kTile / 2;

    FlatArray<Node> nodes;
    FlatArray<Ring> rings;  ///< padded with kNoVertex
    FlatArray<float>
        keys;  ///< cost limit from which on a vertex is evaluated; infinite: not until its neighbourhood changes
    std::vector<Tile> tiles;
    int more_channels = 0;         ///< guide channels besides the first
    std::vector<MoreOfNode> more;  ///< of vertex v: [v * more_channels, (v + 1) * more_channels)
    std::vector<float> weights;    ///< of all channels

    /// One vertex per mesh pixel; each quad is cut along the diagonal with the smaller jump. Sums are left to
    /// start_tile().
    WorkingMesh(const Guide& guide, const ParallelFor& parallel);

    /// The vertices and triangles of `initial`, which must not exceed kMaxDegree. A vertex takes the samples of its
    /// pixel.
    WorkingMesh(const Guide& guide, const InitialMesh& initial);

    /// What bisection left of the mesh of all pixels.
    WorkingMesh(const Guide& guide, const Bisection& bisection, const ParallelFor& parallel);

    const MoreOfNode* more_of(Index v) const { return more.data() + std::size_t(v) * std::size_t(more_channels); }
    MoreOfNode* more_of(Index v) { return more.data() + std::size_t(v) * std::size_t(more_channels); }

    Index alive() const { return m_alive; }
    void add_dead(Index count) { m_alive -= count; }
    Zone zone(const Tile& tile) const;
    std::size_t bytes() const;

    /// If half of the numbers are free, renumbers the vertices, and merges tiles that have become small.
    void compact_if_sparse(const ParallelFor& parallel);

    void prefetch_node(Index v) const { prefetch_at(nodes.data(), v, sizeof(Node)); }
    void prefetch_ring(Index v) const { prefetch_at(rings.data(), v, sizeof(Ring)); }
    void prefetch(Index v) const
    {
        prefetch_node(v);
        prefetch_ring(v);
    }

private:
    /// Also prefetches for the ghost: a wrong address does no harm, and a test for it would take longer.
    static void prefetch_at(const void* first, Index v, std::size_t size)
    {
        __builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(first) + v * size));
    }
    void allocate(const Guide& guide, std::size_t vertices);
    void number_vertices(int width, int height, const ParallelFor& parallel, std::vector<Index>& number_of);
    void number_vertices(const Guide& guide, const Bisection& bisection, const ParallelFor& parallel,
                         std::vector<Index>& number_of);
    void number_vertices(const InitialMesh& initial, std::vector<Index>& number_of);
    void place(Index v, const Guide& guide, Index pixel, Index name);
    void build_rows(const Guide& guide, int first, int last, const std::vector<Index>& number_of);
    void build_rings(const InitialMesh& initial, const std::vector<Index>& number_of);
    Index close_ranks(const Tile& tile, std::vector<Index>& number_of);
    void merge_tiles();
    void merge_small_tiles();

    Index m_alive = 0;
    std::uint32_t m_blocks_per_tile = 2;
};

}  // namespace PIMG_ABI
}  // namespace pimg
