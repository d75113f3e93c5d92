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

#include "quality.h"

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

/// Down to a number of edges.
void collapse(SurfaceMesh& mesh, std::size_t edges)
{
    simplification::Count_stop_predicate<SurfaceMesh> stop(edges);
    simplification::edge_collapse(mesh, stop,
                                  CGAL::parameters::get_cost(simplification::LindstromTurk_cost<SurfaceMesh>())
                                      .get_placement(simplification::LindstromTurk_placement<SurfaceMesh>()));
}

void cgal(benchmark::State& state)
{
    const int size = int(state.range(0));
    const SurfaceMesh original = height_field(size);
    for (auto _ : state) {
        state.PauseTiming();
        SurfaceMesh mesh = original;
        state.ResumeTiming();
        collapse(mesh, 192);  // about 128 faces of a planar mesh have 3/2 as many edges
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(size) * size);
}
BENCHMARK(cgal)->Arg(512)->Iterations(1)->Unit(benchmark::kMillisecond);

void quality_cgal(benchmark::State& state)
{
    const int size = int(state.range(0));
    SurfaceMesh mesh;
    for (auto _ : state) {
        mesh = height_field(size);
        for (std::size_t share = 0; share < bench::kShares.size(); ++share) {
            const std::size_t wanted = std::size_t(bench::kShares[share] * size * size);
            while (mesh.number_of_vertices() > wanted)  // an edge of the border takes two others with it, not three
                collapse(mesh, mesh.number_of_edges() - 3 * (mesh.number_of_vertices() - wanted) + 2);
            mesh.collect_garbage();
            std::vector<bench::Vertex> vertices;
            for (const SurfaceMesh::Vertex_index v : mesh.vertices())
                vertices.push_back({ mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z() });
            std::vector<std::array<unsigned, 3>> triangles;
            for (const SurfaceMesh::Face_index f : mesh.faces()) {
                auto corner = mesh.vertices_around_face(mesh.halfedge(f)).begin();
                const unsigned a = *corner++, b = *corner++, c = *corner;
                triangles.push_back({ a, b, c });
            }
            bench::report_quality(state, share, size, vertices, triangles);
        }
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(quality_cgal)->Arg(512)->Iterations(1)->Repetitions(1)->Unit(benchmark::kMillisecond);

}  // namespace
