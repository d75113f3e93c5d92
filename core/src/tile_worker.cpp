// SPDX-License-Identifier: BSD-3-Clause
#include "tile_worker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tile_worker.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "collapse_cost-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pimg {
namespace HWY_NAMESPACE {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kPixel = 1.0f / float(kSubpixels);

/// Shares of the limit through which a tile approaches it: powers of 4^(1/6).
constexpr float kSteps[] = { 0.31498026f, 0.39685026f, 0.5f, 0.62996052f, 0.79370052f, 1.0f };

/// Key of a vertex just made, as a multiple of the cost that made it. Its edges are hardly ever cheaper than
/// that; not looking at once saves an evaluation in nine and changes no quality (docs/internals.md).
constexpr float kFreshKey = 3.0f;

/// Stands in for the ghost and for lanes past the degree.
const Node kNoNode = {};

inline int lanes_for(int degree)
{
    return degree <= 8 ? 8 : kLanes;
}

inline void add(FanSums& sums, const float* d)
{
    float* s = &sums.xx;
    for (int k = 0; k < 9; ++k)
        s[k] += d[k];
}

HWY_INLINE void clear(Corners& c, int lanes)
{
    const Lanes d;
    for (int j = 0; j < lanes; j += int(hn::Lanes(d)))
        for (float* of : { c.x, c.y, c.z, c.real })
            hn::Store(hn::Zero(d), d, of + j);
}

/// Numbers of the vertices of a tile whose key is at most `limit`.
HWY_INLINE void collect(const WorkingMesh& mesh, const Tile& tile, float limit, std::vector<Index>& candidates)
{
    const Lanes d;
    const Index step = Index(hn::Lanes(d));
    const auto most = hn::Set(d, limit);
    candidates.clear();
    for (Index v = tile.first; v < tile.last; v += step) {
        const bool partial = v + step > tile.last;
        if (!partial && hn::AllFalse(d, hn::Le(hn::LoadU(d, &mesh.keys[v]), most)))
            continue;
        for (Index q = v; q < (partial ? tile.last : v + step); ++q)
            if (mesh.keys[q] <= limit)
                candidates.push_back(q);
    }
}

/// Copies four neighbours' nodes into lanes j .. j + 3: twelve floats each, turned on their side.
HWY_INLINE void load_nodes(const Node* const (&from)[4], Point centre, float centre_z, int j, EdgeFan& fan)
{
    const Four f;
    const hn::FixedTag<std::int32_t, 4> i;
    V4 row[4][3];
    for (int k = 0; k < 4; ++k)
        for (int part = 0; part < 3; ++part)
            row[k][part] = hn::Load(f, &from[k]->sums.xx + 4 * part);
    for (int part = 0; part < 3; ++part)
        transpose(row[0][part], row[1][part], row[2][part], row[3][part]);
    for (int k = 0; k < 4; ++k)
        hn::Store(row[k][0], f, fan.a[k] + j);
    hn::Store(row[0][1], f, fan.a[4] + j);
    hn::Store(row[1][1], f, fan.a[5] + j);
    hn::Store(row[2][1], f, fan.n[0] + j);
    hn::Store(row[3][1], f, fan.n[1] + j);
    hn::Store(row[0][2], f, fan.n[2] + j);
    const V4 real = hn::Load(f, fan.corners.real + j), pixel = hn::Set(f, kPixel);
    const auto px = hn::BitCast(i, row[2][2]) - hn::Set(i, centre.x);
    const auto py = hn::BitCast(i, row[3][2]) - hn::Set(i, centre.y);
    hn::Store(real * (row[1][2] - hn::Set(f, centre_z)), f, fan.corners.z + j);
    hn::Store(real * (hn::ConvertTo(f, px) * pixel), f, fan.corners.x + j);
    hn::Store(real * (hn::ConvertTo(f, py) * pixel), f, fan.corners.y + j);
}

/// The star s will have: ring of t from vr to vl, then that of u back to vr.
struct Star {
    int degree, vl;  ///< place of vl; vr is at 0
    Corners corners; ///< relative to t
    Index ring[kLanes];
    Point points[kLanes];
};

struct Placement {
    float x, y, z;
};

class TileWorker {
public:
    TileWorker(WorkingMesh& mesh, const TileJob& job, TileOutput& output)
        : m_mesh(mesh), m_zone(job.zone), m_guard(job.guard), m_out(output)
    {
    }

