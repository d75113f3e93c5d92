// SPDX-License-Identifier: BSD-3-Clause
// Control maps, densities and error diffusion.
#include <pimg/sampling.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "delaunay.h"

namespace pimg {

namespace {

constexpr int kStrip = 64;        ///< rows worked on at a time
#define GRAD 1
#ifndef EXPO
#define EXPO 0.5
#define EVEN 0.1
#endif
constexpr double kEvenShare = EVEN;

std::size_t strips(int height)
{
    return std::size_t((height + kStrip - 1) / kStrip);
}

template<class Row>
void for_rows(int height, const ParallelFor& parallel, Row&& row)
{
    run(parallel, strips(height), [&](std::size_t strip) {
        const int y1 = std::min(height, int(strip + 1) * kStrip);
        for (int y = int(strip) * kStrip; y < y1; ++y)
            row(y);
    });
}

float square(float v)
{
    return v * v;
}
}  // namespace

std::vector<float> control_map(const std::vector<const float*>& channels, int width, int height, Control control,
                               const ParallelFor& parallel)
{
    std::vector<float> map(std::size_t(width) * std::size_t(height), 0.0f);
    const auto at = [&](const float* z, int x, int y) {
        return z[std::size_t(std::clamp(y, 0, height - 1)) * std::size_t(width) + std::size_t(std::clamp(x, 0, width - 1))];
    };
    for_rows(height, parallel, [&](int y) {
        for (const float* z : channels)
            for (int x = 0; x < width; ++x) {
                float& m = map[std::size_t(y) * std::size_t(width) + std::size_t(x)];
                if (control == Control::gradient) {
#if GRAD == 0
                    m += square(at(z, x + 1, y) - at(z, x - 1, y)) + square(at(z, x, y + 1) - at(z, x, y - 1));
#elif GRAD == 1
                    const float c = at(z, x, y);
                    m += square(at(z, x + 1, y) - c) + square(at(z, x - 1, y) - c) + square(at(z, x, y + 1) - c)
                         + square(at(z, x, y - 1) - c);
#elif GRAD == 2
                    float sx = 2 * (at(z, x + 1, y) - at(z, x - 1, y)) + at(z, x + 1, y - 1) - at(z, x - 1, y - 1)
                               + at(z, x + 1, y + 1) - at(z, x - 1, y + 1);
                    float sy = 2 * (at(z, x, y + 1) - at(z, x, y - 1)) + at(z, x - 1, y + 1) - at(z, x - 1, y - 1)
                               + at(z, x + 1, y + 1) - at(z, x + 1, y - 1);
                    m += sx * sx + sy * sy;
#endif
                } else {
                    const float xx = at(z, x + 1, y) + at(z, x - 1, y) - 2 * at(z, x, y);
                    const float yy = at(z, x, y + 1) + at(z, x, y - 1) - 2 * at(z, x, y);
                    const float xy = 0.25f * (at(z, x + 1, y + 1) + at(z, x - 1, y - 1) - at(z, x - 1, y + 1) - at(z, x + 1, y - 1));
                    m += xx * xx + yy * yy + 2 * xy * xy;
                }
            }
    });
    return map;
}

void to_density(std::vector<float>& map, int width, int height, double density, const ParallelFor& parallel)
{
    (void)parallel;
    double n = double(width) * height;
    for (float& m : map)
        m = std::pow(m, float(EXPO));
    const double even = density * kEvenShare;
    double lo = 0, hi = 1e30;
    for (int it = 0; it < 200; ++it) {
        double c = lo > 0 ? std::sqrt(lo * hi) : 1e-6; if (it == 0) c = 1e-6;
        double sum = 0;
        for (float m : map)
            sum += std::min(1.0, even + c * m);
        if (sum < density * n) lo = c; else hi = c;
        if (lo == 0) lo = 1e-12;
        if (hi / lo < 1.0001) break;
    }
    for (float& m : map)
        m = float(std::min(1.0, even + lo * m));
}

std::vector<Index> halftone(const std::vector<float>& probability, int width, int height)
{
    std::vector<float> error[2];
    for (auto& e : error)
        e.assign(std::size_t(width) + 2, 0.0f);
    std::vector<char> keep(static_cast<std::size_t>(width));
    std::vector<Index> pixels;
    for (int y = 0; y < height; ++y) {
        float *here = error[y & 1].data() + 1, *below = error[~y & 1].data() + 1;
        std::fill(below - 1, below + width + 1, 0.0f);
        const bool side_y = y == 0 || y == height - 1;
        const int step = y & 1 ? -1 : 1;
        for (int i = 0, x = y & 1 ? width - 1 : 0; i < width; ++i, x += step) {
            float p = probability[std::size_t(y) * std::size_t(width) + std::size_t(x)];
            const bool side_x = x == 0 || x == width - 1;
            if (side_x || side_y)
                p = std::sqrt(p);
            const float want = p + here[x];
            const bool chosen = want >= 0.5f || (side_x && side_y);
            keep[std::size_t(x)] = chosen;
            const float rest = (want - (chosen ? 1.0f : 0.0f)) * (1.0f / 16);
            here[x + step] += 7 * rest;
            below[x - step] += 3 * rest;
            below[x] += 5 * rest;
            below[x + step] += rest;
        }
        for (int x = 0; x < width; ++x)
            if (keep[std::size_t(x)])
                pixels.push_back(Index(y) * Index(width) + Index(x));
    }
    return pixels;
}

namespace {

/// Adds the pixels around some vertices.
void thicken(const std::vector<Index>& vertices, int width, int height, std::vector<Index>& pixels)
{
    const std::size_t before = pixels.size();
    for (Index v : vertices) {
        const int x = int(pixels[v] % Index(width)), y = int(pixels[v] / Index(width));
        for (int qy = std::max(0, y - 1); qy <= std::min(height - 1, y + 1); ++qy)
            for (int qx = std::max(0, x - 1); qx <= std::min(width - 1, x + 1); ++qx)
                pixels.push_back(Index(qy) * Index(width) + Index(qx));
    }
    (void)before;
    std::sort(pixels.begin(), pixels.end());
    pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
}

}  // namespace

Status triangulate(std::vector<Index> pixels, int width, int height, const float* samples, InitialMesh& mesh)
{
    mesh.width = width;
    mesh.height = height;
    mesh.pixels = std::move(pixels);
    for (;;) {
        triangulate_delaunay(mesh, samples);
        const std::vector<Index> crowded = limit_degrees(mesh);
        if (crowded.empty())
            return {};
        thicken(crowded, width, height, mesh.pixels);
    }
}

Status sample(const std::vector<const float*>& channels, int width, int height, const SamplingOptions& options,
              InitialMesh& mesh)
{
    std::vector<float> map = control_map(channels, width, height, options.control, options.parallel);
    to_density(map, width, height, options.density, options.parallel);
    return triangulate(halftone(map, width, height), width, height, channels[0], mesh);
}

}  // namespace pimg
