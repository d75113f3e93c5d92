// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/bands.h>

#include <algorithm>
#include <cmath>

#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>

namespace pimg {
inline namespace PIMG_ABI {

float Bands::largest_detail() const
{
    float largest = 0.0f;
    for (Detail d : details)
        largest = std::max({ largest, std::fabs(d.t), std::fabs(d.u) });
    return largest;
}

std::vector<float> to_mesh_pixels(const Hierarchy& h, const float* samples)
{
    std::vector<float> mesh;
    mesh.reserve(h.mesh_pixels());
    for (int y = 0; y < h.mesh_height(); ++y)
        for (int x = 0; x < h.mesh_width(); ++x)
            mesh.push_back(samples[std::size_t(std::min(y, h.height - 1)) * std::size_t(h.width)
                                   + std::size_t(std::min(x, h.width - 1))]);
    return mesh;
}

std::vector<float> values_at(const Hierarchy& h, const Bands& bands, Level level)
{
    level = std::min(level, h.levels());
    std::vector<float> values(std::size_t(h.base_vertices()) + level);
    std::copy(bands.base.begin(), bands.base.end(), values.begin());
    in_stages(level, kBetweenStops, [&](Level first, Level last) {
        sweep_splits(h, first, last, values.data(), [&](Level i) { return bands.details[i]; });
    });
    return values;
}

Status rebase(Hierarchy& h, std::vector<Bands>& bands, Level level, const ParallelFor& parallel)
{
    Mesh mesh;
    const Status status = refine(h, level, mesh);
    if (!status)
        return status;
    for (Bands& b : bands)
        b.base = values_at(h, b, level);
    h.base_triangles = mesh.triangles();
    h.base_points.resize(mesh.size());
    for (Index v = 0; v < mesh.size(); ++v)
        h.base_points[v] = mesh.point(v);
    const auto forget = [&](auto& of_splits) {
        of_splits.erase(of_splits.begin(), of_splits.begin() + level);
    };
    run(parallel, 3, [&](std::size_t task) {
        if (task == 0)
            forget(h.stencils);
        else if (task == 1)
            forget(h.splits);
        else {
            forget(h.costs);
            for (Bands& b : bands)
                forget(b.details);
        }
    });
    return {};
}

void scatter(const Hierarchy& h, const float* values, float* samples, const ParallelFor& parallel)
{
    in_batches(parallel, h.vertices(), [&](std::size_t v) { samples[h.pixels[v]] = values[v]; });
    interpolate_between(h, samples, parallel);
}

void interpolate_between(const Hierarchy& h, float* samples, const ParallelFor& parallel)
{
    in_batches(parallel, h.between.size(), [&](std::size_t i) {
        const PixelStencil& k = h.between[i];
        samples[k.pixel] = interpolate(samples[k.a], samples[k.b], samples[k.c], k.wb, k.wc);
    });
}

void synthesise(const Hierarchy& h, const Bands& bands, float* samples, const ParallelFor& parallel)
{
    std::vector<float> values(h.vertices());
    sweep(h, bands, values.data(), h.levels(), [](Level, Detail d) { return d; });
    scatter(h, values.data(), samples, parallel);
    add_residual(bands, samples, [](Index, float r) { return r; });
}

}  // namespace PIMG_ABI
}  // namespace pimg
