// SPDX-License-Identifier: BSD-3-Clause
// The fastest peer: meshoptimizer's simplification of the same height field to half a percent of its faces. It gives one
// mesh of one level; nothing is recorded.
#include <benchmark/benchmark.h>

#include <vector>

#include <meshoptimizer.h>

#include "pictures.h"

namespace {

struct HeightField {
    std::vector<float> points;
    std::vector<unsigned> corners;
};

HeightField height_field(int size, float z_scale)
{
    const std::vector<float>& z = bench::guide(size);
    HeightField mesh;
    for (int y = 0, i = 0; y < size; ++y)
        for (int x = 0; x < size; ++x, ++i)
            mesh.points.insert(mesh.points.end(), { float(x), float(y), z_scale * z[std::size_t(i)] });
    for (int y = 0; y + 1 < size; ++y)
        for (int x = 0; x + 1 < size; ++x) {
            const unsigned i = unsigned(y * size + x), below = i + unsigned(size);
            mesh.corners.insert(mesh.corners.end(), { i, i + 1, below, i + 1, below + 1, below });
        }
    return mesh;
}

void simplify(benchmark::State& state, float z_scale, unsigned options)
{
    const int size = int(state.range(0));
    const HeightField mesh = height_field(size, z_scale);
    const std::size_t wanted = mesh.corners.size() / 600 * 3;
    for (auto _ : state) {
        std::vector<unsigned> simpler(mesh.corners.size());
        float error = 0.0f;
        benchmark::DoNotOptimize(meshopt_simplify(simpler.data(), mesh.corners.data(), mesh.corners.size(),
                                                  mesh.points.data(), mesh.points.size() / 3, 3 * sizeof(float), wanted,
                                                  1e9f, options, &error));
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(size) * size);
}

/// As it comes: the border stays, so that nothing is uncovered.
void meshopt_locked(benchmark::State& state)
{
    simplify(state, 1.0f, meshopt_SimplifyLockBorder);
}
BENCHMARK(meshopt_locked)->Arg(512)->Arg(1024)->Unit(benchmark::kMillisecond);

/// Set up for its best quality on a height field: z small, so that the distance to a plane is a vertical one.
void meshopt_free(benchmark::State& state)
{
    simplify(state, 0.02f, 0);
}
BENCHMARK(meshopt_free)->Arg(512)->Arg(1024)->Unit(benchmark::kMillisecond);

}  // namespace