    void run(const std::vector<Index>& vertices, float limit);
    void add_up_fan(Index v);

private:
    void visit(Index v, float limit);
    bool load_fan(Index v, bool check_zone);
    int cheapest() const;
    bool load_star(Index t, int j, bool& deferred);
    bool find_placement(int j, float limit, float& cost, Placement& place) const;
    bool keeps_shape(float x, float y) const;
    void collapse(Index t, int j, const Placement& place, float cost);
    void record(Index t, Index u, Point coarse, float order);
    void update_sums(Index t, int j, const Placement& place);
    void update_rings(Index t, Index u);

    WorkingMesh& m_mesh;
    Zone m_zone;
    float m_guard;
    TileOutput& m_out;
    EdgeFan m_fan;
    Star m_star;
};

void TileWorker::run(const std::vector<Index>& vertices, float limit)
{
    constexpr std::size_t kAhead = 6, kRingAhead = 3;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (i + kAhead < vertices.size())
            m_mesh.prefetch(vertices[i + kAhead]);
        if (i + kRingAhead < vertices.size()) {
            const Index v = vertices[i + kRingAhead];
            for (int j = 0; j < m_mesh.nodes[v].degree; ++j)
                if (m_mesh.rings[v].v[std::size_t(j)] != kGhost)
                    __builtin_prefetch(&m_mesh.nodes[m_mesh.rings[v].v[std::size_t(j)]]);
        }
        if (m_mesh.keys[vertices[i]] <= limit)
            visit(vertices[i], limit);
    }
}

void TileWorker::add_up_fan(Index v)
{
    load_fan(v, false);
    fan_normals(m_fan.corners, m_fan.degree, m_fan.lanes, m_fan.normals);
    m_mesh.nodes[v].sums = add_up(m_fan.normals, m_fan.lanes);
}

/// Evaluates the edges of v; collapses the cheapest that may be, or files v under its cost.
void TileWorker::visit(Index v, float limit)
{
    if (!load_fan(v, true)) {
        m_out.deferred.push_back(v);
        return;
    }
    evaluate_edges(m_fan);
    ++m_out.evaluations;
    m_mesh.nodes[v].sums = m_fan.sums;  // freshly added up: what updates left of rounding is gone
    for (;;) {
        const int j = cheapest();
        float& cost = m_fan.cost[j];
        if (!(cost <= limit)) {
            m_mesh.keys[v] = cost;
            return;
        }
        bool deferred = false;
        Placement place;
        if (load_star(v, j, deferred) && find_placement(j, limit, cost, place)) {
            if (cost <= limit) {
                collapse(v, j, place, cost);
                return;
            }
            continue;  // legal only at a higher cost: filed under it unless another edge is cheaper
        }
        if (deferred) {
            m_out.deferred.push_back(v);
            return;
        }
        cost = kInfinity;
        ++m_out.refused;
    }
}

/// Gathers the neighbours of v; false when one is outside the zone.
bool TileWorker::load_fan(Index v, bool check_zone)
{
    const Node& node = m_mesh.nodes[v];
    const Ring& ring = m_mesh.rings[v];
    const int degree = node.degree, lanes = lanes_for(degree);
    m_fan.degree = degree;
    m_fan.lanes = lanes;
    m_fan.side = node.side;
    std::uint8_t sides = node.side;
    const Node* from[kLanes];
    for (int j = 0; j < degree; ++j) {
        const Index q = ring.v[std::size_t(j)];
        from[j] = q == kGhost ? &kNoNode : &m_mesh.nodes[q];
        m_fan.corners.real[j] = q == kGhost ? 0.0f : 1.0f;
        if (check_zone && q != kGhost && !m_zone.contains(from[j]->home))
            return false;
        sides |= from[j]->side;
    }
    for (int j = degree; j < lanes; ++j) {
        from[j] = &kNoNode;
        m_fan.corners.real[j] = 0.0f;
    }
    for (int j = 0; j < lanes; j += 4)
        load_nodes({ from[j], from[j + 1], from[j + 2], from[j + 3] }, node.p, node.z, j, m_fan);
    close(m_fan.corners, degree, lanes);
    m_fan.on_border = sides != kFree;
    if (m_fan.on_border)
        for (int j = 0; j < lanes; ++j) {
            m_fan.fixed_x[j] = from[j]->side & kFixedX ? 1.0f : 0.0f;
            m_fan.fixed_y[j] = from[j]->side & kFixedY ? 1.0f : 0.0f;
        }
    return true;
}

