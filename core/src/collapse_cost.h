// SPDX-License-Identifier: BSD-3-Clause
// Memoryless volume optimisation on a height field (Lindstrom & Turk 1998, 1999; paper, section 3.2).
//
// A triangle with corners p, q, r has the normal n = (q - p) x (r - p); nz is twice its area in the
// picture plane, always positive, and n . (x - p) is six times the volume under the tetrahedron that x spans with it. The
// optimum for an edge minimises the sum of the squares over the fans of its two ends (shared triangles once)
// on condition that the sum itself is zero: the volume under the surface is kept.
//
// Every triangle of a vertex's fan passes through the vertex. With the origin there, the fan is only
// A = sum of n n^T and N = sum of n; no linear or constant part, hence no cancellation, and single precision is enough.
// Volume preservation, N . u = const with Nz > 0, gives the intensity from (x, y): what is left is a 2 x 2 system.
#pragma once

#include <cstdint>

#include <pimg/ring.h>

namespace pimg {

/// Lanes of a fan: one neighbour each, in ring order.
constexpr int kLanes = kMaxDegree;

/// A triangle fan's sums with the origin at its vertex. Pixels and guide units.
struct FanSums {
    float xx, xy, yy, xz, yz, zz;  ///< A = sum of n n^T
    float x, y, z;                 ///< N = sum of n
};

/// Sides of the picture a vertex must stay on.
enum Side : std::uint8_t { kFree = 0, kFixedX = 1, kFixedY = 2, kCorner = 3 };

/// The edges from one vertex to its neighbours, in structure-of-arrays form. The caller fills
/// the inputs for lanes below `degree`; a ghost has real = 0 and zeroes.
struct alignas(64) EdgeFan {
    int degree;
    std::uint8_t side;  ///< of the centre vertex

    float dx[kLanes], dy[kLanes], dz[kLanes];  ///< neighbour minus centre
    float real[kLanes];                        ///< 1, or 0 for the ghost
    float fixed_x[kLanes], fixed_y[kLanes];    ///< 1 where the neighbour must stay on its side
    float a[6][kLanes];                        ///< the neighbour's FanSums: xx xy yy xz yz zz
    float n[3][kLanes];                        ///< x y z

    // Outputs.
    FanSums sums;                                           ///< of the centre, freshly added up
    float nx[kLanes], ny[kLanes], nz[kLanes];               ///< normal of the triangle between neighbours j and j + 1
    float cost[kLanes];                                     ///< of collapsing edge j; infinite for the ghost
    float x[kLanes], y[kLanes];                             ///< optimum, relative to the centre
    float alpha[kLanes], beta[kLanes], offset[kLanes];      ///< intensity = offset - alpha x - beta y
};

/// Fills the outputs for every neighbour at once.
void evaluate_edges(EdgeFan& fan);

/// Sum of squared volumes at (x, y) for the edge of lane j: what evaluate_edges() minimised.
float cost_at(const EdgeFan& fan, int j, float x, float y);

/// Normals of the triangles (s, q_j, q_j+1) around a ring given relative to s; ghosts have real = 0.
struct alignas(64) Normals {
    float x[kLanes], y[kLanes], z[kLanes];
};
void fan_normals(int degree, const float* dx, const float* dy, const float* dz, const float* real, Normals& normals);

/// Adds up n n^T and n.
FanSums add_up(int degree, const Normals& normals);

}  // namespace pimg
