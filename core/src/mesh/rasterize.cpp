// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/parallel.h>
#include <pimg/detail/pixel_span.h>
#include <pimg/rasterize.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

struct Run {
    int first, last;
};

/// Pixels of row y of the picture whose centres lie in the triangle.
Run pixels_of_row(const Point (&p)[3], int y, int width)
{
    const PixelSpan s = pixel_span(p, y);
    return { int(std::max<std::int64_t>(0, s.first)), int(std::min<std::int64_t>(width - 1, s.last)) };
}

struct Plane {
    double at_origin, per_x, per_y;  // x, y in pixels
    float low, high;
    float at(int x, int y) const { return std::clamp(float(at_origin + per_x * x + per_y * y), low, high); }
};

Plane plane(const Point (&p)[3], float a, float b, float c)
{
    const double area = double(doubled_area(p[0], p[1], p[2])) / kSubpixels;
    const double x1 = p[1].x - p[0].x, y1 = p[1].y - p[0].y, x2 = p[2].x - p[0].x, y2 = p[2].y - p[0].y;
    const double b0 = double(b) - a, c0 = double(c) - a;
    Plane plane;
    plane.per_x = (b0 * y2 - c0 * y1) / area;
    plane.per_y = (c0 * x1 - b0 * x2) / area;
    plane.at_origin = a - (plane.per_x * p[0].x + plane.per_y * p[0].y) / kSubpixels;
    plane.low = std::min({ a, b, c });
    plane.high = std::max({ a, b, c });
    return plane;
}

}  // namespace

std::size_t rasterize(const Mesh& mesh, const std::vector<const float*>& values, const std::vector<float*>& samples,
                      const ParallelFor& parallel)
{
    constexpr int kStrip = 32;
    const int width = mesh.extent().x / kSubpixels + 1, height = mesh.extent().y / kSubpixels + 1;
    const std::vector<Triangle> triangles = mesh.triangles();
    const std::size_t strips = std::size_t((height + kStrip - 1) / kStrip);

    // Triangles of each strip of rows, so that strips are independent.
    std::vector<std::vector<Index>> of_strip(strips);
    for (Index t = 0; t < Index(triangles.size()); ++t) {
        std::int32_t low = mesh.extent().y, high = 0;
        for (Index v : triangles[t]) {
            low = std::min(low, mesh.point(v).y);
            high = std::max(high, mesh.point(v).y);
        }
        for (int s = low / (kStrip * kSubpixels); s <= high / (kStrip * kSubpixels); ++s)
            of_strip[std::size_t(s)].push_back(t);
    }

    std::atomic<std::size_t> uncovered { 0 };
    run(parallel, strips, [&](std::size_t strip) {
        const int y0 = int(strip) * kStrip, y1 = std::min(height, y0 + kStrip);
        std::vector<char> covered(std::size_t(width) * std::size_t(y1 - y0), 0);
        for (Index t : of_strip[strip]) {
            const Triangle& tri = triangles[t];
            const Point p[3] = { mesh.point(tri[0]), mesh.point(tri[1]), mesh.point(tri[2]) };
            const int top = std::max(y0, (std::min({ p[0].y, p[1].y, p[2].y }) + kSubpixels - 1) / kSubpixels);
            const int bottom = std::min(y1 - 1, std::max({ p[0].y, p[1].y, p[2].y }) / kSubpixels);
            for (std::size_t c = 0; c < values.size(); ++c) {
                const float* z = values[c];
                const Plane shade = plane(p, z[tri[0]], z[tri[1]], z[tri[2]]);
                for (int y = top; y <= bottom; ++y) {
                    const Run s = pixels_of_row(p, y, width);
                    float* row = samples[c] + std::size_t(y) * std::size_t(width);
                    for (int x = s.first; x <= s.last; ++x)
                        row[x] = shade.at(x, y);
                }
            }
            for (int y = top; y <= bottom; ++y) {
                const Run s = pixels_of_row(p, y, width);
                char* row = covered.data() + std::size_t(y - y0) * std::size_t(width);
                for (int x = s.first; x <= s.last; ++x)
                    row[x] = 1;
            }
        }
        uncovered += std::size_t(std::count(covered.begin(), covered.end(), 0));
    });
    return uncovered;
}

namespace {

/// Draws one edge into `coverage` by walking along its longer axis.
void draw_edge(double ax, double ay, double bx, double by, double half_width, int width, int height,
               std::vector<float>& coverage)
{
    const bool steep = std::fabs(by - ay) > std::fabs(bx - ax);
    if (steep) {
        std::swap(ax, ay);
        std::swap(bx, by);
    }
    if (ax > bx) {
        std::swap(ax, bx);
        std::swap(ay, by);
    }
    const int along_size = steep ? height : width, across_size = steep ? width : height;
    const double slope = bx > ax ? (by - ay) / (bx - ax) : 0.0;
    const double cosine = 1.0 / std::sqrt(1.0 + slope * slope);
    const int first = std::max(0, int(std::ceil(ax - 0.5))), last = std::min(along_size - 1, int(std::floor(bx + 0.5)));
    for (int along = first; along <= last; ++along) {
        const double centre = ay + slope * (along - ax), reach = (half_width + 0.5) / cosine;
        const int from = std::max(0, int(std::ceil(centre - reach)));
        const int to = std::min(across_size - 1, int(std::floor(centre + reach)));
        for (int across = from; across <= to; ++across) {
            const double distance = std::fabs(across - centre) * cosine;
            const float cover = float(std::clamp(half_width + 0.5 - distance, 0.0, 1.0));
            float& pixel = steep ? coverage[std::size_t(along) * std::size_t(width) + std::size_t(across)]
                                 : coverage[std::size_t(across) * std::size_t(width) + std::size_t(along)];
            pixel = std::max(pixel, cover);
        }
    }
}

}  // namespace

std::vector<float> wireframe(const Mesh& mesh, float line_width, int scale)
{
    const int width = (mesh.extent().x / kSubpixels + 1) * scale, height = (mesh.extent().y / kSubpixels + 1) * scale;
    std::vector<float> coverage(std::size_t(width) * std::size_t(height), 0.0f);
    const double unit = double(scale) / kSubpixels, shift = 0.5 * (scale - 1);
    for (Index v = 0; v < mesh.size(); ++v)
        for (Index q : mesh.ring(v))
            if (q != kGhost && v < q) {
                const Point a = mesh.point(v), b = mesh.point(q);
                draw_edge(a.x * unit + shift, a.y * unit + shift, b.x * unit + shift, b.y * unit + shift,
                          0.5 * double(line_width), width, height, coverage);
            }
    return coverage;
}

}  // namespace PIMG_ABI
}  // namespace pimg
