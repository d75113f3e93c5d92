// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/projection.h>

namespace pimg {
inline namespace PIMG_ABI {

Projection project(Point p, Point s, int degree, const Index* ring, const Point* points)
{
    const StarFace face = face_that_holds(degree, ring, 0, [&](int i) { return doubled_area(s, points[i], p); });
    if (face.a < 0)
        return { kGhost, kGhost, 0.0f, 0.0f };
    return projection(face, ring, doubled_area(s, points[face.a], points[face.b]));
}

}  // namespace PIMG_ABI
}  // namespace pimg
