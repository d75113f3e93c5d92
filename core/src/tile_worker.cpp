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
    int degree, vl;   ///< place of vl; vr is at 0
    Corners corners;  ///< relative to t
    alignas(64) float more_z[kMaxGuideChannels - 1][kLanes + 8];
    Index ring[kLanes];
    Point points[kLanes];
};

struct Placement {
    float x, y;
};

class TileWorker {
public:
    TileWorker(WorkingMesh& mesh, const TileJob& job, TileOutput& output)
        : m_mesh(mesh), m_zone(job.zone), m_guard(job.guard), m_out(output)
    {
        m_fan.more_channels = mesh.more_channels;
        std::copy(mesh.weights.begin(), mesh.weights.end(), m_fan.weights);
    }

    void run(const std::vector<Index>& vertices, float limit);
    void add_up_fan(Index v);

private:
    void visit(Index v, float limit);
    bool load_fan(Index v, bool check_zone);
    void load_more_channels(Index v);
    void keep_sums(Index v);
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
    add_up_channels(m_fan);
    keep_sums(v);
}

/// Stores the sums just added up: what updates left of rounding is gone.
void TileWorker::keep_sums(Index v)
{
    m_mesh.nodes[v].sums = m_fan.sums;
    for (int c = 0; c < m_fan.more_channels; ++c)
        m_mesh.more_of(v)[c] = m_fan.more[c].sums;
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
    keep_sums(v);
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
    if (m_fan.more_channels > 0)
        load_more_channels(v);
    m_fan.on_border = sides != kFree;
    if (m_fan.on_border)
        for (int j = 0; j < lanes; ++j) {
            m_fan.fixed_x[j] = from[j]->side & kFixedX ? 1.0f : 0.0f;
            m_fan.fixed_y[j] = from[j]->side & kFixedY ? 1.0f : 0.0f;
        }
    return true;
}

/// The part of load_fan() that guide channels after the first need.
void TileWorker::load_more_channels(Index v)
{
    const ChannelSums none {};
    for (int c = 0; c < m_fan.more_channels; ++c) {
        ChannelFan& m = m_fan.more[c];
        m.sums.value = m_mesh.more_of(v)[c].value;
        for (int j = 0; j < m_fan.lanes; ++j) {
            const Index q = j < m_fan.degree ? m_mesh.rings[v].v[std::size_t(j)] : kGhost;
            const ChannelSums& s = q == kGhost ? none : m_mesh.more_of(q)[c];
            m.z[j] = q == kGhost ? 0.0f : s.value - m.sums.value;
            m.a[0][j] = s.xx;
            m.a[1][j] = s.xy;
            m.a[2][j] = s.yy;
            m.a[3][j] = s.xz;
            m.a[4][j] = s.yz;
            m.n[0][j] = s.x;
            m.n[1][j] = s.y;
        }
        m.z[m_fan.lanes] = 0.0f;
        m.z[m_fan.degree] = m.z[0];
    }
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
    for (int c = 0; c < m_fan.more_channels; ++c) {
        float* z = m_star.more_z[c];
        std::fill(z, z + lanes_for(n) + 1, 0.0f);
        for (int k = 0; k < n; ++k)
            if (m_star.ring[k] != kGhost)
                z[k] = m_mesh.more_of(m_star.ring[k])[c].value - m_mesh.more_of(t)[c].value;
        z[n] = z[0];
    }
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
            place = { cx, cy };
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
        const Vec3 a = corner(m_star.corners, m_star.corners.z, j), b = corner(m_star.corners, m_star.corners.z, j + 1);
        const auto ex = a.x - vx, ey = a.y - vy, fx = b.x - vx, fy = b.y - vy, gx = a.x - b.x, gy = a.y - b.y;
        const auto longest = hn::Max(hn::Max(ex * ex + ey * ey, fx * fx + fy * fy), gx * gx + gy * gy);
        // Asked so that a NaN is a no.
        const auto enough = hn::Ge(ex * fy - fx * ey, guard * longest);
        const auto none = hn::Le(whole(m_star.corners, m_star.degree, j), hn::Zero(d));
        ok &= hn::AllTrue(d, hn::Or(enough, none));
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
    for (int c = 0; c < m_fan.more_channels; ++c)
        m_out.more.push_back({ m_mesh.more_of(t)[c].value, m_mesh.more_of(u)[c].value });
}

/// New minus old products of the normals around a star, triangle by triangle: xx xy yy xz yz x y | zz z.
/// A normal does not depend on the origin, so the three vertices of a triangle share its contribution.
struct Changes {
    alignas(64) float of[9][kLanes];
};

