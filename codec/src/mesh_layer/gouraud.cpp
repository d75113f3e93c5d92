// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_layer/gouraud.h"

#include <algorithm>

#include <pimg/detail/pixel_span.h>

namespace pimg {
inline namespace PIMG_ABI {

std::vector<Triangle> ordered_triangles(const Mesh& mesh)
{
    std::vector<Triangle> triangles = mesh.triangles();
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

namespace {

struct Corners {
    Point p[3];
    Corners(const Mesh& mesh, const Triangle& t) : p { mesh.point(t[0]), mesh.point(t[1]), mesh.point(t[2]) } { }
    std::int32_t top() const { return std::min({ p[0].y, p[1].y, p[2].y }); }
    std::int32_t bottom() const { return std::max({ p[0].y, p[1].y, p[2].y }); }
};

/// Columns of lattice units, both ends included, that a triangle reaches between two heights; up to one too many on
/// either side.
struct Reach {
    std::int64_t left = INT64_MAX, right = INT64_MIN;

    Reach(const Corners& t, std::int64_t low, std::int64_t high)
    {
        for (std::size_t k = 0; k < 3; ++k) {
            const Point p = t.p[k], q = t.p[(k + 1) % 3];
            const Point a = p.y <= q.y ? p : q, b = p.y <= q.y ? q : p;
            const std::int64_t y0 = std::max<std::int64_t>(a.y, low), y1 = std::min<std::int64_t>(b.y, high);
            if (y0 > y1)
                continue;
            const std::int64_t rise = b.y - a.y, run = b.x - a.x;
            add(rise == 0 ? a.x : a.x + run * (y0 - a.y) / rise);
            add(rise == 0 ? b.x : a.x + run * (y1 - a.y) / rise);
        }
        left = std::max<std::int64_t>(left, 0);
    }

private:
    void add(std::int64_t x)
    {
        left = std::min(left, x - 1);
        right = std::max(right, x + 1);
    }
};

/// Calls body(number) for the cells, of `side` lattice units, that a triangle touches, while it returns true.
template<class Body>
bool for_each_cell(const Corners& t, Point extent, std::int64_t side, std::uint32_t columns, Body&& body)
{
    const std::int64_t first = t.top() / side, last = t.bottom() / side;
    for (std::int64_t row = first; row <= last; ++row) {
        const Reach reach(t, row * side, row * side + side);
        const std::int64_t right = std::min<std::int64_t>(reach.right, extent.x) / side;
        for (std::int64_t column = reach.left / side; column <= right; ++column)
            if (!body(std::size_t(row) * columns + std::size_t(column)))
                return false;
    }
    return true;
}

/// Lists of a grid may have this many entries per triangle before its cells grow, and this many cells and entries at
/// least. Meshes made from pictures have less than two per triangle.
constexpr std::size_t kEntriesPerTriangle = 16, kFewEntries = 4096;

}  // namespace

/// How many entries each cell has, in m_starts[cell + 1]; false when all together are too many.
bool TriangleGrid::count(const Mesh& mesh, std::int64_t side, std::size_t cells)
{
    const std::size_t most = kFewEntries + kEntriesPerTriangle * m_triangles.size();
    if (cells > kFewEntries + m_triangles.size())
        return false;
    m_starts.assign(cells + 1, 0);
    std::size_t entries = 0;
    for (const Triangle& t : m_triangles)
        if (!for_each_cell(Corners(mesh, t), mesh.extent(), side, m_columns, [&](std::size_t cell) {
                ++m_starts[cell + 1];
                return ++entries <= most;
            }))
            return false;
    return true;
}

TriangleGrid::TriangleGrid(const Mesh& mesh, std::uint32_t tile) : m_triangles(ordered_triangles(mesh))
{
    std::int64_t side = std::int64_t(tile) * kSubpixels;
    for (;; side *= 2, ++m_shift) {
        m_columns = std::uint32_t(mesh.extent().x / side) + 1;
        if (count(mesh, side, std::size_t(mesh.extent().y / side + 1) * m_columns))
            break;
    }
    for (std::size_t cell = 1; cell < m_starts.size(); ++cell)
        m_starts[cell] += m_starts[cell - 1];
    m_numbers.resize(m_starts.back());
    std::vector<std::size_t> next(m_starts.begin(), m_starts.end() - 1);
    for (Index i = 0; i < Index(m_triangles.size()); ++i)
        for_each_cell(Corners(mesh, m_triangles[i]), mesh.extent(), side, m_columns, [&](std::size_t cell) {
            m_numbers[next[cell]++] = i;
            return true;
        });
}

std::uint64_t crossed_rows(const Mesh& mesh, const std::vector<Triangle>& triangles, std::uint32_t rows,
                           std::uint32_t of_rows)
{
    std::uint64_t crossed = 0;
    for (const Triangle& t : triangles) {
        const Corners corners(mesh, t);
        const std::uint64_t height = std::uint64_t(corners.bottom() - corners.top()) / kSubpixels;
        crossed += height * rows / of_rows + 1;
    }
    return crossed;
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

/// The plane through a triangle's values, in 1/1024: value(x, y) = (start + per_x x + per_y y) >> 10, kept between
/// the smallest and the largest of the three.
struct Plane10 {
    std::int64_t start, per_x, per_y, low, high;

    Plane10(const Point (&p)[3], std::int64_t a, std::int64_t b, std::int64_t c)
    {
        constexpr std::int64_t kSteepest = std::int64_t(1) << 34;  // times any position it stays below 2^63
        const std::int64_t area = doubled_area(p[0], p[1], p[2]);
        const std::int64_t x1 = p[1].x - p[0].x, y1 = p[1].y - p[0].y, x2 = p[2].x - p[0].x, y2 = p[2].y - p[0].y;
        const std::int64_t scale = 1024 * kSubpixels;
        per_x = std::clamp(floor_div(((b - a) * y2 - (c - a) * y1) * scale, area), -kSteepest, kSteepest);
        per_y = std::clamp(floor_div(((c - a) * x1 - (b - a) * x2) * scale, area), -kSteepest, kSteepest);
        // Measured from the vertex itself, which need not lie on a pixel.
        start = a * 1024 - floor_div(per_x * p[0].x + per_y * p[0].y, kSubpixels);
        low = std::min({ a, b, c });
        high = std::max({ a, b, c });
    }
};

}  // namespace

void fill(const Mesh& mesh, const std::vector<Triangle>& triangles, IndexRun numbers,
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
            const PixelSpan s = pixel_span(p, ys[row]);
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

}  // namespace PIMG_ABI
}  // namespace pimg
