// SPDX-License-Identifier: BSD-3-Clause
// Delaunay triangulation by a sweep over the rows of pixels. The swept part is bounded below by a front, a chain
// of edges with one vertex per column at most; a pixel joins the front by one or two triangles, sharp
// notches are filled (Zalik 2005), and edges are flipped until every circle is empty. On integers all tests are exact.
// Neighbours in a row and in the row above are neighbours in memory: several times faster than a
// Voronoi diagram of general points.
#include <pimg/detail/delaunay.h>

#include <algorithm>
#include <cstdlib>

#include "sampling/guide_jump.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr Index kNone = kGhost;

/// Exact in 64 bits while coordinates relative to d stay below 2^14.
template<class Int>
int in_circle_sign(Int ax, Int ay, Int bx, Int by, Int cx, Int cy)
{
    const Int a = ax * ax + ay * ay, b = bx * bx + by * by, c = cx * cx + cy * cy;
    const Int det = a * (bx * cy - cx * by) + b * (cx * ay - ax * cy) + c * (ax * by - bx * ay);
    return int(det > 0) - int(det < 0);
}

class Sweep {
public:
    Sweep(InitialMesh& mesh, const Guide& guide);
    void run();

private:
    /// A column of the front: its vertex, the columns beside it, and the half-edge (from right to left) of the front
    /// to the right neighbour.
    struct Column {
        Index vertex = kNone, edge = kNone;
        int left = -1, right = -1;
    };

    void start_front(Index count);
    void insert(Index v, int& near);
    void fill_notches(int column);
    bool fill(int column, bool always);
    void attach(Index e, Index twin);
    Index add_triangle(Index a, Index b, Index c, Index ab, Index bc, Index ca);
    void join(int left, int right, Index edge);

    int direction(Index e) const;
    void flip_inside(Index e);
    void legalise(bool near);
    void flip_remaining();

    InitialMesh& m_mesh;
    const Guide& m_guide;
    std::vector<Point> m_points;  // in pixels
    std::vector<Column> m_front;
    Index m_size = 0;  // half-edges so far
    std::vector<Index> m_suspects;
};

Sweep::Sweep(InitialMesh& mesh, const Guide& guide) : m_mesh(mesh), m_guide(guide), m_front(std::size_t(mesh.width))
{
    m_points.reserve(mesh.pixels.size());
    for (Index v = 0; v < mesh.vertices(); ++v)
        m_points.push_back(mesh.pixel(v));
    mesh.corners.resize(6 * mesh.pixels.size());
    mesh.twins.resize(6 * mesh.pixels.size());
}

void Sweep::run()
{
    const Index n = m_mesh.vertices();
    Index v = 0;
    while (v < n && m_points[v].y == 0)
        ++v;
    start_front(v);
    for (int row = 0, near = 0; v < n; ++v) {
        if (m_points[v].y != row) {
            row = m_points[v].y;
            near = 0;
        }
        insert(v, near);
    }
    // What is left between the front and the straight bottom.
    for (int c = m_front[0].right; m_front[std::size_t(c)].right >= 0;) {
        const int left = m_front[std::size_t(c)].left;
        if (fill(c, true))
            c = m_front[std::size_t(left)].left >= 0 ? left : m_front[std::size_t(left)].right;
        else
            c = m_front[std::size_t(c)].right;
    }
    m_mesh.corners.resize(m_size);
    m_mesh.twins.resize(m_size);
    flip_remaining();
}

void Sweep::start_front(Index count)
{
    for (Index v = 0; v < count; ++v) {
        m_front[std::size_t(m_points[v].x)].vertex = v;
        if (v > 0)
            join(m_points[v - 1].x, m_points[v].x, kNone);
    }
}

/// Makes two columns neighbours along the front.
void Sweep::join(int left, int right, Index edge)
{
    m_front[std::size_t(left)].right = right;
    m_front[std::size_t(left)].edge = edge;
    m_front[std::size_t(right)].left = left;
}

/// Flips an edge. The flip moves outer edges to other half-edges; where such an edge belongs to the front, the column
/// at its left end is told.
void Sweep::flip_inside(Index e)
{
    const Index twin = m_mesh.twins[e];
    flip(m_mesh, e);
    for (Index outer : { e, twin })
        if (m_mesh.twins[outer] == kNone) {
            const Index left = m_mesh.corners[next_edge(outer)], right = m_mesh.corners[outer];
            Column& column = m_front[std::size_t(m_points[left].x)];
            if (column.vertex == left && column.right == m_points[right].x)
                column.edge = outer;
        }
}

Index Sweep::add_triangle(Index a, Index b, Index c, Index ab, Index bc, Index ca)
{
    const Index e = m_size;
    m_size += 3;
    m_mesh.corners[e] = a;
    m_mesh.corners[e + 1] = b;
    m_mesh.corners[e + 2] = c;
    attach(e, ab);
    attach(e + 1, bc);
    attach(e + 2, ca);
    return e;
}

void Sweep::attach(Index e, Index twin)
{
    m_mesh.twins[e] = twin;
    if (twin != kNone) {
        m_mesh.twins[twin] = e;
        m_suspects.push_back(e);
    }
}