/// Fills rows 0..6 of `changes` for one channel (and 7, 8 for the first) and the new normals. `z` are the corners'
/// intensities, `u` the far end of the edge and `s` the new place, all relative to t.
HWY_INLINE void star_changes(const Star& star, const float* z, const float (&u)[3], const float (&s)[3], bool areas,
                             Changes& changes, Normals& after)
{
    const Lanes d;
    const Vec3 to { hn::Set(d, s[0]), hn::Set(d, s[1]), hn::Set(d, s[2]) };
    const auto ux = hn::Set(d, u[0]), uy = hn::Set(d, u[1]), uz = hn::Set(d, u[2]);
    const auto last_of_t = hn::Set(d, float(star.vl));
    for (int k = 0; k < lanes_for(star.degree); k += int(hn::Lanes(d))) {
        // The old triangles have their apex in t up to vl, in u from there on.
        const auto of_u = hn::IfThenZeroElse(hn::Lt(hn::Iota(d, float(k)), last_of_t), hn::Set(d, 1.0f));
        const Vec3 apex { of_u * ux, of_u * uy, of_u * uz };
        const Vec3 a = corner(star.corners, z, k), b = corner(star.corners, z, k + 1);
        const auto mask = whole(star.corners, star.degree, k);
        const Vec3 o = cross(a - apex, b - apex, mask), p = cross(a - to, b - to, mask);
        store(p, after, k);
        hn::Store(p.x * p.x - o.x * o.x, d, changes.of[0] + k);
        hn::Store(p.x * p.y - o.x * o.y, d, changes.of[1] + k);
        hn::Store(p.y * p.y - o.y * o.y, d, changes.of[2] + k);
        hn::Store(p.x * p.z - o.x * o.z, d, changes.of[3] + k);
        hn::Store(p.y * p.z - o.y * o.z, d, changes.of[4] + k);
        hn::Store(p.x - o.x, d, changes.of[5] + k);
        hn::Store(p.y - o.y, d, changes.of[6] + k);
        if (areas) {
            hn::Store(p.z * p.z - o.z * o.z, d, changes.of[7] + k);
            hn::Store(p.z - o.z, d, changes.of[8] + k);
        }
    }
}

/// Adds `d` (rows as in Changes) to a fan's sums.
HWY_INLINE void add(FanSums& s, const float* d)
{
    s.xx += d[0];
    s.xy += d[1];
    s.yy += d[2];
    s.xz += d[3];
    s.yz += d[4];
    s.x += d[5];
    s.y += d[6];
    s.zz += d[7];
    s.z += d[8];
}

HWY_INLINE void add(ChannelSums& s, const float* d)
{
    float* sums = &s.xx;
    for (int k = 0; k < 7; ++k)
        sums[k] += d[k];
}

/// Applies the changes to every vertex of the star, and takes away the two triangles that vanish with edge j.
/// `sums_of(q)` gives the sums of vertex q.
template<class SumsOf>
HWY_INLINE void apply(const Star& star, const Changes& changes, const EdgeFan& fan, const Normals& old, int j,
                      SumsOf&& sums_of)
{
    for (int i = 0; i < star.degree; ++i) {
        if (star.ring[i] == kGhost)
            continue;
        const int previous = i > 0 ? i - 1 : star.degree - 1;
        float d[9];
        for (int k = 0; k < 9; ++k)
            d[k] = changes.of[k][i] + changes.of[k][previous];
        add(sums_of(star.ring[i]), d);
    }
    const auto drop = [&](Index q, int lane) {
        const float x = old.x[lane], y = old.y[lane], z = fan.normals.z[lane];
        const float gone[9] = { -x * x, -x * y, -y * y, -x * z, -y * z, -x, -y, -z * z, -z };
        if (q != kGhost)
            add(sums_of(q), gone);
    };
    drop(star.ring[0], j);
    drop(star.ring[star.vl], j > 0 ? j - 1 : fan.degree - 1);
}

/// Replaces the old triangles' contributions to every fan by the new ones'.
void TileWorker::update_sums(Index t, int j, const Placement& place)
{
    const float ux = m_fan.corners.x[j], uy = m_fan.corners.y[j];
    const int lanes = lanes_for(m_star.degree);
    Changes changes;
    Normals after;
    const float z = m_fan.offset[j] - m_fan.alpha[j] * place.x - m_fan.beta[j] * place.y;
    star_changes(m_star, m_star.corners.z, { ux, uy, m_fan.corners.z[j] }, { place.x, place.y, z }, true, changes, after);
    apply(m_star, changes, m_fan, m_fan.normals, j, [&](Index q) -> FanSums& { return m_mesh.nodes[q].sums; });
    m_mesh.nodes[t].sums = add_up(after, lanes);

    for (int c = 0; c < m_fan.more_channels; ++c) {
        const ChannelFan& m = m_fan.more[c];
        const float zc = m.offset[j] - m.alpha[j] * place.x - m.beta[j] * place.y;
        star_changes(m_star, m_star.more_z[c], { ux, uy, m.z[j] }, { place.x, place.y, zc }, false, changes, after);
        apply(m_star, changes, m_fan, m.normals, j, [&](Index q) -> ChannelSums& { return m_mesh.more_of(q)[c]; });
        const FanSums s = add_up(after, lanes);
        ChannelSums& own = m_mesh.more_of(t)[c];
        own = { s.xx, s.xy, s.yy, s.xz, s.yz, s.x, s.y, own.value };
    }
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
