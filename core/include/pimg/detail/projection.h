// SPDX-License-Identifier: BSD-3-Clause
// Where a point lies in the star of a vertex: what a split's intensities are predicted from.
#pragma once

#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// A face (s, a, b) of the star of s, by the places of a and b in the ring, and how a point p lies in it.
struct StarFace {
    int a = -1, b = -1;                   ///< -1: the ring has no face
    std::int64_t area_a = 0, area_b = 0;  ///< twice the areas of (s, p, b) and (s, a, p)
    bool holds = false;                   ///< whether p lies in the face, its border included
};

/// The first face that holds a point p, looking from place `start` of the ring on; if none does, as in a damaged star,
/// the first face there is. side(i) returns twice the area of (s, ring vertex i, p), and any number for the ghost.
template<class Side>
StarFace face_that_holds(int degree, const Index* ring, int start, Side&& side)
{
    StarFace found;
    int i = start;
    const std::int64_t first = side(i);
    std::int64_t here = first;
    for (int count = 0; count < degree; ++count) {
        const int next = i + 1 < degree ? i + 1 : 0;
        const std::int64_t after = next != start ? side(next) : first;
        const bool holds = here >= 0 && after <= 0;
        if ((holds || found.a < 0) && ring[i] != kGhost && ring[next] != kGhost) {
            found = { i, next, -after, here, holds };
            if (holds)
                break;
        }
        here = after;
        i = next;
    }
    return found;
}

/// Vertices of a face (s, a, b) and the barycentric weights of a and b.
struct Projection {
    Index a, b;
    float wa, wb;
};

/// The weights of a face of which twice the area is `area`.
inline Projection projection(const StarFace& face, const Index* ring, std::int64_t area)
{
    return { ring[face.a], ring[face.b], float(double(face.area_a) / double(area)),
             float(double(face.area_b) / double(area)) };
}

/// Where `p` lies in the star of s. `ring` is that of s in the coarser mesh starting with vr of the split; the first
/// face that holds p is taken, from exact integers: everybody who replays the splits finds the same stencil. `points`
/// are the positions of the ring's vertices.
PIMG_EXPORT_DETAIL Projection project(Point p, Point s, int degree, const Index* ring, const Point* points);

}  // namespace PIMG_ABI
}  // namespace pimg
