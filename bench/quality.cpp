// SPDX-License-Identifier: BSD-3-Clause
#include "quality.h"

#include <algorithm>
#include <cmath>

#include <pimg/simplify.h>

namespace bench {

const std::vector<float>& guide(int size);

namespace {

/// Twice the area of a triangle, seen from above.
double area(const Vertex& a, const Vertex& b, const Vertex& c)
{
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

/// Intensities where a triangle is over a pixel's centre; plain and slow.
void draw(const Vertex& a, const Vertex& b, const Vertex& c, int size, std::vector<double>& pixels)
{
    constexpr double kSlack = 1e-9;
    const double whole = area(a, b, c);
    if (std::fabs(whole) < kSlack)
        return;
    const auto first = [](double v) {
        return std::max(int(std::ceil(v - kSlack)), 0);
    };
    const auto last = [size](double v) {
        return std::min(int(std::floor(v + kSlack)), size - 1);
    };
    for (int y = first(std::min({ a.y, b.y, c.y })); y <= last(std::max({ a.y, b.y, c.y })); ++y)
        for (int x = first(std::min({ a.x, b.x, c.x })); x <= last(std::max({ a.x, b.x, c.x })); ++x) {
            const Vertex p { double(x), double(y), 0.0 };
            const double u = area(p, b, c) / whole, v = area(a, p, c) / whole, w = 1.0 - u - v;
            if (u >= -kSlack && v >= -kSlack && w >= -kSlack)
                pixels[std::size_t(y) * std::size_t(size) + std::size_t(x)] = u * a.z + v * b.z + w * c.z;
        }
}

void quality_pimg(benchmark::State& state)
{
    const int size = int(state.range(0));
    pimg::Hierarchy hierarchy;
    std::vector<pimg::Bands> bands;
    for (auto _ : state)
        if (!pimg::simplify({ size, size, { { guide(size).data() } } }, {}, hierarchy, bands))
            state.SkipWithError("cannot be built");
    for (std::size_t share = 0; share < kShares.size(); ++share) {
        const pimg::Level level = hierarchy.level_of_vertices(kShares[share] * hierarchy.vertices());
        pimg::Mesh mesh;
        if (!refine(hierarchy, level, mesh))
            state.SkipWithError("damaged");
        const std::vector<float> values = values_at(hierarchy, bands[0], level);
        std::vector<Vertex> vertices;
        for (pimg::Index v = 0; v < mesh.size(); ++v)
            vertices.push_back({ mesh.point(v).x / double(pimg::kSubpixels), mesh.point(v).y / double(pimg::kSubpixels),
                                 double(values[v]) });
        std::vector<std::array<unsigned, 3>> triangles;
        for (const pimg::Triangle& t : mesh.triangles())
            triangles.push_back(t);
        report_quality(state, share, size, vertices, triangles);
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(quality_pimg)->Arg(512)->Iterations(1)->Repetitions(1)->Unit(benchmark::kMillisecond);

}  // namespace

void report_quality(benchmark::State& state, std::size_t share, int size, const std::vector<Vertex>& vertices,
                    const std::vector<std::array<unsigned, 3>>& triangles)
{
    const std::vector<float>& z = guide(size);
    std::vector<double> pixels(z.size(), std::nan(""));
    for (const auto& [a, b, c] : triangles)
        draw(vertices[a], vertices[b], vertices[c], size, pixels);
    double sum = 0.0;
    std::size_t covered = 0;
    for (std::size_t i = 0; i < z.size(); ++i)
        if (!std::isnan(pixels[i])) {
            sum += (pixels[i] - double(z[i])) * (pixels[i] - double(z[i]));
            ++covered;
        }
    state.counters[kShareNames[share]] = 10.0 * std::log10(255.0 * 255.0 * double(covered) / sum);
    state.counters["uncovered"] = std::max(double(state.counters["uncovered"]), double(z.size() - covered));
}

}  // namespace bench
