// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/parallel.h>

#include "mesh/pixel_stencils.h"

#include <algorithm>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

struct Pixel {
    std::int64_t x, y;
};

/// Twice the area of (a, b, p) in pixels.
std::int64_t doubled(Pixel a, Pixel b, Pixel p)
{
    return (b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y);
}

/// Finds for every pixel the triangle that holds it. Of two triangles whose common edge the pixel lies on, it is always
/// the same one, whatever their order.
class Cover {
public:
    Cover(int width, int height, const std::vector<Triangle>& triangles)
        : m_width(Index(width)),
          m_height(Index(height)),
          m_triangles(triangles),
          m_owner(std::size_t(width) * std::size_t(height), kGhost)
    {
        for (Index t = 0; t < Index(triangles.size()); ++t)
            paint(t);
    }

    void remove(Index pixel) { m_owner[pixel] = kGhost; }
    std::size_t count(Index y) const;
    void list(Index y, PixelStencil* stencils) const;

private:
    Pixel pixel(Index i) const { return { i % m_width, i / m_width }; }
    bool owns(Pixel a, Pixel b) const;
    void paint(Index t);

    Index m_width, m_height;
    const std::vector<Triangle>& m_triangles;
    std::vector<Index> m_owner;
};

/// Whether pixels on the edge from a to b belong to the triangle: those of edges of one of two opposite directions do,
/// and those on the sides of the picture, where there is no second triangle.
bool Cover::owns(Pixel a, Pixel b) const
{
    const bool on_side =
        (a.x == b.x && (a.x == 0 || a.x == m_width - 1)) || (a.y == b.y && (a.y == 0 || a.y == m_height - 1));
    return on_side || b.y > a.y || (b.y == a.y && b.x > a.x);
}

void Cover::paint(Index t)
{
    const Triangle& triangle = m_triangles[t];
    const Pixel p[3] = { pixel(triangle[0]), pixel(triangle[1]), pixel(triangle[2]) };
    if (doubled(p[0], p[1], p[2]) == 1)
        return;  // holds nothing but its corners (Pick's theorem)
    const auto [left, right] = std::minmax({ p[0].x, p[1].x, p[2].x });
    const auto [top, bottom] = std::minmax({ p[0].y, p[1].y, p[2].y });
    // Edge functions, at least 0 inside; stepped along the row.
    std::int64_t row[3];
    for (int k = 0; k < 3; ++k)
        row[k] = doubled(p[k], p[(k + 1) % 3], { left, top }) - (owns(p[k], p[(k + 1) % 3]) ? 0 : 1);
    for (std::int64_t y = top; y <= bottom; ++y) {
        std::int64_t e0 = row[0], e1 = row[1], e2 = row[2];
        Index* owner = &m_owner[std::size_t(y) * m_width];
        for (std::int64_t x = left; x <= right; ++x) {
            if ((e0 | e1 | e2) >= 0)
                owner[x] = t;
            e0 -= p[1].y - p[0].y;
            e1 -= p[2].y - p[1].y;
            e2 -= p[0].y - p[2].y;
        }
        row[0] += p[1].x - p[0].x;
        row[1] += p[2].x - p[1].x;
        row[2] += p[0].x - p[2].x;
    }
}

std::size_t Cover::count(Index y) const
{
    const auto row = m_owner.begin() + std::ptrdiff_t(std::size_t(y) * m_width);
    return m_width - std::size_t(std::count(row, row + std::ptrdiff_t(m_width), kGhost));
}

void Cover::list(Index y, PixelStencil* out) const
{
    for (Index i = y * m_width; i < (y + 1) * m_width; ++i) {
        if (m_owner[i] == kGhost)
            continue;
        Triangle t = m_triangles[m_owner[i]];
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        const Pixel a = pixel(t[0]), b = pixel(t[1]), c = pixel(t[2]), p = pixel(i);
        const double area = double(doubled(a, b, c));
        *out++ = {
            i, t[0], t[1], t[2], float(double(doubled(a, p, c)) / area), float(double(doubled(a, b, p)) / area)
        };
    }
}

}  // namespace

std::vector<PixelStencil> pixel_stencils(int width, int height, const std::vector<Index>& pixels,
                                         const std::vector<Triangle>& triangles, const ParallelFor& parallel)
{
    Cover cover(width, height, triangles);
    for (Index p : pixels)
        cover.remove(p);
    std::vector<std::size_t> start(std::size_t(height) + 1, 0);
    for (Index y = 0; y < Index(height); ++y)
        start[y + 1] = start[y] + cover.count(y);
    std::vector<PixelStencil> stencils(start.back());
    run(parallel, std::size_t(height), [&](std::size_t y) { cover.list(Index(y), stencils.data() + start[y]); });
    return stencils;
}

}  // namespace PIMG_ABI
}  // namespace pimg
