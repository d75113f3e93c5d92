// SPDX-License-Identifier: BSD-3-Clause
// Memoryless volume optimisation on a height field (Lindstrom & Turk 1998, 1999; paper, section 3.2).
//
// A triangle with corners p, q, r has the normal n = (q - p) x (r - p); nz is twice its area in the picture plane,
// always positive, and n . (x - p) is six times the volume of the tetrahedron that x spans with it. The optimum for an
// edge minimises the sum of the squares of these over the fans of its two ends (shared triangles once), on condition
// that the sum itself is zero: the volume under the surface is kept.
//
// Every triangle of a vertex's fan passes through the vertex. With the origin there, the fan is only
// A = sum of n n^T and N = sum of n; no linear or constant part, hence no cancellation, and single precision is
// enough. Volume preservation, N . u = const with Nz > 0, gives the intensity from (x, y): what is left is a 2 x 2
// system.
//
// Here are the data; the arithmetic is in collapse_cost-inl.h, compiled once per instruction set.
#pragma once

#include <cstdint>

#include <pimg/ring.h>
#include <pimg/simplify.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Lanes of a fan: one neighbour each, in ring order. Computed eight at a time.
constexpr int kLanes = kMaxDegree;

/// A triangle fan's sums with the origin at its vertex. Pixels and guide units.
struct FanSums {
    float xx, xy, yy, xz, yz, zz;  ///< A = sum of n n^T
    float x, y, z;                 ///< N = sum of n
};

/// What a further guide channel adds. Its normals have their own x and y; z, an area, is the same for all channels.
struct ChannelSums {
    float xx, xy, yy, xz, yz;  ///< of A
    float x, y;                ///< of N
};

/// Sides of the picture a vertex must stay on.
enum Side : std::uint8_t { kFree = 0, kFixedX = 1, kFixedY = 2, kCorner = 3 };

// Regularisation. Flat and ramp-like places leave the 2 x 2 system singular: a pull to the edge's midpoint of 1e-4 of
// its trace decides there, plus a share of the area for where even the trace vanishes. The cost gets a floor that grows
// with area and length, so that flat places coarsen evenly instead of growing one giant fan.
constexpr float kPullOfTrace = 1e-4f;
constexpr float kPullOfArea = 1e-6f;
constexpr float kCostFloor = 1e-5f;

/// Corners of a fan or star in ring order, relative to its centre, in pixels and guide units. The entry after the
/// last repeats the first, so that triangle j has corners j and j + 1; entries past that, and the ghost, hold zeroes.
struct alignas(64) Corners {
    float x[kLanes + 8], y[kLanes + 8], z[kLanes + 8];
    float real[kLanes + 8];  ///< 1 for a corner, 0 for none
};

/// Normals of the triangles (centre, corner j, corner j + 1); zero where there is none.
/// Lane -1 (`before`) repeats the last triangle, so that the two triangles of edge j are lanes j - 1 and j.
struct alignas(64) Normals {
    float pad_x[15], before_x, x[kLanes];
    float pad_y[15], before_y, y[kLanes];
    float pad_z[15], before_z, z[kLanes];
};

/// A further guide channel of the edges of a vertex, lane for lane as in EdgeFan.
struct alignas(64) ChannelFan {
    float z[kLanes + 8];
    float a[5][kLanes], n[2][kLanes];
    ChannelSums sums;
    float value;      ///< of the centre
    Normals normals;  ///< z is not used
    float alpha[kLanes], beta[kLanes], offset[kLanes];
};

/// The edges from one vertex to its neighbours.
struct alignas(64) EdgeFan {
    int degree, lanes;      ///< lanes: 8 or 16, those computed
    int more_channels = 0;  ///< guide channels besides the first
    std::uint8_t side;      ///< Side of the centre vertex
    bool on_border;         ///< whether the centre or any neighbour has a side

    Corners corners;                         ///< the neighbours
    float fixed_x[kLanes], fixed_y[kLanes];  ///< 1 where the neighbour must stay on its side; only if on_border
    float a[6][kLanes], n[3][kLanes];        ///< the neighbours' FanSums: xx xy yy xz yz zz, x y z

    FanSums sums;  ///< of the centre, freshly added up
    Normals normals;
    float cost[kLanes];                                 ///< of collapsing edge j; infinite without a neighbour
    float x[kLanes], y[kLanes];                         ///< optimum, relative to the centre
    float alpha[kLanes], beta[kLanes], offset[kLanes];  ///< intensity there = offset - alpha x - beta y

    float weights[kMaxGuideChannels];  ///< of the channels in the cost
    ChannelFan more[kMaxGuideChannels - 1];
};

}  // namespace PIMG_ABI
}  // namespace pimg
