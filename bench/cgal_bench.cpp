// SPDX-License-Identifier: BSD-3-Clause
// The peer: CGAL's Lindstrom-Turk edge collapse of the same height field, with its defaults, down to 128 faces.
#include <benchmark/benchmark.h>

#include <vector>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>

namespace bench {
const std::vector<float>& guide(int size);
}

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace simplification = CGAL::Surface_mesh_simplification;

SurfaceMesh height_field(int size)
{
    const std::vector<float>& z = bench::guide(size);
    SurfaceMesh mesh;
    std::vector<SurfaceMesh::Vertex_index> v;
    for (int y = 0, i = 0; y < size; ++y)
        for (int x = 0; x < size; ++x, ++i)
            v.push_back(mesh.add_vertex(Kernel::Point_3(x, y, z[std::size_t(i)])));
    for (int y = 0; y + 1 < size; ++y)
        for (int x = 0; x + 1 < size; ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(size) + std::size_t(x), below = i + std::size_t(size);
            mesh.add_face(v[i], v[i + 1], v[below]);
            mesh.add_face(v[i + 1], v[below + 1], v[below]);
        }
    return mesh;
}

void cgal(benchmark::State& state)
{
    const int size = int(state.range(0));
    const SurfaceMesh original = height_field(size);
    for (auto _ : state) {
        state.PauseTiming();
        SurfaceMesh mesh = original;
        state.ResumeTiming();
        // About 128 faces of a planar mesh have 3/2 as many edges.
        simplification::Count_stop_predicate<SurfaceMesh> stop(192);
        simplification::edge_collapse(mesh, stop,
                                      CGAL::parameters::get_cost(simplification::LindstromTurk_cost<SurfaceMesh>())
                                          .get_placement(simplification::LindstromTurk_placement<SurfaceMesh>()));
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(size) * size);
}
BENCHMARK(cgal)->Arg(512)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