/// Adds v below the front. `near` is a column of the front that is not right of v: the search starts there, and ends at
/// the nearest such column.
void Sweep::insert(Index v, int& near)
{
    const int x = m_points[v].x;
    while (m_front[std::size_t(near)].right >= 0 && m_front[std::size_t(near)].right <= x)
        near = m_front[std::size_t(near)].right;
    const Column at = m_front[std::size_t(near)];
    if (near < x) {
        const Index e = add_triangle(at.vertex, m_front[std::size_t(at.right)].vertex, v, at.edge, kNone, kNone);
        m_front[std::size_t(x)].vertex = v;
        join(near, x, e + 2);
        join(x, at.right, e + 1);
    } else {
        // Straight below a vertex of the front, which v replaces.
        m_front[std::size_t(x)].vertex = v;
        Index below = kNone;
        if (at.left >= 0) {
            const Column left = m_front[std::size_t(at.left)];
            const Index e = add_triangle(left.vertex, at.vertex, v, left.edge, kNone, kNone);
            below = e + 1;
            join(at.left, x, e + 2);
        }
        if (at.right >= 0) {
            const Index e = add_triangle(at.vertex, m_front[std::size_t(at.right)].vertex, v, at.edge, kNone, below);
            join(x, at.right, e + 1);
        }
    }
    near = x;
    legalise(false);
    fill_notches(x);
}

/// Fills acute notches beside a new vertex.
void Sweep::fill_notches(int column)
{
    while (m_front[std::size_t(column)].left >= 0 && fill(m_front[std::size_t(column)].left, false))
        continue;
    while (m_front[std::size_t(column)].right >= 0 && fill(m_front[std::size_t(column)].right, false))
        continue;
}

/// Covers the vertex of a column with a triangle if the front has a notch there; unless `always`, only if the notch is
/// narrower than a right angle.
bool Sweep::fill(int column, bool always)
{
    const Column at = m_front[std::size_t(column)];
    if (at.left < 0 || at.right < 0)
        return false;
    const Column left = m_front[std::size_t(at.left)], right = m_front[std::size_t(at.right)];
    const Point a = m_points[left.vertex], b = m_points[at.vertex], c = m_points[right.vertex];
    if (doubled_area(a, b, c) <= 0)
        return false;
    const std::int64_t dot = std::int64_t(a.x - b.x) * (c.x - b.x) + std::int64_t(a.y - b.y) * (c.y - b.y);
    if (!always && dot <= 0)
        return false;
    m_front[std::size_t(column)].vertex = kNone;
    const Index e = add_triangle(left.vertex, at.vertex, right.vertex, left.edge, at.edge, kNone);
    join(at.left, at.right, e + 2);
    legalise(false);
    return true;
}

/// Above 0 if the edge e must be flipped, 0 if it may be, below 0 if it must not.
int Sweep::direction(Index e) const
{
    const Index twin = m_mesh.twins[e];
    const auto at = [&](Index h) {
        return m_points[m_mesh.corners[h]];
    };
    return in_circle(at(e), at(next_edge(e)), at(previous_edge(e)), at(previous_edge(twin)));
}

/// Flips edges until those in doubt have empty circles. A flip puts the four edges around it in doubt; two of them only
/// if `near`. While the sweep goes on, these two are left to flip_remaining(), since they hardly ever have to be
/// flipped.
void Sweep::legalise(bool near)
{
    while (!m_suspects.empty()) {
        const Index e = m_suspects.back();
        m_suspects.pop_back();
        const Index twin = m_mesh.twins[e];
        if (twin == kNone || direction(e) <= 0)
            continue;
        flip_inside(e);
        m_suspects.push_back(e);
        m_suspects.push_back(next_edge(twin));
        if (near) {
            m_suspects.push_back(next_edge(e));
            m_suspects.push_back(twin);
        }
    }
}

/// Checks every edge, so that all circles are empty; then takes the diagonal of the smaller jump where four pixels lie
/// on one.
void Sweep::flip_remaining()
{
    std::vector<Index> ties;
    for (Index e = 0; e < m_size; ++e) {
        const Index twin = m_mesh.twins[e];
        if (twin == kNone || twin < e)
            continue;
        const int sign = direction(e);
        if (sign == 0)
            ties.push_back(e);
        if (sign > 0) {
            m_suspects.push_back(e);
            legalise(true);
        }
    }
    const auto jump = [&](Index from, Index to) {
        const Index p = m_mesh.pixels[m_mesh.corners[from]], q = m_mesh.pixels[m_mesh.corners[to]];
        return squared_jump(m_guide, p, q);
    };
    for (Index e : ties) {
        const Index twin = m_mesh.twins[e];
        if (direction(e) == 0 && jump(e, twin) > jump(previous_edge(e), previous_edge(twin)))
            flip(m_mesh, e);
    }
}

