// SPDX-License-Identifier: BSD-3-Clause
// Reading and writing are one walk: from an edge to the vertex that makes it a triangle, and on over the two new edges.
#include "sequence/initial_mesh_code.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "mesh_layer/mesh_layer_code.h"
#include <pimg/detail/delaunay.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// The pixels that are vertices, by rows of bits.
class ChosenPixels {
public:
    ChosenPixels(int columns, int rows)
        : width(columns),
          height(rows),
          m_words((std::size_t(columns) + 63) / 64),
          m_bits(m_words * std::size_t(rows), 0)
    {
    }
    void add(int x, int y) { word(x, y) |= std::uint64_t(1) << (x & 63); }
    bool has(int x, int y) const { return x >= 0 && y >= 0 && x < width && (m_bits[at(x, y)] >> (x & 63) & 1) != 0; }
    /// Calls body(x) for the chosen ones of row y from x0 to x1, while it returns true.
    template<class Body>
    void for_each(int y, int x0, int x1, Body&& body) const
    {
        for (int first = x0; first <= x1; first = (first | 63) + 1) {
            std::uint64_t bits = m_bits[at(first, y)] >> (first & 63);
            for (int x = first; bits != 0; bits &= bits - 1) {
                x = first + __builtin_ctzll(bits);
                if (x > x1)
                    return;
                body(x);
            }
        }
    }

    const int width, height;

private:
    std::size_t at(int x, int y) const { return std::size_t(y) * m_words + std::size_t(x) / 64; }
    std::uint64_t& word(int x, int y) { return m_bits[at(x, y)]; }

    std::size_t m_words;
    std::vector<std::uint64_t> m_bits;
};

/// Pixels of a rectangle, both ends included.
struct Box {
    int x0, x1, y0, y1;

    Box clipped(int width, int height) const
    {
        return { std::max(x0, 0), std::min(x1, width - 1), std::max(y0, 0), std::min(y1, height - 1) };
    }
};

/// Holds what lies on the inner side of a -> b in the circle through a, b, c, and a little more.
Box box_of_circle(Point a, Point b, Point c)
{
    const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    const double d = 2.0 * (bx * cy - by * cx), bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    const double x = (cy * bb - by * cc) / d, y = (bx * cc - cx * bb) / d, r = std::sqrt(x * x + y * y);
    double low[2] = { std::min(0.0, bx), std::min(0.0, by) }, high[2] = { std::max(0.0, bx), std::max(0.0, by) };
    for (int k = 0; k < 4; ++k) {
        const double ex = x + (k == 0 ? r : k == 1 ? -r : 0.0), ey = y + (k == 2 ? r : k == 3 ? -r : 0.0);
        if (bx * ey - by * ex < 0.0)
            continue;
        low[0] = std::min(low[0], ex), high[0] = std::max(high[0], ex);
        low[1] = std::min(low[1], ey), high[1] = std::max(high[1], ey);
    }
    constexpr double kFar = 1 << 22;  // beyond any picture; circles through near-by vertices may be of any size
    const double more = 1.0 + 1e-9 * r;
    const auto down = [&](double v) {
        return int(std::floor(std::max(v - more, -kFar)));
    };
    const auto up = [&](double v) {
        return int(std::ceil(std::min(v + more, kFar)));
    };
    return { a.x + down(low[0]), a.x + up(high[0]), a.y + down(low[1]), a.y + up(high[1]) };
}

/// The vertices Delaunay's rule allows for the edge a -> b: those on the circle that is empty on the inner side, in the
/// order in which they follow b.
class Apexes {
public:
    explicit Apexes(const ChosenPixels& chosen) : m_chosen(chosen) { }

