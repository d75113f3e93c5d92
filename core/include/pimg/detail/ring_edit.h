// SPDX-License-Identifier: BSD-3-Clause
// Changes to a ring, of which only the first `degree` entries count.
#pragma once

#include <pimg/ring.h>

namespace pimg {

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

}  // namespace pimg
