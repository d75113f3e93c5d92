// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_layer/gouraud.h"

#include <algorithm>

namespace pimg {

std::vector<Triangle> ordered_triangles(const Mesh& mesh)
{
    std::vector<Triangle> triangles = mesh.triangles();
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

TriangleGrid::TriangleGrid(const Mesh& mesh, std::uint32_t cell) : m_triangles(ordered_triangles(mesh))
{
    const std::int32_t side = std::int32_t(cell) * kSubpixels;
    const std::uint32_t rows = std::uint32_t(mesh.extent().y / side) + 1;
    m_columns = std::uint32_t(mesh.extent().x / side) + 1;
    m_cells.resize(std::size_t(rows) * m_columns);
    for (Index t = 0; t < Index(m_triangles.size()); ++t) {
        Point low = mesh.extent(), high {};
        for (Index v : m_triangles[t]) {
            const Point p = mesh.point(v);
            low = { std::min(low.x, p.x), std::min(low.y, p.y) };
            high = { std::max(high.x, p.x), std::max(high.y, p.y) };
        }
        for (std::uint32_t row = std::uint32_t(low.y / side); row <= std::uint32_t(high.y / side); ++row)
            for (std::uint32_t column = std::uint32_t(low.x / side); column <= std::uint32_t(high.x / side); ++column)
                m_cells[std::size_t(row) * m_columns + column].push_back(t);
    }
}

SamplePoints SamplePoints::rectangle(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height)
{
    SamplePoints points;
    for (std::uint32_t i = 0; i < width; ++i)
        points.xs.push_back(std::int32_t(x + i));
    for (std::uint32_t i = 0; i < height; ++i)
        points.ys.push_back(std::int32_t(y + i));
    return points;
}

SamplePoints SamplePoints::spread(std::uint32_t extent_x, std::uint32_t extent_y, std::uint32_t width,
                                  std::uint32_t height)
{
    SamplePoints points;
    for (std::uint64_t i = 0; i < width; ++i)
        points.xs.push_back(std::int32_t((2 * i + 1) * extent_x / (2 * std::uint64_t(width))));
    for (std::uint64_t i = 0; i < height; ++i)
        points.ys.push_back(std::int32_t((2 * i + 1) * extent_y / (2 * std::uint64_t(height))));
    return points;
}

namespace {

std::int64_t floor_div(std::int64_t a, std::int64_t b)
{
    return a / b - (a % b != 0 && (a < 0) != (b < 0));
}

/// First and last pixel of row y whose centres lie in the triangle, borders included.
struct Span {
    std::int64_t first, last;
};

Span span(const Point (&p)[3], std::int64_t y)
{
    Span s { INT32_MIN, INT32_MAX };
    for (int k = 0; k < 3; ++k) {
        const Point a = p[k], b = p[(k + 1) % 3];
        // Inside is where rise * x <= limit, x in lattice units.
        const std::int64_t rise = b.y - a.y;
        const std::int64_t limit = std::int64_t(b.x - a.x) * (y * kSubpixels - a.y) + rise * a.x;
        if (rise > 0)
            s.last = std::min(s.last, floor_div(limit, rise * kSubpixels));
        else if (rise < 0)
            s.first = std::max(s.first, -floor_div(limit, -rise * kSubpixels));
        else if (limit < 0)
            return { 0, -1 };
    }
    return s;
}

/// The plane through a triangle's values, in 1/1024: value(x, y) = (start + per_x x + per_y y) >> 10, kept between
/// the smallest and the largest of the three.
struct Plane10 {
    std::int64_t start, per_x, per_y, low, high;

    Plane10(const Point (&p)[3], std::int64_t a, std::int64_t b, std::int64_t c)
    {
        constexpr std::int64_t kSteepest = std::int64_t(1) << 34;
        const std::int64_t area = doubled_area(p[0], p[1], p[2]);
        const std::int64_t x1 = p[1].x - p[0].x, y1 = p[1].y - p[0].y, x2 = p[2].x - p[0].x, y2 = p[2].y - p[0].y;
        const std::int64_t scale = 1024 * kSubpixels;
        per_x = std::clamp(floor_div(((b - a) * y2 - (c - a) * y1) * scale, area), -kSteepest, kSteepest);
        per_y = std::clamp(floor_div(((c - a) * x1 - (b - a) * x2) * scale, area), -kSteepest, kSteepest);
        // From the vertex itself, which need not lie on a pixel.
        start = a * 1024 - floor_div(per_x * p[0].x + per_y * p[0].y, kSubpixels);
        low = std::min({ a, b, c });
        high = std::max({ a, b, c });
    }
};

}  // namespace

void fill(const Mesh& mesh, const std::vector<Triangle>& triangles, const std::vector<Index>& numbers,
          const std::vector<std::int32_t>& values, int shift, const SamplePoints& points, std::int32_t* samples)
{
    const std::vector<std::int32_t>&xs = points.xs, &ys = points.ys;
    const bool dense = xs.back() - xs.front() + 1 == std::int32_t(xs.size());
    for (Index number : numbers) {
        const Triangle& t = triangles[number];
        const Point p[3] = { mesh.point(t[0]), mesh.point(t[1]), mesh.point(t[2]) };
        const std::int32_t top = (std::min({ p[0].y, p[1].y, p[2].y }) + kSubpixels - 1) / kSubpixels;
        const std::int32_t bottom = std::max({ p[0].y, p[1].y, p[2].y }) / kSubpixels;
        const Plane10 plane(p, values[t[0]], values[t[1]], values[t[2]]);
        const std::size_t first_row = std::size_t(std::lower_bound(ys.begin(), ys.end(), top) - ys.begin());
        for (std::size_t row = first_row; row < ys.size() && ys[row] <= bottom; ++row) {
            const Span s = span(p, ys[row]);
            const std::int64_t from = std::max<std::int64_t>(s.first, xs.front());
            const std::int64_t to = std::min<std::int64_t>(s.last, xs.back());
            if (from > to)
                continue;
            std::size_t i = dense
                ? std::size_t(from - xs.front())
                : std::size_t(std::lower_bound(xs.begin(), xs.end(), std::int32_t(from)) - xs.begin());
            std::int32_t* out = samples + row * xs.size();
            const std::int64_t start = plane.start + plane.per_y * ys[row];
            for (; i < xs.size() && xs[i] <= to; ++i) {
                const std::int64_t v = std::clamp((start + plane.per_x * xs[i]) >> 10, plane.low, plane.high);
                out[i] = std::int32_t(std::uint32_t(v) << shift);
            }
        }
    }
}

}  // namespace pimg