    std::vector<Point>& find(Point a, Point b)
    {
        m_found.clear();
        const int width = m_chosen.width, height = m_chosen.height;
        Box box {};
        // First any vertex near the edge. The empty circle lies within its circle, so one search of that finds the
        // rest.
        for (int reach = std::max(2, std::max(std::abs(a.x - b.x), std::abs(a.y - b.y))); m_found.empty(); reach *= 2) {
            box = Box { (a.x + b.x) / 2 - reach, (a.x + b.x) / 2 + reach, (a.y + b.y) / 2 - reach,
                        (a.y + b.y) / 2 + reach };
            const Box part = box.clipped(width, height);
            for (int y = part.y0; y <= part.y1; ++y)
                look(a, b, y, part.x0, part.x1);
            if (part.x0 == 0 && part.y0 == 0 && part.x1 == width - 1 && part.y1 == height - 1)
                break;
        }
        if (m_found.empty())
            return m_found;
        Box now = box_of_circle(a, b, m_found[0]).clipped(width, height);
        const Box seen = box.clipped(width, height);
        if (now.x0 < seen.x0 || now.x1 > seen.x1 || now.y0 < seen.y0 || now.y1 > seen.y1) {
            m_found.resize(1);
            for (int y = now.y0; y <= now.y1; ++y) {
                const Point best = m_found[0];
                look(a, b, y, now.x0, now.x1);
                if (m_found[0] != best) {
                    const Box smaller = box_of_circle(a, b, m_found[0]).clipped(width, height);
                    now = { smaller.x0, smaller.x1, y, smaller.y1 };
                }
            }
        }
        if (m_found.size() > 1)
            std::sort(m_found.begin(), m_found.end(), [&](Point p, Point q) { return doubled_area(b, p, q) > 0; });
        return m_found;
    }

private:
    void look(Point a, Point b, int y, int x0, int x1)
    {
        m_chosen.for_each(y, x0, x1, [&](int x) {
            const Point p { x, y };
            if (doubled_area(a, b, p) <= 0)
                return;
            const int inside = m_found.empty() ? 1 : in_circle(a, b, m_found[0], p);
            if (inside > 0)
                m_found.clear();
            if (inside > 0 || (inside == 0 && p != m_found[0]))
                m_found.push_back(p);
        });
    }

    const ChosenPixels& m_chosen;
    std::vector<Point> m_found;
};

/// What surrounds a vertex while triangles come one by one: neighbour from[k] is followed by to[k].
struct Fan {
    std::uint8_t size = 0;
    Index from[kMaxDegree], to[kMaxDegree];

    bool has(Index neighbour) const { return std::find(from, from + size, neighbour) != from + size; }
    bool add(Index a, Index b)
    {
        if (size >= kMaxDegree || has(a))
            return false;
        from[size] = a;
        to[size++] = b;
        return true;
    }
    /// As one ring, the ghost last; false when it is in pieces.
    bool close(bool on_side, Index* ring, int& degree) const
    {
        if (size == 0 || size + (on_side ? 2 : 0) > kMaxDegree)
            return false;
        int at = 0;
        if (on_side)
            while (at < size && std::find(to, to + size, from[at]) != to + size)
                ++at;
        for (degree = 0; degree < size && at < size; ++degree) {
            ring[degree] = from[at];
            at = int(std::find(from, from + size, to[at]) - from);
        }
        if (on_side && degree == size && at == size) {
            const Index* last = std::find(from, from + size, ring[degree - 1]);
            ring[degree++] = to[last - from];
            ring[degree++] = kGhost;
            return true;
        }
        return !on_side && degree == size && at < size && from[at] == ring[0] && degree >= 3;
    }
};

/// Where a writer looks the right vertex up.
struct Original {
    const Hierarchy& h;
    const Mesh& mesh;
    std::vector<Index> number;  ///< of each pixel's vertex

    Index apex(Index a, Index b) const
    {
        const RingView ring = mesh.ring(number[a]);
        const int at = int(std::find(ring.begin(), ring.end(), number[b]) - ring.begin());
        return h.pixels[ring[(at + 1) % ring.degree]];
    }
};

