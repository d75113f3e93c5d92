// SPDX-License-Identifier: BSD-3-Clause
// Regions and the borders between them while they are being merged.
#pragma once

#include <array>
#include <vector>

#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Borders in both directions: half-border h leads to `to[h]`, h ^ 1 leads back. Those that leave a region form a ring.
/// A shared border is one object, so merging two regions moves links and copies nothing.
class RegionGraph {
public:
    struct Link {
        Index to, next, previous;
    };
    struct Shared {
        float length;    ///< pixel sides
        float strength;  ///< sum of the gradient over these sides
    };

    explicit RegionGraph(Index regions) : m_first(regions, kGhost), m_mark(regions, kGhost) { }

    void reserve(std::size_t borders);
    void add(Index a, Index b, Shared shared);

    /// First half-border of a region, kGhost for none; follow with next().
    Index first(Index region) const { return m_first[region]; }
    Index next(Index h) const { return m_links[h].next; }
    Index to(Index h) const { return m_links[h].to; }
    const Shared& shared(Index h) const { return m_shared[h >> 1]; }

    /// Moves the borders of `gone` to `kept`. Two borders to a common neighbour become one, and the border between
    /// `kept` and `gone` vanishes.
    void merge(Index kept, Index gone);

private:
    void link(Index region, Index h);
    void unlink(Index region, Index h);

    std::vector<Link> m_links;
    std::vector<Shared> m_shared;
    std::vector<Index> m_first;
    std::vector<Index> m_mark;  ///< half-border from the region being merged to each neighbour
};

}  // namespace PIMG_ABI
}  // namespace pimg
