// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/ring_edit.h>
#include <pimg/mesh.h>

#include <algorithm>
#include <map>

namespace pimg {
inline namespace PIMG_ABI {

Status Mesh::from_triangles(std::vector<Point> points, const std::vector<Triangle>& triangles, Point extent, Mesh& mesh)
{
    const Index n = Index(points.size());
    // next[v][q] = neighbour that follows q around v: triangle (v, q, next).
    std::vector<std::map<Index, Index>> next(n);
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const Index v = t[std::size_t(k)], a = t[std::size_t((k + 1) % 3)], b = t[std::size_t((k + 2) % 3)];
            if (v >= n || a >= n || v == a)
                return Status::failure("base mesh: a triangle names a vertex that does not exist, or one twice");
            if (!next[v].emplace(a, b).second)
                return Status::failure("base mesh: an edge has more than two triangles");
        }
    Mesh m;
    m.m_points = std::move(points);
    m.m_extent = extent;
    m.m_rings.resize(n);
    m.m_degrees.resize(n);
    for (Index v = 0; v < n; ++v) {
        // An open fan starts at the neighbour nobody leads to; a closed one anywhere.
        std::map<Index, Index> leads_to;
        for (const auto& [a, b] : next[v])
            leads_to[b] = a;
        Index start = kGhost;
        for (const auto& [a, b] : next[v])
            if (leads_to.find(a) == leads_to.end())
                start = a;
        const bool open = start != kGhost;
        if (!open && !next[v].empty())
            start = next[v].begin()->first;
        std::size_t degree = 0;
        for (Index q = start; q != kGhost && degree < kMaxDegree;) {
            m.m_rings[v].v[degree++] = q;
            const auto it = next[v].find(q);
            q = it == next[v].end() || it->second == start ? kGhost : it->second;
        }
        if (degree != next[v].size() + (open ? 1 : 0) || degree < 2 || degree + (open ? 1 : 0) > kMaxDegree)
            return Status::failure("base mesh: the triangles of a vertex do not form one fan");
        if (open)
            m.m_rings[v].v[degree++] = kGhost;
        m.m_degrees[v] = std::uint8_t(degree);
    }
    const Status status = m.validate();
    if (status)
        mesh = std::move(m);
    return status;
}

std::vector<Triangle> Mesh::triangles() const
{
    std::vector<Triangle> result;
    result.reserve(2 * m_points.size());
    for (Index v = 0; v < size(); ++v) {
        const RingView r = ring(v);
        for (int j = 0; j < r.degree; ++j) {
            const Index a = r[j], b = r[j + 1 < r.degree ? j + 1 : 0];
            if (a != kGhost && b != kGhost && v < a && v < b)
                result.push_back({ v, a, b });
        }
    }
    return result;
}

std::size_t Mesh::triangle_count() const
{
    std::size_t corners = 0;
    for (Index v = 0; v < size(); ++v) {
        const RingView r = ring(v);
        corners += std::size_t(r.degree) - (std::find(r.begin(), r.end(), kGhost) != r.end() ? 2 : 0);
    }
    return corners / 3;
}

void Mesh::prefetch(Index v) const
{
    if (v >= size())
        return;
    __builtin_prefetch(&m_rings[v]);
    __builtin_prefetch(&m_points[v]);
    __builtin_prefetch(&m_degrees[v]);
}

void Mesh::prefetch_around(Index v) const
{
    if (v < size())
        for (const Index q : ring(v))
            prefetch(q);
}

bool Mesh::split(Index s, Index vl, Index vr, Point t, Point u)
{
    const int degree = m_degrees[s];
    const int right = find(m_rings[s], degree, vr), left = find(m_rings[s], degree, vl);
    if (right < 0 || left < 0 || right == left)
        return false;
    const Index born = size();
    // t keeps the neighbours from vr to vl, u takes those from vl to vr.
    const auto wrapped = [degree](int place) {
        return place < degree ? place : place - degree;
    };
    const int kept = wrapped(left - right + degree) + 1, moved = wrapped(right - left + degree) + 1;
    const auto degree_of = [&](Index q) {
        return q == kGhost ? 0 : int(m_degrees[q]);
    };
    if (kept + 1 > kMaxDegree || moved + 1 > kMaxDegree || degree_of(vl) + 1 > kMaxDegree
        || degree_of(vr) + 1 > kMaxDegree)
        return false;

    const Ring old = m_rings[s];
    Ring ring_t {}, ring_u {};
    for (int k = 0; k < kept; ++k)
        ring_t.v[std::size_t(k)] = old.v[std::size_t(wrapped(right + k))];
    ring_t.v[std::size_t(kept)] = born;
    for (int k = 0; k < moved; ++k) {
        const Index q = old.v[std::size_t(wrapped(left + k))];
        ring_u.v[std::size_t(k)] = q;
        if (k > 0 && k + 1 < moved && q != kGhost)
            replace(m_rings[q], m_degrees[q], s, born);
    }
    ring_u.v[std::size_t(moved)] = s;
    // Around vl comes (t, then u): triangle (vl, u, t) runs the other way, so u precedes t there; around vr it follows.
    if (vl != kGhost) {
        Ring& r = m_rings[vl];
        const int place = find(r, m_degrees[vl], s);
        m_degrees[vl] = std::uint8_t(insert_after(r, m_degrees[vl], place, s));
        r.v[std::size_t(place)] = born;
    }
    if (vr != kGhost) {
        Ring& r = m_rings[vr];
        m_degrees[vr] = std::uint8_t(insert_after(r, m_degrees[vr], find(r, m_degrees[vr], s), born));
    }
    m_rings[s] = ring_t;
    m_degrees[s] = std::uint8_t(kept + 1);
    m_rings.push_back(ring_u);
    m_degrees.push_back(std::uint8_t(moved + 1));
    m_points[s] = t;
    m_points.push_back(u);
    return true;
}

bool Mesh::collapse(Index s, Point p)
{
    if (size() < 2)
        return false;
    const Index u = size() - 1;
    MergedRing merged;
    if (s == u || !merge_rings({ s, m_rings[s], m_degrees[s] }, { u, m_rings[u], m_degrees[u] }, merged, [&](Index q) {
            return m_degrees[q];
        }))
        return false;
    const int n = merged.degree;
    const Index vr = merged.ring[0], vl = merged.ring[merged.vl];
    for (int k = 0; k < n; ++k) {
        const Index q = merged.ring[k];
        if (q == kGhost)
            continue;
        if (q == vl || q == vr)
            m_degrees[q] = std::uint8_t(remove_at(m_rings[q], m_degrees[q], find(m_rings[q], m_degrees[q], u)));
        else
            replace(m_rings[q], m_degrees[q], u, s);
    }
    std::copy(merged.ring, merged.ring + n, m_rings[s].v.begin());
    m_degrees[s] = std::uint8_t(n);
    m_points[s] = p;
    m_points.pop_back();
    m_rings.pop_back();
    m_degrees.pop_back();
    return true;
}

Status Mesh::validate() const
{
    const auto bad = [](const char* what, Index v) {
        return Status::failure(std::string("mesh: ") + what + " at vertex " + std::to_string(v));
    };
    std::int64_t area = 0;
    int corners = 0;
    for (Index v = 0; v < size(); ++v) {
        const RingView r = ring(v);
        const Point p = point(v);
        const bool on_x = p.x == 0 || p.x == m_extent.x, on_y = p.y == 0 || p.y == m_extent.y;
        if (p.x < 0 || p.y < 0 || p.x > m_extent.x || p.y > m_extent.y)
            return bad("position outside the picture", v);
        if (r.degree < 3 || r.degree > kMaxDegree)
            return bad("ring of fewer than 3 or too many neighbours", v);
        int ghosts = 0;
        for (int j = 0; j < r.degree; ++j) {
            const Index a = r[j], b = r[j + 1 < r.degree ? j + 1 : 0];
            ghosts += a == kGhost;
            if (a != kGhost && (a >= size() || a == v || find(m_rings[a], m_degrees[a], v) < 0))
                return bad("one-sided neighbour", v);
            for (int k = j + 1; k < r.degree; ++k)
                if (r[k] == a)
                    return bad("repeated neighbour", v);
            if (a == kGhost || b == kGhost)
                continue;
            // Triangle (v, a, b) must be seen from a as (a, b, v).
            const int place = find(m_rings[a], m_degrees[a], b);
            if (place < 0 || m_rings[a].v[std::size_t((place + 1) % m_degrees[a])] != v)
                return bad("fan and ring disagree", v);
            const std::int64_t twice = doubled_area(p, point(a), point(b));
            if (twice <= 0)
                return bad("flipped or empty triangle", v);
            area += twice;
        }
        if (ghosts > 1 || (ghosts == 1) != (on_x || on_y))
            return bad("border vertex away from the side, or inner vertex on it", v);
        corners += on_x && on_y;
    }
    if (corners != 4)
        return Status::failure("mesh: the four corners of the picture are not all there");
    if (area != 6 * std::int64_t(m_extent.x) * m_extent.y)
        return Status::failure("mesh: the triangles do not cover the picture exactly once");
    return {};
}

void Mesh::reserve(std::size_t vertices)
{
    m_points.reserve(vertices);
    m_rings.reserve(vertices);
    m_degrees.reserve(vertices);
}

}  // namespace PIMG_ABI
}  // namespace pimg