int TileWorker::cheapest() const
{
    int best = 0;
    for (int j = 1; j < m_fan.degree; ++j)
        if (m_fan.cost[j] < m_fan.cost[best])
            best = j;
    return best;
}

/// Gathers the star that merging t with its neighbour j would have. False when topology or the sides of
/// the picture forbid the collapse (link condition, ghost counted), or it reaches beyond the zone.
bool TileWorker::load_star(Index t, int j, bool& deferred)
{
    const Node& node = m_mesh.nodes[t];
    const Ring& ring = m_mesh.rings[t];
    const Index u = ring.v[std::size_t(j)];
    const Node& other = m_mesh.nodes[u];
    const Ring& other_ring = m_mesh.rings[u];
    const int degree = node.degree + other.degree - 4;
    if (degree > kMaxDegree || degree < 3)
        return false;
    if ((node.side & other.side & kFixedX && node.p.x != other.p.x)
        || (node.side & other.side & kFixedY && node.p.y != other.p.y))
        return false;  // two opposite sides

    int n = 0;
    for (int k = 1; k < node.degree; ++k)
        m_star.ring[n++] = ring.v[std::size_t(j + k < node.degree ? j + k : j + k - node.degree)];
    m_star.vl = n - 1;
    const int at = find(other_ring, other.degree, t);
    for (int k = 2; k + 1 < other.degree; ++k) {
        const Index q = other_ring.v[std::size_t(at + k < other.degree ? at + k : at + k - other.degree)];
        if (find(ring, node.degree, q) >= 0)
            return false;  // a third common neighbour
        m_star.ring[n++] = q;
    }
    m_star.degree = n;
    for (int k : { 0, m_star.vl })
        if (m_star.ring[k] != kGhost && m_mesh.nodes[m_star.ring[k]].degree <= 3)
            return false;

    clear(m_star.corners, lanes_for(n));
    for (int k = 0; k < n; ++k) {
        const Index q = m_star.ring[k];
        const Node& corner = q == kGhost ? node : m_mesh.nodes[q];
        if (!m_zone.contains(corner.home)) {
            deferred = true;
            return false;
        }
        m_star.corners.x[k] = float(corner.p.x - node.p.x) * kPixel;
        m_star.corners.y[k] = float(corner.p.y - node.p.y) * kPixel;
        m_star.corners.z[k] = corner.z - node.z;
        m_star.corners.real[k] = q == kGhost ? 0.0f : 1.0f;
        m_star.points[k] = corner.p;
    }
    close(m_star.corners, n, lanes_for(n));
    return true;
}

/// A lattice point where every triangle of the star keeps its shape: the optimum if it can be, else
/// points between it, the midpoint and the ends. Sets the cost there. Stops at the first that is cheap enough.
bool TileWorker::find_placement(int j, float limit, float& cost, Placement& place) const
{
    const float dx = m_fan.corners.x[j], dy = m_fan.corners.y[j], x = m_fan.x[j], y = m_fan.y[j];
    const float candidates[6][2] = { { x, y },
                                     { 0.5f * x + 0.25f * dx, 0.5f * y + 0.25f * dy },
                                     { 0.5f * dx, 0.5f * dy },
                                     { 0.0f, 0.0f },
                                     { dx, dy },
                                     { 0.25f * x + 0.375f * dx, 0.25f * y + 0.375f * dy } };
    const auto on_lattice = [](float v) { return std::nearbyint(v * float(kSubpixels)) * kPixel; };
    const bool other_x = m_fan.on_border && m_fan.fixed_x[j] > 0.0f;
    const bool other_y = m_fan.on_border && m_fan.fixed_y[j] > 0.0f;
    float best = kInfinity;
    for (int c = 0; c < 6 && !(best <= limit); ++c) {
        const float cx = m_fan.side & kFixedX ? 0.0f : (other_x ? dx : on_lattice(candidates[c][0]));
        const float cy = m_fan.side & kFixedY ? 0.0f : (other_y ? dy : on_lattice(candidates[c][1]));
        if (!keeps_shape(cx, cy))
            continue;
        const float here = c == 0 ? cost : edge_cost_at(m_fan, j, cx, cy);
        if (here < best) {
            best = here;
            place = { cx, cy, m_fan.offset[j] - m_fan.alpha[j] * cx - m_fan.beta[j] * cy };
        }
    }
    cost = best;
    return best < kInfinity;
}

