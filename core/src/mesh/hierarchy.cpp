// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/hierarchy.h>

#include <algorithm>
#include <cmath>

#include "mesh/pixel_stencils.h"
#include <pimg/detail/projection.h>
#include <pimg/detail/stop.h>

namespace pimg {
inline namespace PIMG_ABI {

Level Hierarchy::level_of_vertices(double count) const
{
    const double wanted = count - double(base_vertices());
    return wanted <= 0 ? 0 : Level(std::min(wanted, double(levels())));
}

Level Hierarchy::level_of_faces(double count) const
{
    // An inner split adds two triangles, one on the border a single one.
    double faces = double(base_triangles.size());
    Level level = 0;
    for (; level < levels(); ++level) {
        const Split& s = this->splits[level];
        faces += s.vl == kGhost || s.vr == kGhost ? 1 : 2;
        if (faces > count)
            break;
    }
    return level;
}

Level Hierarchy::level_of_error(double error) const
{
    return Level(std::partition_point(costs.begin(), costs.end(), [=](float c) { return double(c) > error; })
                 - costs.begin());
}

std::size_t Hierarchy::memory() const
{
    return base_points.capacity() * sizeof(Point) + base_triangles.capacity() * sizeof(Triangle)
        + splits.capacity() * sizeof(Split) + stencils.capacity() * sizeof(Stencil) + costs.capacity() * sizeof(float)
        + pixels.capacity() * sizeof(Index) + between.capacity() * sizeof(PixelStencil);
}

Status refine(const Hierarchy& h, Level level, Mesh& mesh, std::vector<Point>* coarse)
{
    Mesh m;
    const Status status = Mesh::from_triangles(h.base_points, h.base_triangles, h.extent(), m);
    if (!status)
        return status;
    level = std::min(level, h.levels());
    if (coarse)
        coarse->resize(level);
    m.reserve(std::size_t(h.base_vertices()) + level);
    constexpr Level kAhead = 16;                  // splits are in no order in memory
    constexpr Level kRefinedBetweenStops = 8192;  // done in the mesh at some hundred nanoseconds each
    for (Level i = 0; i < level; ++i) {
        const Split& s = h.splits[i];
        if (i % kRefinedBetweenStops == 0)
            stop_point();
        if (i + kAhead < level) {
            m.prefetch(h.splits[i + kAhead].s);
            m.prefetch_around(h.splits[i + kAhead / 2].s);
        }
        if (coarse && s.s < m.size())
            (*coarse)[i] = m.point(s.s);
        if (s.s >= m.size() || !m.split(s.s, s.vl, s.vr, s.t, s.u))
            return Status::failure("hierarchy: split " + std::to_string(i) + " does not fit the mesh");
    }
    mesh = std::move(m);
    return {};
}

namespace {

/// The stencil split i must have, from the star it splits.
Stencil expected_stencil(const Mesh& mesh, const Split& split)
{
    const RingView ring = mesh.ring(split.s);
    Index around[kMaxDegree];
    Point points[kMaxDegree];
    const int start = int(std::find(ring.begin(), ring.end(), split.vr) - ring.begin());
    for (int k = 0; k < ring.degree; ++k) {
        around[k] = ring[(start + k) % ring.degree];
        points[k] = around[k] == kGhost ? Point {} : mesh.point(around[k]);
    }
    const Point s = mesh.point(split.s);
    const Projection t = project(split.t, s, ring.degree, around, points);
    const Projection u = project(split.u, s, ring.degree, around, points);
    return { split.s, t.a, t.b, u.a, u.b, t.wa, t.wb, u.wa, u.wb };
}

bool same(const Stencil& a, const Stencil& b)
{
    return a.s == b.s && a.at == b.at && a.bt == b.bt && a.au == b.au && a.bu == b.bu && a.wat == b.wat
        && a.wbt == b.wbt && a.wau == b.wau && a.wbu == b.wbu;
}

bool same_pixel(const PixelStencil& a, const PixelStencil& b)
{
    return a.pixel == b.pixel && a.a == b.a && a.b == b.b && a.c == b.c && a.wb == b.wb && a.wc == b.wc;
}

std::vector<PixelStencil> stencils_between(const Hierarchy& h, const Mesh& finest)
{
    if (h.vertices() == h.mesh_pixels())
        return {};
    std::vector<Triangle> triangles = finest.triangles();
    for (Triangle& t : triangles)
        for (Index& v : t)
            v = h.pixels[v];
    return pixel_stencils(h.mesh_width(), h.mesh_height(), h.pixels, triangles);
}

bool is_weight_pair(float a, float b)
{
    return a >= 0.0f && b >= 0.0f && a + b <= 1.0f + 1e-6f;
}

}  // namespace

Status find_pixels_between(Hierarchy& h)
{
    h.between.clear();
    if (h.vertices() == h.mesh_pixels())
        return {};
    Mesh mesh;
    const Status status = refine(h, h.levels(), mesh);
    if (status)
        h.between = stencils_between(h, mesh);
    return status;
}

Status validate(const Hierarchy& h)
{
    const auto bad = [](const char* what, Level i) {
        return Status::failure("hierarchy: " + std::string(what) + " at split " + std::to_string(i));
    };
    if (h.vertices() > h.mesh_pixels() || h.stencils.size() != h.splits.size() || h.costs.size() != h.splits.size()
        || h.pixels.size() != h.vertices() || h.between.size() != h.mesh_pixels() - h.vertices())
        return Status::failure("hierarchy: sizes do not agree");
    std::vector<bool> seen(h.mesh_pixels());
    for (Index p : h.pixels) {
        if (p >= h.mesh_pixels() || seen[p])
            return Status::failure("hierarchy: a pixel is outside the picture or there twice");
        seen[p] = true;
    }
    Mesh mesh;
    Status status = Mesh::from_triangles(h.base_points, h.base_triangles, h.extent(), mesh);
    if (!status)
        return status;
    for (Level i = 0; i < h.levels(); ++i) {
        const Split& s = h.splits[i];
        if (i > 0 && h.costs[i] > h.costs[i - 1])
            return bad("cost rises", i);
        if (s.s >= mesh.size())
            return bad("vertex that does not exist yet", i);
        const Stencil& k = h.stencils[i];
        if (!same(k, expected_stencil(mesh, s)))
            return bad("stencil is not the projection onto the star", i);
        if (!is_weight_pair(k.wat, k.wbt) || !is_weight_pair(k.wau, k.wbu))
            return bad("weights outside the face", i);
        if (!mesh.split(s.s, s.vl, s.vr, s.t, s.u))
            return bad("cut vertices are no neighbours", i);
    }
    for (Index v = 0; v < h.vertices(); ++v) {
        const int x = int(h.pixels[v] % Index(h.mesh_width())), y = int(h.pixels[v] / Index(h.mesh_width()));
        if (mesh.point(v) != Point { x * kSubpixels, y * kSubpixels })
            return Status::failure("hierarchy: a vertex of the finest level is not on its pixel");
    }
    const std::vector<PixelStencil> between = stencils_between(h, mesh);
    if (!std::equal(between.begin(), between.end(), h.between.begin(), h.between.end(), same_pixel))
        return Status::failure("hierarchy: a pixel between vertices is not interpolated in its face");
    return mesh.validate();
}

}  // namespace PIMG_ABI
}  // namespace pimg
