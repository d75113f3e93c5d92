// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/projection.h>

namespace pimg {

Projection project(Point p, Point s, int degree, const Index* ring, const Point* points)
{
    Projection found { kGhost, kGhost, 0.0f, 0.0f };
    for (int i = 0; i < degree; ++i) {
        const int next = i + 1 < degree ? i + 1 : 0;
        if (ring[i] == kGhost || ring[next] == kGhost)
            continue;
        const std::int64_t b = doubled_area(s, points[i], p);
        const std::int64_t a = doubled_area(s, p, points[next]);
        const bool holds = a >= 0 && b >= 0;
        if (!holds && found.a != kGhost)
            continue;
        const double area = double(doubled_area(s, points[i], points[next]));
        found = { ring[i], ring[next], float(double(a) / area), float(double(b) / area) };
        if (holds)
            return found;
        // Outside every face seen so far: keep the first only as an answer for a damaged star.
    }
    return found;
}

}  // namespace pimg
