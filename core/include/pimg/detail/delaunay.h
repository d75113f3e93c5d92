// SPDX-License-Identifier: BSD-3-Clause
// Delaunay triangulation of pixels, exact in integers.
#pragma once

#include <pimg/ring.h>
#include <pimg/sampling.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Sign of whether d lies inside the circle through the positively oriented a, b, c: > 0 inside, 0 on it. Exact for
/// coordinates below 2^20.
PIMG_EXPORT_DETAIL int in_circle(Point a, Point b, Point c, Point d);

/// Fills corners and twins of a mesh whose pixels are set; the guide decides ties.
PIMG_EXPORT_DETAIL void triangulate_delaunay(InitialMesh& mesh, const Guide& guide);

/// Half-edges of e's triangle after and before e.
inline Index next_edge(Index e)
{
    return e % 3 == 2 ? e - 2 : e + 1;
}
inline Index previous_edge(Index e)
{
    return e % 3 == 0 ? e + 2 : e - 1;
}

/// Flips the inner edge e; the quad around it must be strictly convex.
///     a ----- d          a ----- d       e: a -> b of triangle (a, b, c), twin: b -> a of (b, a, d);
///     | e \   |          |    /  |       afterwards e: d -> b of (d, b, c), twin: c -> a of (c, a, d)
///     |    \  |   --->   |  /    |
///     c ----- b          c ----- b
PIMG_EXPORT_DETAIL void flip(InitialMesh& mesh, Index e);

/// Flips edges away from vertices of more than kMaxDegree neighbours (ghost counted). Returns those
/// that keep too many because no flip is left.
PIMG_EXPORT_DETAIL std::vector<Index> limit_degrees(InitialMesh& mesh);

}  // namespace PIMG_ABI
}  // namespace pimg