/// Moves edges from vertices with too many neighbours to vertices with few.
class DegreeLimiter {
public:
    explicit DegreeLimiter(InitialMesh& mesh);
    std::vector<Index> run();

private:
    bool relieve(Index edge);
    bool is_flip_ok(Index e) const;

    InitialMesh& m_mesh;
    std::vector<Index> m_degrees;  // ghost counted
    std::vector<Index> m_fan;
};

DegreeLimiter::DegreeLimiter(InitialMesh& mesh) : m_mesh(mesh), m_degrees(mesh.pixels.size(), 0)
{
    for (std::size_t e = 0; e < mesh.corners.size(); ++e)
        m_degrees[mesh.corners[e]] +=
            mesh.twins[e] == kNone ? 3 : 1;  // on the border: one more neighbour, and the ghost
}

std::vector<Index> DegreeLimiter::run()
{
    const auto crowded = [](Index degree) {
        return degree > Index(kMaxDegree);
    };
    std::vector<Index> stuck;
    if (std::none_of(m_degrees.begin(), m_degrees.end(), crowded))
        return stuck;
    for (bool again = true; again;) {
        again = false;
        stuck.clear();
        for (Index e = 0; e < Index(m_mesh.corners.size()); ++e)
            while (crowded(m_degrees[m_mesh.corners[e]])) {
                if (!relieve(e)) {
                    stuck.push_back(m_mesh.corners[e]);
                    break;
                }
                again = true;
            }
    }
    return stuck;
}

/// Flips one edge of the vertex e starts at: that whose new ends have fewest neighbours. Their number stays below what
/// the vertex had, so that the sum of squares falls and all this ends.
bool DegreeLimiter::relieve(Index e)
{
    m_fan.clear();
    Index edge = e;
    do {
        m_fan.push_back(edge);
        edge = m_mesh.twins[previous_edge(edge)];
    } while (edge != e && edge != kNone);
    if (edge == kNone)
        for (edge = m_mesh.twins[e]; edge != kNone; edge = m_mesh.twins[m_fan.back()])
            m_fan.push_back(next_edge(edge));
    Index best = kNone, best_degree = m_degrees[m_mesh.corners[e]] - 1;
    for (Index candidate : m_fan) {
        if (m_mesh.twins[candidate] == kNone || !is_flip_ok(candidate))
            continue;
        const Index c = m_mesh.corners[previous_edge(candidate)];
        const Index d = m_mesh.corners[previous_edge(m_mesh.twins[candidate])];
        const Index degree = std::max(m_degrees[c], m_degrees[d]);
        if (degree < best_degree) {
            best_degree = degree;
            best = candidate;
        }
    }
    if (best == kNone)
        return false;
    --m_degrees[m_mesh.corners[best]];
    --m_degrees[m_mesh.corners[next_edge(best)]];
    ++m_degrees[m_mesh.corners[previous_edge(best)]];
    ++m_degrees[m_mesh.corners[previous_edge(m_mesh.twins[best])]];
    flip(m_mesh, best);
    return true;
}

bool DegreeLimiter::is_flip_ok(Index e) const
{
    const Index twin = m_mesh.twins[e];
    const auto at = [&](Index h) {
        return m_mesh.pixel(m_mesh.corners[h]);
    };
    const Point a = at(e), b = at(twin), c = at(previous_edge(e)), d = at(previous_edge(twin));
    return doubled_area(d, b, c) > 0 && doubled_area(c, a, d) > 0;
}

}  // namespace

void flip(InitialMesh& mesh, Index e)
{
    const auto link = [&](Index h, Index twin) {
        mesh.twins[h] = twin;
        if (twin != kNone)
            mesh.twins[twin] = h;
    };
    const Index twin = mesh.twins[e], ca = previous_edge(e), db = previous_edge(twin);
    mesh.corners[e] = mesh.corners[db];
    mesh.corners[twin] = mesh.corners[ca];
    const Index outer_ca = mesh.twins[ca], outer_db = mesh.twins[db];
    link(e, outer_db);
    link(twin, outer_ca);
    link(ca, db);
}

int in_circle(Point a, Point b, Point c, Point d)
{
    const std::int32_t x[3] = { a.x - d.x, b.x - d.x, c.x - d.x }, y[3] = { a.y - d.y, b.y - d.y, c.y - d.y };
    constexpr std::int32_t kSmall = 1 << 14;  // the determinant stays below 2^60
    std::uint32_t largest = 0;
    for (int k = 0; k < 3; ++k)
        largest |= std::uint32_t(std::abs(x[k])) | std::uint32_t(std::abs(y[k]));
    if (largest < kSmall)
        return in_circle_sign<std::int64_t>(x[0], y[0], x[1], y[1], x[2], y[2]);
    __extension__ using Wide = __int128;
    return in_circle_sign<Wide>(x[0], y[0], x[1], y[1], x[2], y[2]);
}

std::vector<Index> limit_degrees(InitialMesh& mesh)
{
    return DegreeLimiter(mesh).run();
}

void triangulate_delaunay(InitialMesh& mesh, const Guide& guide)
{
    Sweep(mesh, guide).run();
}

}  // namespace PIMG_ABI
}  // namespace pimg
