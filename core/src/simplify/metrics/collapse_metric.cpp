// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/projection.h>
#include <pimg/detail/ring_edit.h>

#include "sampling/guide_jump.h"
#include "simplify/metrics/collapse_metric.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Twice a triangle's area over its longest edge squared must stay above this. The second value
/// only serves to finish down to the corners when the first leaves nothing to do.
constexpr double kGuards[2] = { 1e-3, 1e-5 };

}  // namespace

PlainMesh::PlainMesh(const Guide& guide) : width(guide.width), height(guide.height)
{
    const std::size_t n = std::size_t(width) * std::size_t(height);
    points.resize(n);
    rings.resize(n);
    degrees.resize(n);
    for (const GuideChannel& channel : guide.channels) {
        weights.push_back(channel.weight);
        z.emplace_back(channel.samples, channel.samples + n);
    }
    const auto pixel = [&](int x, int y) {
        return Index(y) * Index(width) + Index(x);
    };
    constexpr int kStepX[8] = { 1, 1, 0, -1, -1, -1, 0, 1 };
    constexpr int kStepY[8] = { 0, 1, 1, 1, 0, -1, -1, -1 };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Index v = pixel(x, y);
            points[v] = { x * kSubpixels, y * kSubpixels };
            int degree = 0;
            for (int k = 0; k < 8; ++k) {
                const int qx = x + kStepX[k], qy = y + kStepY[k];
                Index q = kGhost;  // is in the ring once, however many steps lead out of the picture
                if (qx >= 0 && qy >= 0 && qx < width && qy < height) {
                    if (k % 2 == 1
                        && is_falling(guide, pixel(std::min(x, qx), std::min(y, qy))) != (kStepX[k] == kStepY[k]))
                        continue;
                    q = pixel(qx, qy);
                } else if (find(rings[v], degree, kGhost) >= 0) {
                    continue;
                }
                rings[v].v[std::size_t(degree++)] = q;
            }
            degrees[v] = std::uint8_t(degree);
        }
}

namespace {

class Collapser {
public:
    Collapser(PlainMesh& mesh, CollapseMetric& metric, CollapseSequence& sequence, SimplifyStats& stats)
        : m_mesh(mesh),
          m_metric(metric),
          m_sequence(sequence),
          m_stats(stats),
          m_stamps(mesh.points.size(), 0),
          m_orders(mesh.points.size(), 0.0f)
    {
    }

    /// One pass with one guard; false when progress asked to stop.
    bool run(double guard, const Progress& progress);

private:
    struct Plan {
        double cost = kInfinity;
        Index u = kGhost;
        Point p;
    };
    /// Keyed by vertex; ties in the order they came up, so that flat places coarsen evenly.
    struct Entry {
        double cost;
        std::uint64_t serial;
        Index v, stamp;
        bool operator<(const Entry& o) const { return cost != o.cost ? cost > o.cost : serial > o.serial; }
    };

    Plan plan(Index v);
    void consider(Index t, Index u, Plan& best);
    void enqueue(Index v, const Plan& plan);
    bool find_star(Index t, Index u, MergedRing& star) const;
    bool is_on_sides(Index v, Point p) const;
    bool keeps_shape(const MergedRing& star, Point p) const;
    void collapse(Index t, const Plan& plan);
    void record(Index t, Index u, Point p, const MergedRing& star, float order);
    void update_rings(Index t, Index u, const MergedRing& star);