/// The guard: every triangle of the star keeps its orientation and stays away from a sliver. The margin is far
/// above what single precision can lose in the area, so orientation is certain.
bool TileWorker::keeps_shape(float x, float y) const
{
    const Lanes d;
    const auto vx = hn::Set(d, x), vy = hn::Set(d, y), guard = hn::Set(d, m_guard);
    bool ok = true;
    for (int j = 0; j < m_star.degree; j += int(hn::Lanes(d))) {
        const Vec3 a = corner(m_star.corners, j), b = corner(m_star.corners, j + 1);
        const auto ex = a.x - vx, ey = a.y - vy, fx = b.x - vx, fy = b.y - vy, gx = a.x - b.x, gy = a.y - b.y;
        const auto longest = hn::Max(hn::Max(ex * ex + ey * ey, fx * fx + fy * fy), gx * gx + gy * gy);
        const auto short_of = hn::Lt(ex * fy - fx * ey, guard * longest);
        const auto triangle = hn::Gt(whole(m_star.corners, m_star.degree, j), hn::Zero(d));
        ok &= hn::AllFalse(d, hn::And(short_of, triangle));
    }
    return ok;
}

void TileWorker::collapse(Index t, int j, const Placement& place, float cost)
{
    const Index u = m_mesh.rings[t].v[std::size_t(j)];
    update_sums(t, j, place);

    Node& s = m_mesh.nodes[t];
    const Node& other = m_mesh.nodes[u];
    const Point p { s.p.x + std::int32_t(place.x * float(kSubpixels)),
                    s.p.y + std::int32_t(place.y * float(kSubpixels)) };
    float order = std::max({ cost, s.order, other.order });
    for (int i = 0; i < m_star.degree; ++i) {
        const Index q = m_star.ring[i];
        if (q == kGhost)
            continue;
        order = std::max(order, m_mesh.nodes[q].order);
        if (m_mesh.keys[q] == kInfinity)
            m_mesh.keys[q] = 0.0f;  // what was refused there may be possible now
    }
    record(t, u, p, order);

    s.p = p;
    s.z += place.z;
    s.order = order;
    s.side |= other.side;
    update_rings(t, u);
    m_mesh.keys[t] = kFreshKey * cost;
    m_mesh.keys[u] = kInfinity;
}

void TileWorker::record(Index t, Index u, Point coarse, float order)
{
    const auto name = [&](Index v) { return v == kGhost ? kGhost : m_mesh.nodes[v].name; };
    const Node &node = m_mesh.nodes[t], &other = m_mesh.nodes[u];
    const Projection pt = project(node.p, coarse, m_star.degree, m_star.ring, m_star.points);
    const Projection pu = project(other.p, coarse, m_star.degree, m_star.ring, m_star.points);
    m_out.records.push_back(
        { { node.name, name(m_star.ring[m_star.vl]), name(m_star.ring[0]), node.p, other.p },
          other.name,
          { node.name, name(pt.a), name(pt.b), name(pu.a), name(pu.b), pt.wa, pt.wb, pu.wa, pu.wb },
          node.z,
          other.z,
          order });
}

