// SPDX-License-Identifier: BSD-3-Clause
#include "tile_worker.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pimg {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kPixel = 1.0f / float(kSubpixels);

float on_lattice(float v)
{
    return std::nearbyint(v * float(kSubpixels)) * kPixel;
}

}  // namespace

void TileWorker::run(const Tile& tile, float limit)
{
    m_candidates.clear();
    for (Index v = tile.first; v < tile.last; ++v)
        if (m_mesh.keys[v] <= limit)
            m_candidates.push_back(v);
    run(m_candidates, limit);
}

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

/// Evaluates the edges of v; collapses the cheapest that may be, or files v under its cost.
void TileWorker::visit(Index v, float limit)
{
    if (!load_fan(v)) {
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
bool TileWorker::load_fan(Index v)
{
    const Node& node = m_mesh.nodes[v];
    const Ring& ring = m_mesh.rings[v];
    m_fan.degree = node.degree;
    m_fan.side = node.side;
    for (int j = 0; j < node.degree; ++j) {
        const Index q = ring.v[std::size_t(j)];
        if (q == kGhost) {
            m_fan.dx[j] = m_fan.dy[j] = m_fan.dz[j] = m_fan.real[j] = m_fan.fixed_x[j] = m_fan.fixed_y[j] = 0.0f;
            for (auto& lane : m_fan.a)
                lane[j] = 0.0f;
            for (auto& lane : m_fan.n)
                lane[j] = 0.0f;
            continue;
        }
        const Node& other = m_mesh.nodes[q];
        if (!m_zone.contains(other.home))
            return false;
        m_fan.dx[j] = float(other.p.x - node.p.x) * kPixel;
        m_fan.dy[j] = float(other.p.y - node.p.y) * kPixel;
        m_fan.dz[j] = other.z - node.z;
        m_fan.real[j] = 1.0f;
        m_fan.fixed_x[j] = other.side & kFixedX ? 1.0f : 0.0f;
        m_fan.fixed_y[j] = other.side & kFixedY ? 1.0f : 0.0f;
        m_fan.a[0][j] = other.sums.xx;
        m_fan.a[1][j] = other.sums.xy;
        m_fan.a[2][j] = other.sums.yy;
        m_fan.a[3][j] = other.sums.xz;
        m_fan.a[4][j] = other.sums.yz;
        m_fan.a[5][j] = other.sums.zz;
        m_fan.n[0][j] = other.sums.x;
        m_fan.n[1][j] = other.sums.y;
        m_fan.n[2][j] = other.sums.z;
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
        m_star.ring[n++] = ring.v[std::size_t((j + k) % node.degree)];
    m_star.vl = n - 1;
    const int at = find(other_ring, other.degree, t);
    for (int k = 2; k + 1 < other.degree; ++k) {
        const Index q = other_ring.v[std::size_t((at + k) % other.degree)];
        if (find(ring, node.degree, q) >= 0)
            return false;  // a third common neighbour
        m_star.ring[n++] = q;
    }
    m_star.degree = n;
    for (int k : { 0, m_star.vl })
        if (m_star.ring[k] != kGhost && m_mesh.nodes[m_star.ring[k]].degree <= 3)
            return false;

    for (int k = 0; k < n; ++k) {
        const Index q = m_star.ring[k];
        if (q == kGhost) {
            m_star.x[k] = m_star.y[k] = m_star.z[k] = m_star.real[k] = 0.0f;
            m_star.points[k] = {};
            continue;
        }
        const Node& corner = m_mesh.nodes[q];
        if (!m_zone.contains(corner.home)) {
            deferred = true;
            return false;
        }
        m_star.x[k] = float(corner.p.x - node.p.x) * kPixel;
        m_star.y[k] = float(corner.p.y - node.p.y) * kPixel;
        m_star.z[k] = corner.z - node.z;
        m_star.real[k] = 1.0f;
        m_star.points[k] = corner.p;
    }
    return true;
}

/// A lattice point where every triangle of the star keeps its shape: the optimum if it can be, else
/// points between it, the midpoint and the ends. Sets the cost there. Stops at the first that is cheap enough.
bool TileWorker::find_placement(int j, float limit, float& cost, Placement& place) const
{
    const float dx = m_fan.dx[j], dy = m_fan.dy[j], x = m_fan.x[j], y = m_fan.y[j];
    const float candidates[6][2] = { { x, y },
                                     { 0.5f * (x + 0.5f * dx), 0.5f * (y + 0.5f * dy) },
                                     { 0.5f * dx, 0.5f * dy },
                                     { 0.0f, 0.0f },
                                     { dx, dy },
                                     { 0.25f * x + 0.375f * dx, 0.25f * y + 0.375f * dy } };
    const bool own_x = m_fan.side & kFixedX, own_y = m_fan.side & kFixedY;
    float best = kInfinity;
    for (int c = 0; c < 6; ++c) {
        const float cx = own_x ? 0.0f : (m_fan.fixed_x[j] > 0.0f ? dx : on_lattice(candidates[c][0]));
        const float cy = own_y ? 0.0f : (m_fan.fixed_y[j] > 0.0f ? dy : on_lattice(candidates[c][1]));
        if (!keeps_shape(cx, cy))
            continue;
        const float here = c == 0 ? cost : cost_at(m_fan, j, cx, cy);
        if (here < best) {
            best = here;
            place = { cx, cy, m_fan.offset[j] - m_fan.alpha[j] * cx - m_fan.beta[j] * cy };
        }
        if (best <= limit)
            break;
    }
    cost = best;
    return best < kInfinity;
}

/// The guard: every triangle of the star keeps its orientation and stays away from a sliver. The margin is far
/// above what single precision can lose in the area, so orientation is certain.
bool TileWorker::keeps_shape(float x, float y) const
{
    bool ok = true;
    for (int i = 0; i < m_star.degree; ++i) {
        const int next = i + 1 < m_star.degree ? i + 1 : 0;
        if (m_star.real[i] * m_star.real[next] == 0.0f)
            continue;
        const float ex = m_star.x[i] - x, ey = m_star.y[i] - y;
        const float fx = m_star.x[next] - x, fy = m_star.y[next] - y;
        const float gx = ex - fx, gy = ey - fy;
        const float longest = std::max({ ex * ex + ey * ey, fx * fx + fy * fy, gx * gx + gy * gy });
        ok &= ex * fy - fx * ey >= m_guard * longest;
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
    for (int i = 0; i < m_star.degree; ++i)
        if (m_star.ring[i] != kGhost)
            order = std::max(order, m_mesh.nodes[m_star.ring[i]].order);
    record(t, u, s, p, order);

    s.p = p;
    s.z += place.z;
    s.order = order;
    s.side |= other.side;
    update_rings(t, u);
    m_mesh.keys[t] = 0.0f;
    m_mesh.keys[u] = kInfinity;
    for (int i = 0; i < m_star.degree; ++i)
        if (m_star.ring[i] != kGhost && m_mesh.keys[m_star.ring[i]] == kInfinity)
            m_mesh.keys[m_star.ring[i]] = 0.0f;
}

void TileWorker::record(Index t, Index u, const Node& s, const Point& s_point, float order)
{
    const auto name = [&](Index v) { return v == kGhost ? kGhost : m_mesh.nodes[v].name; };
    const Node& other = m_mesh.nodes[u];
    const Projection pt = project(s.p, s_point, m_star.degree, m_star.ring, m_star.points);
    const Projection pu = project(other.p, s_point, m_star.degree, m_star.ring, m_star.points);
    const Index s_name = name(t);
    m_out.records.push_back({ { s_name, name(m_star.ring[m_star.vl]), name(m_star.ring[0]), s.p, other.p },
                              name(u),
                              { s_name, name(pt.a), name(pt.b), name(pu.a), name(pu.b), pt.wa, pt.wb, pu.wa, pu.wb },
                              s.z,
                              other.z,
                              order });
}

/// Replaces the old triangles' contributions to every fan by the new ones'. A normal does not depend
/// on the origin, so the three vertices of a triangle share its contribution.
void TileWorker::update_sums(Index t, int j, const Placement& place)
{
    const int n = m_star.degree;
    const float ux = m_fan.dx[j], uy = m_fan.dy[j], uz = m_fan.dz[j];
    alignas(64) float old_x[kLanes], old_y[kLanes], old_z[kLanes], whole[kLanes];  // the next corner of each triangle
    Normals before, after;
    // Triangles i and i + 1 of the old surface have their apex in t up to vl, in u from there on.
    alignas(64) float apex[kLanes];
    for (int i = 0; i < kLanes; ++i)
        apex[i] = i < m_star.vl ? 0.0f : 1.0f;
    for (int i = 0; i < n; ++i) {
        const int next = i + 1 < n ? i + 1 : 0;
        old_x[i] = m_star.x[next];
        old_y[i] = m_star.y[next];
        old_z[i] = m_star.z[next];
        whole[i] = m_star.real[next] * m_star.real[i];
    }
    for (int i = 0; i < n; ++i) {
        const float mask = whole[i];
        const float ax = apex[i] * ux, ay = apex[i] * uy, az = apex[i] * uz;
        const float ex = m_star.x[i] - ax, ey = m_star.y[i] - ay, ez = m_star.z[i] - az;
        const float fx = old_x[i] - ax, fy = old_y[i] - ay, fz = old_z[i] - az;
        before.x[i] = mask * (ey * fz - ez * fy);
        before.y[i] = mask * (ez * fx - ex * fz);
        before.z[i] = mask * (ex * fy - ey * fx);
        const float gx = m_star.x[i] - place.x, gy = m_star.y[i] - place.y, gz = m_star.z[i] - place.z;
        const float hx = old_x[i] - place.x, hy = old_y[i] - place.y, hz = old_z[i] - place.z;
        after.x[i] = mask * (gy * hz - gz * hy);
        after.y[i] = mask * (gz * hx - gx * hz);
        after.z[i] = mask * (gx * hy - gy * hx);
    }
    for (int i = n; i < kLanes; ++i)
        before.x[i] = before.y[i] = before.z[i] = after.x[i] = after.y[i] = after.z[i] = 0.0f;

    alignas(64) float delta[9][kLanes];
    for (int i = 0; i < n; ++i) {
        delta[0][i] = after.x[i] * after.x[i] - before.x[i] * before.x[i];
        delta[1][i] = after.x[i] * after.y[i] - before.x[i] * before.y[i];
        delta[2][i] = after.y[i] * after.y[i] - before.y[i] * before.y[i];
        delta[3][i] = after.x[i] * after.z[i] - before.x[i] * before.z[i];
        delta[4][i] = after.y[i] * after.z[i] - before.y[i] * before.z[i];
        delta[5][i] = after.z[i] * after.z[i] - before.z[i] * before.z[i];
        delta[6][i] = after.x[i] - before.x[i];
        delta[7][i] = after.y[i] - before.y[i];
        delta[8][i] = after.z[i] - before.z[i];
    }
    const auto add = [](FanSums& sums, const float (*d)[kLanes], int i, int k) {
        sums.xx += d[0][i] + d[0][k];
        sums.xy += d[1][i] + d[1][k];
        sums.yy += d[2][i] + d[2][k];
        sums.xz += d[3][i] + d[3][k];
        sums.yz += d[4][i] + d[4][k];
        sums.zz += d[5][i] + d[5][k];
        sums.x += d[6][i] + d[6][k];
        sums.y += d[7][i] + d[7][k];
        sums.z += d[8][i] + d[8][k];
    };
    for (int i = 0; i < n; ++i)
        if (m_star.ring[i] != kGhost)
            add(m_mesh.nodes[m_star.ring[i]].sums, delta, i, i > 0 ? i - 1 : n - 1);
    // The two triangles that vanish with the edge.
    const auto drop = [&](Index q, int lane) {
        if (q == kGhost)
            return;
        FanSums& sums = m_mesh.nodes[q].sums;
        const float x = m_fan.nx[lane], y = m_fan.ny[lane], z = m_fan.nz[lane];
        sums.xx -= x * x;
        sums.xy -= x * y;
        sums.yy -= y * y;
        sums.xz -= x * z;
        sums.yz -= y * z;
        sums.zz -= z * z;
        sums.x -= x;
        sums.y -= y;
        sums.z -= z;
    };
    drop(m_star.ring[0], j);
    drop(m_star.ring[m_star.vl], j > 0 ? j - 1 : m_fan.degree - 1);
    m_mesh.nodes[t].sums = add_up(n, after);
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

}  // namespace pimg
