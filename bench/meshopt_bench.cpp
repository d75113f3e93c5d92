// SPDX-License-Identifier: BSD-3-Clause
// The fastest peer: meshoptimizer's simplification of the same height field to half a percent of its faces. It gives
// one mesh of one level; nothing is recorded.
#include <benchmark/benchmark.h>

#include <vector>

#include <meshoptimizer.h>

#include "pictures.h"
#include "quality.h"

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
BENCHMARK(meshopt_free)->Arg(512)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond);

void quality_meshopt(benchmark::State& state)
{
    constexpr float kZ = 0.02f;
    const int size = int(state.range(0));
    const HeightField mesh = height_field(size, kZ);
    std::vector<bench::Vertex> vertices;
    for (std::size_t i = 0; i < mesh.points.size(); i += 3)
        vertices.push_back({ double(mesh.points[i]), double(mesh.points[i + 1]), double(mesh.points[i + 2] / kZ) });
    for (auto _ : state)
        for (std::size_t share = 0; share < bench::kShares.size(); ++share) {
            std::vector<unsigned> simpler(mesh.corners.size());
            float error = 0.0f;
            simpler.resize(meshopt_simplify(simpler.data(), mesh.corners.data(), mesh.corners.size(),
                                            mesh.points.data(), vertices.size(), 3 * sizeof(float),
                                            std::size_t(bench::kShares[share] * double(mesh.corners.size())) / 3 * 3,
                                            1e9f, 0, &error));
            std::vector<std::array<unsigned, 3>> triangles;
            for (std::size_t i = 0; i < simpler.size(); i += 3)
                triangles.push_back({ simpler[i], simpler[i + 1], simpler[i + 2] });
            bench::report_quality(state, share, size, vertices, triangles);
        }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(quality_meshopt)->Arg(512)->Iterations(1)->Repetitions(1)->Unit(benchmark::kMillisecond);

}  // namespace
