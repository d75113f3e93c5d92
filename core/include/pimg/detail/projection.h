// SPDX-License-Identifier: BSD-3-Clause
// Where a point lies in the star of a vertex: what a split's intensities are predicted from.
#pragma once

#include <pimg/types.h>

namespace pimg {

/// Face (s, a, b) of the star of s that holds `p`, and the weights of a and b. `ring` is that of s in
/// the coarser mesh starting with vr of the split; the first face that holds p is taken, from exact integers: everybody
/// who replays the splits finds the same stencil. `points` are the positions of the ring's vertices.
struct Projection {
    Index a, b;
    float wa, wb;
};
Projection project(Point p, Point s, int degree, const Index* ring, const Point* points);

}  // namespace pimg
