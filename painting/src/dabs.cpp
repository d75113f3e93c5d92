// SPDX-License-Identifier: BSD-3-Clause
// Measures dual pieces while the splits are replayed.
#include <algorithm>
#include <cmath>

#include <pimg/detail/elementary.h>
#include <pimg/detail/stop.h>
#include <pimg/strokes.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr float kPixel = 1.0f / float(kSubpixels);

/// Area of a dab over that of its piece: strokes are no polygons and must overlap to leave no gaps. Chosen by eye.
/// More gives wider strokes, fewer gaps to be filled from below, and more paint over the neighbours.
constexpr float kOverlap = 1.35f;

/// A piece whose area is below this share of the least width's square is certainly too small. A dab is at most as wide
/// as the square root of its area, so 1 would do; the rest is a margin.
constexpr float kSmallestArea = 0.7f;

struct Polygon {
    Vec2 points[kMaxDegree + 3];
    int size = 0;

    void add(float x, float y) { points[size++] = { x * kPixel, y * kPixel }; }
};

Polygon polygon_of(const Mesh& mesh, Index v)
{
    Polygon polygon;
    const RingView ring = mesh.ring(v);
    const Point p = mesh.point(v);
    const auto middle = [&](Index q) {
        const Point b = mesh.point(q);
        polygon.add(0.5f * float(p.x + b.x), 0.5f * float(p.y + b.y));
    };
    for (int j = 0; j < ring.degree; ++j) {
        const Index a = ring[j], b = ring[j + 1 < ring.degree ? j + 1 : 0];
        if (b == kGhost) {
            middle(a);
            polygon.add(float(p.x), float(p.y));
        } else if (a == kGhost) {
            middle(b);
        } else {
            const Point pa = mesh.point(a), pb = mesh.point(b);
            polygon.add(float(p.x + pa.x + pb.x) / 3.0f, float(p.y + pa.y + pb.y) / 3.0f);
        }
    }
    return polygon;
}

/// Area and centre of gravity. A piece of a concave star may fold over at one corner; the sums are still good enough.
float area_and_centre(const Polygon& polygon, Vec2& centre)
{
    const Vec2 o = polygon.points[0];
    float twice = 0.0f, sx = 0.0f, sy = 0.0f;
    for (int i = 1; i + 1 < polygon.size; ++i) {
        const Vec2 a { polygon.points[i].x - o.x, polygon.points[i].y - o.y };
        const Vec2 b { polygon.points[i + 1].x - o.x, polygon.points[i + 1].y - o.y };
        const float cross = a.x * b.y - a.y * b.x;
        twice += cross;
        sx += cross * (a.x + b.x);
        sy += cross * (a.y + b.y);
    }
    centre = twice > 0.0f ? Vec2 { o.x + sx / (3.0f * twice), o.y + sy / (3.0f * twice) } : o;
    return std::max(0.5f * twice, 0.0f);
}

class Collector {
public:
    Collector(const DirectionField& field, const DabOptions& options, std::vector<Dab>& dabs)
        : m_field(field),
          m_options(options),
          m_dabs(dabs),
          m_smallest(kSmallestArea * options.min * options.min * (options.detail ? 1.0f / 16 : 1.0f) / kOverlap)
    {
    }

    /// Measures the piece of a base vertex.
    void base(const Mesh& mesh, Index v)
    {
        m_area.push_back(0.0f);
        m_waiting.push_back(1);
        measure(mesh, v, 0);
    }

    /// Measures the pieces of the two vertices of a split. Pieces only shrink, so nothing is done if the piece that is
    /// split was too small for any brush.
    void split(const Mesh& mesh, Index s, Index u, Level level)
    {
        m_area.push_back(m_area[s]);
        m_waiting.push_back(0);
        if (m_area[s] < m_smallest)
            return;
        m_waiting[s] = m_waiting[u] = 1;
        measure(mesh, s, level);
        measure(mesh, u, level);
        for (Index end : { s, u })
            for (Index q : mesh.ring(end))
                if (q != kGhost && q != s && q != u && m_waiting[q])
                    measure(mesh, q, level);
    }

private:
    void measure(const Mesh& mesh, Index v, Level level);

    const DirectionField& m_field;
    const DabOptions& m_options;
    std::vector<Dab>& m_dabs;
    float m_smallest;             ///< area whose parts are certainly below the range
    std::vector<float> m_area;    ///< area of each vertex's piece when it was last measured
    std::vector<char> m_waiting;  ///< whether the piece was still larger than the range
};

void Collector::measure(const Mesh& mesh, Index v, Level level)
{
    const Polygon polygon = polygon_of(mesh, v);
    Dab dab { {}, 0.0f, 0.0f, v, level };
    const float area = area_and_centre(polygon, dab.centre);
    m_area[v] = area;
    if (area < m_smallest) {
        m_waiting[v] = 0;
        return;
    }
    const float scale = m_options.scale(dab.centre, m_field.width(), m_field.height());
    const float min = m_options.min * scale, max = m_options.max * scale;
    const Vec2 along = m_field.at(dab.centre);
    float low = 0.0f, high = 0.0f;
    for (int i = 0; i < polygon.size; ++i) {
        const float s = (polygon.points[i].x - dab.centre.x) * along.x + (polygon.points[i].y - dab.centre.y) * along.y;
        low = std::min(low, s);
        high = std::max(high, s);
    }
    dab.length = std::max(high - low, 1e-3f);
    dab.width = std::min(kOverlap * area / dab.length, std::sqrt(kOverlap * area));
    if (dab.width > max)
        return;
    m_waiting[v] = 0;
    if (dab.width >= min)
        m_dabs.push_back(dab);
}

}  // namespace

float DabOptions::scale(Vec2 p, int width, int height) const
{
    if (!detail)
        return 1.0f;
    const int x = std::clamp(int(p.x + 0.5f), 0, width - 1), y = std::clamp(int(p.y + 0.5f), 0, height - 1);
    const float m = detail[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    return m >= 0.0f && m <= 1.0f ? float(elementary::exp2(double(2.0f - 4.0f * m))) : m > 1.0f ? 0.25f : 4.0f;
}

std::vector<Vec2> piece_polygon(const Mesh& mesh, Index vertex)
{
    const Polygon polygon = polygon_of(mesh, vertex);
    return { polygon.points, polygon.points + polygon.size };
}

Status collect_dabs(const Hierarchy& h, const DirectionField& field, const DabOptions& options, std::vector<Dab>& dabs)
{
    dabs.clear();
    Mesh mesh;
    const Status status = Mesh::from_triangles(h.base_points, h.base_triangles, h.extent(), mesh);
    if (!status)
        return status;
    mesh.reserve(h.vertices());
    constexpr Level kReplayedBetweenStops = 4096;  // splits; replayed and measured at a microsecond each
    Collector collector(field, options, dabs);
    for (Index v = 0; v < mesh.size(); ++v)
        collector.base(mesh, v);
    for (Level i = 0; i < std::min(options.last, h.levels()); ++i) {
        const Split& s = h.splits[i];
        const Index u = mesh.size();
        if (i % kReplayedBetweenStops == 0)
            stop_point();
        if (s.s >= u || !mesh.split(s.s, s.vl, s.vr, s.t, s.u))
            return Status::failure("hierarchy: split " + std::to_string(i) + " does not fit the mesh");
        collector.split(mesh, s.s, u, i + 1);
    }
    return {};
}

}  // namespace PIMG_ABI
}  // namespace pimg