/// Replaces the old triangles' contributions to every fan by the new ones'. A normal does not depend
/// on the origin, so the three vertices of a triangle share its contribution.
void TileWorker::update_sums(Index t, int j, const Placement& place)
{
    const Lanes d;
    const int n = m_star.degree, lanes = lanes_for(n);
    const Vec3 s { hn::Set(d, place.x), hn::Set(d, place.y), hn::Set(d, place.z) };
    const auto ux = hn::Set(d, m_fan.corners.x[j]), uy = hn::Set(d, m_fan.corners.y[j]);
    const auto uz = hn::Set(d, m_fan.corners.z[j]);
    Normals after;
    HWY_ALIGN float delta[9][kLanes];
    for (int k = 0; k < lanes; k += int(hn::Lanes(d))) {
        // The old triangles have their apex in t up to vl, in u from there on.
        const auto of_u = hn::IfThenZeroElse(hn::Lt(hn::Iota(d, float(k)), hn::Set(d, float(m_star.vl))),
                                             hn::Set(d, 1.0f));
        const Vec3 apex { of_u * ux, of_u * uy, of_u * uz };
        const Vec3 a = corner(m_star.corners, k), b = corner(m_star.corners, k + 1);
        const auto mask = whole(m_star.corners, n, k);
        const Vec3 o = cross(a - apex, b - apex, mask), p = cross(a - s, b - s, mask);
        store(p, after, k);
        hn::Store(p.x * p.x - o.x * o.x, d, delta[0] + k);
        hn::Store(p.x * p.y - o.x * o.y, d, delta[1] + k);
        hn::Store(p.y * p.y - o.y * o.y, d, delta[2] + k);
        hn::Store(p.x * p.z - o.x * o.z, d, delta[3] + k);
        hn::Store(p.y * p.z - o.y * o.z, d, delta[4] + k);
        hn::Store(p.z * p.z - o.z * o.z, d, delta[5] + k);
        hn::Store(p.x - o.x, d, delta[6] + k);
        hn::Store(p.y - o.y, d, delta[7] + k);
        hn::Store(p.z - o.z, d, delta[8] + k);
    }
    for (int i = 0; i < n; ++i) {
        if (m_star.ring[i] == kGhost)
            continue;
        float* sums = &m_mesh.nodes[m_star.ring[i]].sums.xx;
        const int previous = i > 0 ? i - 1 : n - 1;
        for (int k = 0; k < 9; ++k)
            sums[k] += delta[k][i] + delta[k][previous];
    }
    // The two triangles that vanish with the edge.
    const auto drop = [&](Index q, float x, float y, float z) {
        const float gone[9] = { -x * x, -x * y, -y * y, -x * z, -y * z, -z * z, -x, -y, -z };
        if (q != kGhost)
            add(m_mesh.nodes[q].sums, gone);
    };
    const Normals& old = m_fan.normals;
    drop(m_star.ring[0], old.x[j], old.y[j], old.z[j]);
    const int before = j > 0 ? j - 1 : m_fan.degree - 1;
    drop(m_star.ring[m_star.vl], old.x[before], old.y[before], old.z[before]);
    m_mesh.nodes[t].sums = add_up(after, lanes);
}

void TileWorker::update_rings(Index t, Index u)
{
    for (int i = m_star.vl + 1; i < m_star.degree; ++i) {
        const Index q = m_star.ring[i];
        if (q != kGhost)
            replace(m_mesh.rings[q], m_mesh.nodes[q].degree, u, t);
    }
    for (int i : { 0, m_star.vl }) {
        const Index q = m_star.ring[i];
        if (q == kGhost)
            continue;
        Node& node = m_mesh.nodes[q];
        Ring& ring = m_mesh.rings[q];
        node.degree = std::uint8_t(remove_at(ring, node.degree, find(ring, node.degree, u)));
    }
    std::copy(m_star.ring, m_star.ring + m_star.degree, m_mesh.rings[t].v.begin());
    m_mesh.nodes[t].degree = std::uint8_t(m_star.degree);
    m_mesh.nodes[u].degree = 0;
}

void collapse_listed(WorkingMesh& mesh, const std::vector<Index>& vertices, const TileJob& job, TileOutput& output)
{
    TileWorker(mesh, job, output).run(vertices, job.limit);
}

void collapse_tile(WorkingMesh& mesh, const Tile& tile, const TileJob& job, TileOutput& output)
{
    TileWorker worker(mesh, job, output);
    std::vector<Index> candidates;
    for (float share : kSteps) {
        const float limit = job.limit * share;
        collect(mesh, tile, limit, candidates);
        worker.run(candidates, limit);
    }
}

void add_up_fans(WorkingMesh& mesh, Index first, Index last)
{
    TileOutput none;
    TileWorker worker(mesh, {}, none);
    for (Index v = first; v < last; ++v)
        worker.add_up_fan(v);
}

}  // namespace HWY_NAMESPACE
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pimg {

HWY_EXPORT(collapse_tile);
HWY_EXPORT(collapse_listed);
HWY_EXPORT(add_up_fans);

void collapse_tile(WorkingMesh& mesh, const Tile& tile, const TileJob& job, TileOutput& output)
{
    HWY_DYNAMIC_DISPATCH(collapse_tile)(mesh, tile, job, output);
}

void collapse_listed(WorkingMesh& mesh, const std::vector<Index>& vertices, const TileJob& job, TileOutput& output)
{
    HWY_DYNAMIC_DISPATCH(collapse_listed)(mesh, vertices, job, output);
}

void add_up_fans(WorkingMesh& mesh, Index first, Index last)
{
    HWY_DYNAMIC_DISPATCH(add_up_fans)(mesh, first, last);
}

}  // namespace pimg
#endif
