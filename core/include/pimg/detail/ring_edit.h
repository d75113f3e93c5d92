// SPDX-License-Identifier: BSD-3-Clause
// Changes to a ring, of which only the first `degree` entries count, and the ring that an edge collapse makes.
#pragma once

#include <pimg/ring.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Place of `x` in the first `degree` entries, or -1.
inline int find(const Ring& ring, int degree, Index x)
{
    for (int i = 0; i < degree; ++i)
        if (ring.v[std::size_t(i)] == x)
            return i;
    return -1;
}

inline void replace(Ring& ring, int degree, Index from, Index to)
{
    for (int i = 0; i < degree; ++i)
        if (ring.v[std::size_t(i)] == from)
            ring.v[std::size_t(i)] = to;
}

/// Removes the entry at `place`; returns the new degree.
inline int remove_at(Ring& ring, int degree, int place)
{
    for (int i = place; i + 1 < degree; ++i)
        ring.v[std::size_t(i)] = ring.v[std::size_t(i + 1)];
    return degree - 1;
}

/// Inserts `x` so that it follows the entry at `place`; returns the new degree.
inline int insert_after(Ring& ring, int degree, int place, Index x)
{
    for (int i = degree; i > place + 1; --i)
        ring.v[std::size_t(i)] = ring.v[std::size_t(i - 1)];
    ring.v[std::size_t(place + 1)] = x;
    return degree + 1;
}

/// The ring that merging t and u leaves: from vr along t's side to vl, then along u's.
struct MergedRing {
    int degree = 0, vl = 0;  ///< `vl` is the place of vl; vr is first
    Index ring[kMaxDegree] = {};
};

/// A vertex with its ring, of which the first `degree` entries count.
struct RingOf {
    Index vertex;
    const Ring& ring;
    int degree;
};

/// Makes the ring of t and u merged. degree_of(v) returns the degree of a vertex. False when they are no neighbours, the
/// ring would be too large or too small, or the link condition, ghost counted, forbids the collapse: t and u may have no
/// common neighbours but vl and vr, and these must keep three neighbours.
template<class DegreeOf>
bool merge_rings(const RingOf& t, const RingOf& u, MergedRing& merged, DegreeOf&& degree_of)
{
    const int n = t.degree + u.degree - 4;
    if (n < 3 || n > kMaxDegree)
        return false;
    const int at = find(t.ring, t.degree, u.vertex), back = find(u.ring, u.degree, t.vertex);
    if (at < 0 || back < 0)
        return false;
    int k = 0;
    for (int j = at + 1; j < t.degree; ++j)
        merged.ring[k++] = t.ring.v[std::size_t(j)];
    for (int j = 0; j < at; ++j)
        merged.ring[k++] = t.ring.v[std::size_t(j)];
    merged.vl = k - 1;
    for (int i = 2, j = back + 2; i + 1 < u.degree; ++i, ++j) {
        const Index q = u.ring.v[std::size_t(j < u.degree ? j : j - u.degree)];
        if (find(t.ring, t.degree, q) >= 0)
            return false;  // a third common neighbour
        merged.ring[k++] = q;
    }
    merged.degree = n;
    for (const Index q : { merged.ring[0], merged.ring[merged.vl] })
        if (q != kGhost && degree_of(q) <= 3)
            return false;
    return true;
}

}  // namespace PIMG_ABI
}  // namespace pimg
