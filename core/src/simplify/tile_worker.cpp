// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/projection.h>

#include "simplify/tile_worker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simplify/tile_worker.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "simplify/star-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pimg {
inline namespace PIMG_ABI {
namespace HWY_NAMESPACE {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Shares of the limit through which a tile approaches it: powers of 4^(1/4).
constexpr float kSteps[] = { 0.35355339f, 0.5f, 0.70710678f, 1.0f };

// A vertex is evaluated when the limit reaches its key. These keys are guesses that save evaluations; the edges of a
// vertex are hardly ever cheaper, so quality does not change (docs/internals.md).
constexpr float kFirstKey = 0.6f;  ///< of a vertex that was never evaluated: share of least_own_error()
constexpr float kFreshKey = 3.0f;  ///< of the vertex that a collapse makes: multiple of the collapse's cost
constexpr float kNearKey = 1.25f;  ///< least key of the vertices around it: multiple of the same cost

/// Appends the numbers of the vertices of a tile whose key is at most `limit`; returns how many.
HWY_INLINE std::size_t collect(const WorkingMesh& mesh, const Tile& tile, float limit, Index* candidates)
{
    const Lanes d;
    const Integers i;
    const Index step = Index(hn::Lanes(d));
    const auto most = hn::Set(d, limit);
    std::size_t n = 0;
    Index v = tile.first;
    for (; v + step <= tile.last; v += step) {
        const auto due = hn::Le(hn::LoadU(d, &mesh.keys[v]), most);
        if (!hn::AllFalse(d, due))
            n += hn::CompressStore(hn::Iota(i, std::int32_t(v)), hn::RebindMask(i, due), i,
                                   reinterpret_cast<std::int32_t*>(candidates + n));
    }
    for (; v < tile.last; ++v)
        if (mesh.keys[v] <= limit)
            candidates[n++] = v;
    return n;
}

class TileWorker {
public:
    TileWorker(WorkingMesh& mesh, const TileJob& job, TileOutput& output)
        : m_mesh(mesh),
          m_zone(job.zone),
          m_guard(job.guard),
          m_out(output)
    {
        m_fan.more_channels = mesh.more_channels;
        std::copy(mesh.weights.begin(), mesh.weights.end(), m_fan.weights);
    }

    void run(const Index* vertices, std::size_t n, float limit);
    void start(Index v);

private:
    void visit(Index v, float limit);
    void keep_sums(Index v);
    bool find_placement(int j, float limit, float& cost, Placement& place) const;
    void collapse(Index t, int j, const Placement& place, float cost);
    void record(Index t, Index u, const Placement& place, float order);
    void update_sums(Index t, int j, const Placement& place);
    void update_rings(Index t, Index u);

    WorkingMesh& m_mesh;
    Zone m_zone;
    float m_guard;
    TileOutput& m_out;
    EdgeFan m_fan;
    Star m_star;
};

void TileWorker::run(const Index* vertices, std::size_t n, float limit)
{
    constexpr std::size_t kAhead = 6, kRingAhead = 3;
    for (std::size_t i = 0; i < n; ++i) {
        if (i + kAhead < n)
            m_mesh.prefetch(vertices[i + kAhead]);
        if (i + kRingAhead < n)
            for (const Index* q = m_mesh.rings[vertices[i + kRingAhead]].v.data(); *q != kNoVertex; ++q)
                m_mesh.prefetch_node(*q);
        if (m_mesh.keys[vertices[i]] <= limit)
            visit(vertices[i], limit);
    }
}

/// Fills the sums of a vertex and guesses its key.
void TileWorker::start(Index v)
{
    load_corners(m_mesh, v, Neighbours(m_mesh, m_mesh.rings[v].v.data(), m_mesh.nodes[v].degree), m_fan);
    add_up_channels(m_fan);
    keep_sums(v);
    m_mesh.keys[v] = kFirstKey * least_own_error(m_fan);
}

/// Stores sums that were just added up anew, without the rounding errors that updates leave.
void TileWorker::keep_sums(Index v)
{
    m_mesh.nodes[v].sums = m_fan.sums;
    for (int c = 0; c < m_fan.more_channels; ++c)
        m_mesh.more_of(v)[c].sums = m_fan.more[c].sums;
}

/// Evaluates the edges of v. Collapses the cheapest one that may be collapsed, or makes its cost the key of v.
void TileWorker::visit(Index v, float limit)
{
    const Index* ring = m_mesh.rings[v].v.data();
    const int degree = m_mesh.nodes[v].degree;
    const Neighbours from(m_mesh, ring, degree);
    if (!all_in_zone(from, ring, degree, m_zone)) {
        m_out.deferred.push_back(v);
        return;
    }
    load_corners(m_mesh, v, from, m_fan);
    load_sums(m_mesh, ring, from, m_fan);
    evaluate_edges(m_fan);
    ++m_out.evaluations;
    keep_sums(v);
    for (;;) {
        const int j = cheapest_edge(m_fan);
        float& cost = m_fan.cost[j];
        if (!(cost <= limit)) {
            m_mesh.keys[v] = cost;
            return;
        }
        if (join_rings(m_mesh, v, j, m_star)) {
            if (!load_star(m_mesh, v, m_zone, m_fan.more_channels, m_star)) {
                m_out.deferred.push_back(v);
                return;
            }
            Placement place;
            if (find_placement(j, limit, cost, place)) {
                if (cost <= limit) {
                    collapse(v, j, place, cost);
                    return;
                }
                continue;  // possible, but only at a higher cost, with which the edge takes part again
            }
        }
        cost = kInfinity;
        ++m_out.refused;
    }
}

/// A lattice point where every triangle of the star keeps its shape: the optimum if it can be, else
/// points between it, the midpoint and the ends. Sets the cost there. Stops at the first that is cheap enough.
bool TileWorker::find_placement(int j, float limit, float& cost, Placement& place) const
{
    const float dx = m_fan.corners.x[j], dy = m_fan.corners.y[j], x = m_fan.x[j], y = m_fan.y[j];
    const float candidates[6][2] = {
        { x, y },   { 0.5f * x + 0.25f * dx, 0.5f * y + 0.25f * dy },    { 0.5f * dx, 0.5f * dy }, { 0.0f, 0.0f },
        { dx, dy }, { 0.25f * x + 0.375f * dx, 0.25f * y + 0.375f * dy }
    };
    const auto on_lattice = [](float v) {
        return std::nearbyint(v * float(kSubpixels)) * kPixel;
    };
    float best = kInfinity;
    for (int c = 0; c < 6 && !(best <= limit); ++c) {
        const float cx = m_fan.side & kFixedX ? 0.0f : (m_fan.fixed_x[j] > 0.0f ? dx : on_lattice(candidates[c][0]));
        const float cy = m_fan.side & kFixedY ? 0.0f : (m_fan.fixed_y[j] > 0.0f ? dy : on_lattice(candidates[c][1]));
        if (!keeps_shape(m_star, m_guard, cx, cy))
            continue;
        const float here = c == 0 ? cost : edge_cost_at(m_fan, j, cx, cy);
        if (here < best) {
            best = here;
            place = { cx, cy };
        }
    }
    cost = best;
    return best < kInfinity;
}

void TileWorker::collapse(Index t, int j, const Placement& place, float cost)
{
    const Index u = m_mesh.rings[t].v[std::size_t(j)];
    Node& s = m_mesh.nodes[t];
    const Node& other = m_mesh.nodes[u];
    float order = std::max({ cost, s.order, other.order });
    for (int i = 0; i < m_star.degree; ++i) {
        const Index q = m_star.ring[i];
        if (q == kGhost)
            continue;
        m_mesh.prefetch_ring(q);
        order = std::max(order, m_mesh.nodes[q].order);
        // What was refused there may be possible now.
        float& key = m_mesh.keys[q];
        key = key == kInfinity ? 0.0f : std::max(key, kNearKey * cost);
    }
    record(t, u, place, order);
    update_sums(t, j, place);

    s.p = { s.p.x + std::int32_t(place.x * float(kSubpixels)), s.p.y + std::int32_t(place.y * float(kSubpixels)) };
    s.z += m_fan.offset[j] - m_fan.alpha[j] * place.x - m_fan.beta[j] * place.y;
    for (int c = 0; c < m_fan.more_channels; ++c) {
        const ChannelFan& m = m_fan.more[c];
        m_mesh.more_of(t)[c].value += m.offset[j] - m.alpha[j] * place.x - m.beta[j] * place.y;
    }
    s.order = order;
    s.side |= other.side;
    update_rings(t, u);
    m_mesh.keys[t] = kFreshKey * cost;
    m_mesh.keys[u] = kInfinity;
}

void TileWorker::record(Index t, Index u, const Placement& place, float order)
{
    const auto name = [&](Index v) {
        return v == kGhost ? kGhost : m_mesh.nodes[v].name;
    };
    const Node &node = m_mesh.nodes[t], &other = m_mesh.nodes[u];
    const Point s { std::int32_t(place.x * float(kSubpixels)), std::int32_t(place.y * float(kSubpixels)) };
    const bool near = is_near(m_star);
    const Projection pt = project(m_star, { 0, 0 }, s, near);
    const Projection pu = project(m_star, { other.p.x - node.p.x, other.p.y - node.p.y }, s, near);
    m_out.records.push_back({ { node.name, name(m_star.ring[m_star.vl]), name(m_star.ring[0]), node.p, other.p },
                              other.name,
                              { node.name, name(pt.a), name(pt.b), name(pu.a), name(pu.b), pt.wa, pt.wb, pu.wa, pu.wb },
                              node.z,
                              other.z,
                              order });
    for (int c = 0; c < m_fan.more_channels; ++c)
        m_out.more.push_back({ m_mesh.more_of(t)[c].value, m_mesh.more_of(u)[c].value });
}

/// Replaces the old triangles' contributions to every fan by the new ones'.
void TileWorker::update_sums(Index t, int j, const Placement& place)
{
    const float ux = m_fan.corners.x[j], uy = m_fan.corners.y[j];
    const int lanes = lanes_for(m_star.degree);
    Changes changes;
    Normals after;
    const float z = m_fan.offset[j] - m_fan.alpha[j] * place.x - m_fan.beta[j] * place.y;
    star_changes(m_star, m_star.corners.z, { ux, uy, m_fan.corners.z[j] }, { place.x, place.y, z }, changes, after);
    apply(m_star, changes, m_fan, m_fan.normals, j, [&](Index q) -> FanSums& { return m_mesh.nodes[q].sums; });
    m_mesh.nodes[t].sums = add_up(after, lanes);

    for (int c = 0; c < m_fan.more_channels; ++c) {
        const ChannelFan& m = m_fan.more[c];
        const float zc = m.offset[j] - m.alpha[j] * place.x - m.beta[j] * place.y;
        star_changes(m_star, m_star.more_z[c], { ux, uy, m.z[j] }, { place.x, place.y, zc }, changes, after);
        apply(m_star, changes, m_fan, m.normals, j, [&](Index q) -> ChannelSums& { return m_mesh.more_of(q)[c].sums; });
        const FanSums s = add_up(after, lanes);
        m_mesh.more_of(t)[c].sums = { s.xx, s.xy, s.yy, s.xz, s.yz, s.x, s.y };
    }
}

void TileWorker::update_rings(Index t, Index u)
{
    for (int i = m_star.vl + 1; i < m_star.degree; ++i)
        if (m_star.ring[i] != kGhost)
            replace_in(m_mesh.rings[m_star.ring[i]], u, t);
    for (int i : { 0, m_star.vl })
        if (const Index q = m_star.ring[i]; q != kGhost) {
            remove_from(m_mesh.rings[q], u);
            --m_mesh.nodes[q].degree;
        }
    std::copy(m_star.ring, m_star.ring + kLanes, m_mesh.rings[t].v.begin());
    m_mesh.nodes[t].degree = std::uint8_t(m_star.degree);
    m_mesh.nodes[u].degree = 0;
}

void collapse_listed(WorkingMesh& mesh, const std::vector<Index>& vertices, const TileJob& job, TileOutput& output)
{
    TileWorker(mesh, job, output).run(vertices.data(), vertices.size(), job.limit);
}

void collapse_tile(WorkingMesh& mesh, const Tile& tile, const TileJob& job, TileOutput& output)
{
    TileWorker worker(mesh, job, output);
    output.candidates.resize(tile.last - tile.first + kLanes);  // a vector may be stored past the last
    for (float share : kSteps) {
        const float limit = job.limit * share;
        worker.run(output.candidates.data(), collect(mesh, tile, limit, output.candidates.data()), limit);
    }
}

void start_tile(WorkingMesh& mesh, const Tile& tile)
{
    TileOutput none;
    TileWorker worker(mesh, { kEverywhere, 0.0f, 0.0f }, none);
    for (Index v = tile.first; v < tile.last; ++v)
        worker.start(v);
}

}  // namespace HWY_NAMESPACE
}  // namespace PIMG_ABI
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pimg {
inline namespace PIMG_ABI {

HWY_EXPORT(collapse_tile);
HWY_EXPORT(collapse_listed);
HWY_EXPORT(start_tile);

void collapse_tile(WorkingMesh& mesh, const Tile& tile, const TileJob& job, TileOutput& output)
{
    HWY_DYNAMIC_DISPATCH(collapse_tile)(mesh, tile, job, output);
}

void collapse_listed(WorkingMesh& mesh, const std::vector<Index>& vertices, const TileJob& job, TileOutput& output)
{
    HWY_DYNAMIC_DISPATCH(collapse_listed)(mesh, vertices, job, output);
}

void start_tile(WorkingMesh& mesh, const Tile& tile)
{
    HWY_DYNAMIC_DISPATCH(start_tile)(mesh, tile);
}

}  // namespace PIMG_ABI
}  // namespace pimg
#endif