constexpr int kBusy = 12;  ///< classes of how much the guide changes

int busy_class(std::int64_t difference)
{
    return std::min(kBusy - 1, bit_length(std::uint32_t(std::min<std::int64_t>(difference >> 8, 0xffffffff))));
}

struct Models {
    AdaptiveBit chosen[kBusy][64];
    NumberModel tie[kBusy], choice[8], other;
};

template<class Io>
class Walk {
public:
    Walk(Io io, const std::vector<std::int32_t>& guide, CollapseMesh& mesh, const Original* original)
        : m_io(io),
          m_guide(guide),
          m_mesh(mesh),
          m_original(original),
          m_width(mesh.extent().x / kSubpixels + 1),
          m_height(mesh.extent().y / kSubpixels + 1),
          m_chosen(m_width, m_height),
          m_models(std::make_unique<Models>())
    {
    }
    bool run() { return code_pixels() && code_triangles() && connect(); }

private:
    Index index(Point p) const { return Index(std::size_t(p.y) * std::size_t(m_width) + std::size_t(p.x)); }
    Point point(Index v) const { return { std::int32_t(v % Index(m_width)), std::int32_t(v / Index(m_width)) }; }
    std::int64_t jump(Point a, Point b) const { return std::abs(std::int64_t(m_guide[index(a)]) - m_guide[index(b)]); }
    bool on_one_side(Point a, Point b) const
    {
        return (a.x == b.x && (a.x == 0 || a.x == m_width - 1)) || (a.y == b.y && (a.y == 0 || a.y == m_height - 1));
    }

    bool code_pixels();
    bool code_triangles();
    Index code_apex(Index a, Index b);
    bool connect();

    Io m_io;
    const std::vector<std::int32_t>& m_guide;
    CollapseMesh& m_mesh;
    const Original* m_original;
    const int m_width, m_height;
    ChosenPixels m_chosen;
    Apexes m_apexes { m_chosen };
    std::vector<Index> m_vertices, m_rank;
    std::vector<Fan> m_fans;
    std::unique_ptr<Models> m_models;
};

template<class Io>
bool Walk<Io>::code_pixels()
{
    const int right = m_width - 1, bottom = m_height - 1;
    m_rank.resize(m_guide.size());
    for (int y = 0; y <= bottom; ++y)
        for (int x = 0; x <= right; ++x) {
            const Index v = index({ x, y });
            bool chosen = (x == 0 || x == right) && (y == 0 || y == bottom);
            if (!chosen) {
                const std::int64_t change = jump({ std::max(x - 1, 0), y }, { std::min(x + 1, right), y })
                    + jump({ x, std::max(y - 1, 0) }, { x, std::min(y + 1, bottom) });
                const int near = (m_chosen.has(x - 1, y) ? 1 : 0) + (m_chosen.has(x - 2, y) ? 2 : 0)
                    + (m_chosen.has(x - 1, y - 1) ? 4 : 0) + (m_chosen.has(x, y - 1) ? 8 : 0)
                    + (m_chosen.has(x + 1, y - 1) ? 16 : 0) + (m_chosen.has(x, y - 2) ? 32 : 0);
                chosen = m_io.bit(m_models->chosen[busy_class(change)][near],
                                  Io::kWriting && m_original->number[v] != kGhost);
            }
            if (chosen) {
                m_chosen.add(x, y);
                m_rank[v] = Index(m_vertices.size());
                m_vertices.push_back(v);
            }
        }
    return !m_io.overrun();
}