    PlainMesh& m_mesh;
    CollapseMetric& m_metric;
    CollapseSequence& m_sequence;
    SimplifyStats& m_stats;
    std::vector<Index> m_stamps;
    std::vector<float> m_orders;
    std::priority_queue<Entry> m_queue;
    std::uint64_t m_serial = 0;
    double m_guard = 0.0;
};

bool Collapser::run(double guard, const Progress& progress)
{
    m_guard = guard;
    const Index vertices = Index(m_mesh.points.size());
    for (Index v = 0; v < vertices; ++v)
        if (m_mesh.degrees[v] > 0)
            enqueue(v, plan(v));
    while (!m_queue.empty()) {
        const Entry next = m_queue.top();
        m_queue.pop();
        if (m_stamps[next.v] != next.stamp || m_mesh.degrees[next.v] == 0)
            continue;
        // Collapses since then had v planned anew only if they were in its ring, but its costs depend on the ring
        // beyond.
        const Plan now = plan(next.v);
        if (now.cost > next.cost) {
            enqueue(next.v, now);
            continue;
        }
        collapse(next.v, now);
        if (progress && ++m_stats.collapses % 4096 == 0 && !progress(float(m_stats.collapses) / float(vertices)))
            return false;
    }
    return true;
}

void Collapser::enqueue(Index v, const Plan& plan)
{
    ++m_stamps[v];
    if (plan.cost < kInfinity)
        m_queue.push({ plan.cost, m_serial++, v, m_stamps[v] });
}

/// The cheapest legal collapse of v with a neighbour.
Collapser::Plan Collapser::plan(Index v)
{
    Plan best;
    ++m_stats.evaluations;
    for (int j = 0; j < m_mesh.degrees[v]; ++j) {
        const Index u = m_mesh.rings[v].v[std::size_t(j)];
        if (u != kGhost && (u > v || !m_metric.is_symmetric()))
            consider(v, u, best);
    }
    return best;
}

void Collapser::consider(Index t, Index u, Plan& best)
{
    MergedRing star;
    if (!find_star(t, u, star))
        return;
    Point positions[CollapseMetric::kMaxCandidates];
    const int count = m_metric.candidates(t, u, positions);
    for (int i = 0; i < count; ++i) {
        if (!is_on_sides(t, positions[i]) || !is_on_sides(u, positions[i]) || !keeps_shape(star, positions[i]))
            continue;
        const double cost = m_metric.cost(t, u, positions[i]);
        if (cost < best.cost)
            best = { cost, u, positions[i] };
        return;
    }
    ++m_stats.refused;
}

bool Collapser::find_star(Index t, Index u, MergedRing& star) const
{
    return merge_rings({ t, m_mesh.rings[t], m_mesh.degrees[t] }, { u, m_mesh.rings[u], m_mesh.degrees[u] }, star,
                       [&](Index q) { return m_mesh.degrees[q]; });
}

/// Whether v may move to p: never off a side of the picture.
bool Collapser::is_on_sides(Index v, Point p) const
{
    const Point from = m_mesh.points[v];
    return (from.x == p.x || !m_mesh.on_vertical_side(v)) && (from.y == p.y || !m_mesh.on_horizontal_side(v));
}

bool Collapser::keeps_shape(const MergedRing& star, Point p) const
{
    for (int i = 0; i < star.degree; ++i) {
        const Index a = star.ring[i], b = star.ring[i + 1 < star.degree ? i + 1 : 0];
        if (a == kGhost || b == kGhost)
            continue;
        const auto squared = [](Point q, Point r) {
            const double dx = double(q.x) - double(r.x), dy = double(q.y) - double(r.y);
            return dx * dx + dy * dy;
        };
        const Point pa = m_mesh.points[a], pb = m_mesh.points[b];
        const double longest = std::max({ squared(p, pa), squared(p, pb), squared(pa, pb) });
        if (double(doubled_area(p, pa, pb)) < std::max(m_guard * longest, 1.0))
            return false;
    }
    return true;
}

void Collapser::collapse(Index t, const Plan& plan)
{
    Index u = plan.u;
    if (plan.p == m_mesh.points[u])
        std::swap(t, u);  // the one that stays where it is keeps its number
    MergedRing star;
    find_star(t, u, star);
    float order =
        std::max({ float(std::min(plan.cost, double(std::numeric_limits<float>::max()))), m_orders[t], m_orders[u] });
    for (int i = 0; i < star.degree; ++i)
        if (star.ring[i] != kGhost)
            order = std::max(order, m_orders[star.ring[i]]);
    record(t, u, plan.p, star, order);
    m_metric.merge(t, u, plan.p);
    m_mesh.points[t] = plan.p;
    m_orders[t] = order;
    update_rings(t, u, star);
    enqueue(t, this->plan(t));
    for (int i = 0; i < star.degree; ++i)
        if (star.ring[i] != kGhost)
            enqueue(star.ring[i], this->plan(star.ring[i]));
}

void Collapser::record(Index t, Index u, Point p, const MergedRing& star, float order)
{
    Point around[kMaxDegree];
    for (int i = 0; i < star.degree; ++i)
        around[i] = star.ring[i] == kGhost ? Point {} : m_mesh.points[star.ring[i]];
    const Point pt = m_mesh.points[t], pu = m_mesh.points[u];
    const Projection a = project(pt, p, star.degree, star.ring, around);
    const Projection b = project(pu, p, star.degree, star.ring, around);
    m_sequence.records.push_back({ { t, star.ring[star.vl], star.ring[0], pt, pu },
                                   u,
                                   { t, a.a, a.b, b.a, b.b, a.wa, a.wb, b.wa, b.wb },
                                   m_mesh.z[0][t],
                                   m_mesh.z[0][u],
                                   order });
    for (std::size_t c = 1; c < m_mesh.z.size(); ++c)
        m_sequence.more.push_back({ m_mesh.z[c][t], m_mesh.z[c][u] });
}

void Collapser::update_rings(Index t, Index u, const MergedRing& star)
{
    for (int i = 0; i < star.degree; ++i) {
        const Index q = star.ring[i];
        if (q == kGhost || (i > 0 && i < star.vl))
            continue;
        Ring& ring = m_mesh.rings[q];
        if (i > star.vl)
            replace(ring, m_mesh.degrees[q], u, t);
        else
            m_mesh.degrees[q] = std::uint8_t(remove_at(ring, m_mesh.degrees[q], find(ring, m_mesh.degrees[q], u)));
    }
    std::copy(star.ring, star.ring + star.degree, m_mesh.rings[t].v.begin());
    m_mesh.degrees[t] = std::uint8_t(star.degree);
    m_mesh.degrees[u] = 0;
}

}  // namespace

bool collapse_all(PlainMesh& mesh, CollapseMetric& metric, const Progress& progress, CollapseSequence& sequence,
                  SimplifyStats& stats)
{
    sequence = {};
    sequence.channels = int(mesh.z.size());
    Collapser collapser(mesh, metric, sequence, stats);
    for (double guard : kGuards)
        if (!collapser.run(guard, progress))
            return false;
    stats.collapses = sequence.records.size();
    for (Index v = 0; v < Index(mesh.points.size()); ++v) {
        if (mesh.degrees[v] == 0)
            continue;
        BaseVertex b { v, mesh.points[v], {}, mesh.rings[v], mesh.degrees[v] };
        for (const std::vector<float>& z : mesh.z)
            b.z.push_back(z[v]);
        sequence.base.push_back(b);
    }
    return true;
}

}  // namespace PIMG_ABI
}  // namespace pimg