/// The vertex that makes a -> b a triangle; kGhost when the bytes are damaged.
template<class Io>
Index Walk<Io>::code_apex(Index a, Index b)
{
    const Point pa = point(a), pb = point(b);
    std::vector<Point>& found = m_apexes.find(pa, pb);
    NumberModel* model = &m_models->choice[std::min<std::size_t>(found.size(), 7)];
    if (found.size() == 2) {
        const std::int64_t first = jump(pa, found[0]), second = jump(pb, found[1]);
        model = &m_models->tie[busy_class(std::abs(first - second))];
        if (second < first)
            std::swap(found[0], found[1]);
    }
    const Index right = Io::kWriting ? m_original->apex(a, b) : kGhost;
    std::uint32_t choice = 0;
    if (Io::kWriting)
        choice = std::uint32_t(std::find(found.begin(), found.end(), point(right)) - found.begin());
    choice = m_io.number(*model, choice);
    if (choice < found.size())
        return index(found[choice]);
    if (choice > found.size())
        return kGhost;
    const std::int32_t away =
        signed_number(m_io, m_models->other, Io::kWriting ? std::int32_t(m_rank[right] - m_rank[a]) : 0);
    const std::int64_t rank = std::int64_t(m_rank[a]) + away;
    return rank >= 0 && rank < std::int64_t(m_vertices.size()) ? m_vertices[std::size_t(rank)] : kGhost;
}

template<class Io>
bool Walk<Io>::code_triangles()
{
    m_fans.resize(m_vertices.size());
    std::int64_t left = 2 * std::int64_t(m_width - 1) * (m_height - 1);
    std::vector<std::array<Index, 2>> edges = { { m_vertices[0], m_vertices[1] } };
    while (!edges.empty()) {
        const auto [a, b] = edges.back();
        edges.pop_back();
        if (m_fans[m_rank[a]].has(b))
            continue;
        const Index c = code_apex(a, b);
        if (c == kGhost || m_io.overrun())
            return false;
        const std::int64_t area = doubled_area(point(a), point(b), point(c));
        left -= area;
        if (area <= 0 || left < 0 || !m_fans[m_rank[a]].add(b, c) || !m_fans[m_rank[b]].add(c, a)
            || !m_fans[m_rank[c]].add(a, b))
            return false;
        if (!on_one_side(point(a), point(c)))
            edges.push_back({ a, c });
        if (!on_one_side(point(c), point(b)))
            edges.push_back({ c, b });
    }
    return left == 0;
}

template<class Io>
bool Walk<Io>::connect()
{
    for (std::size_t r = 0; r < m_vertices.size(); ++r) {
        const Index v = m_vertices[r];
        const Point p = point(v);
        const bool side = p.x == 0 || p.y == 0 || p.x == m_width - 1 || p.y == m_height - 1;
        int degree = 0;
        if (!m_fans[r].close(side, m_mesh.rings[v].v.data(), degree))
            return false;
        m_mesh.vertices[v].degree = degree;
    }
    return true;
}

struct Output : LayerOutput {
    bool bit(AdaptiveBit& model, bool value)
    {
        stream.bit(model, value);
        return value;
    }
    bool overrun() const { return false; }
};

struct Input : LayerInput {
    bool bit(AdaptiveBit& model, bool) { return stream.bit(model); }
    bool overrun() const { return stream.overrun(); }
};

}  // namespace

Bytes write_initial_mesh(const Hierarchy& h, const Mesh& finest, const std::vector<std::int32_t>& guide,
                         CollapseMesh& mesh)
{
    Original original { h, finest, std::vector<Index>(h.mesh_pixels(), kGhost) };
    for (Index v = 0; v < h.vertices(); ++v)
        original.number[h.pixels[v]] = v;
    BinaryWriter out;
    Walk<Output>(Output { { out } }, guide, mesh, &original).run();
    return out.finish();
}

bool read_initial_mesh(const std::uint8_t* data, std::size_t size, const std::vector<std::int32_t>& guide,
                       CollapseMesh& mesh)
{
    BinaryReader in(data, size);
    return Walk<Input>(Input { { in } }, guide, mesh, nullptr).run();
}

}  // namespace PIMG_ABI
}  // namespace pimg
