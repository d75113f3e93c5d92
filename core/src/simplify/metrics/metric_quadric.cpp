// SPDX-License-Identifier: BSD-3-Clause
// Garland & Heckbert, Surface Simplification Using Quadric Error Metrics (1997), on a height field: each vertex
// keeps the sum of squared distances to the planes of its first triangles, weighted by area, and a merged one
// the sum of both. Each channel has a sum and a z of its own, all share (x, y).
#include <algorithm>
#include <cmath>

#include "simplify/metrics/collapse_metric.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Pixels that one unit of intensity counts for in the distance to a plane. Small, so that distance is nearly vertical:
/// +1 to +4 dB at a tenth of the vertices over 1.
constexpr double kIntensityScale = 0.02;

/// As for volume optimisation: pulls towards the edge's midpoint, and makes short edges cheaper among equals.
constexpr double kPull = 1e-4, kPullArea = 1e-6, kLength = 1e-5;

/// Sum of w (z - a x - b y - c)^2, as a quadratic form in (x, y, 1) and z. Pixels and guide units.
struct Quadric {
    double xx = 0, xy = 0, yy = 0, x = 0, y = 0, one = 0;  ///< terms without z
    double xz = 0, yz = 0, z = 0, zz = 0;                  ///< terms with z

    void add_plane(double a, double b, double c, double w)
    {
        xx += w * a * a;
        xy += w * a * b;
        yy += w * b * b;
        x += w * a * c;
        y += w * b * c;
        one += w * c * c;
        xz -= w * a;
        yz -= w * b;
        z -= w * c;
        zz += w;
    }
    void add(const Quadric& o)
    {
        xx += o.xx;
        xy += o.xy;
        yy += o.yy;
        x += o.x;
        y += o.y;
        one += o.one;
        xz += o.xz;
        yz += o.yz;
        z += o.z;
        zz += o.zz;
    }
    double best_z(double px, double py) const { return -(xz * px + yz * py + z) / zz; }
    /// With the best z.
    double at(double px, double py) const
    {
        const double k = xz * px + yz * py + z;
        const double plain = xx * px * px + yy * py * py + one + 2 * (xy * px * py + x * px + y * py);
        return std::max(plain - k * k / zz, 0.0);
    }
};

/// H p = r is where the sum of the channels' forms, each with its best z, is least.
struct System {
    double xx = 0, xy = 0, yy = 0, rx = 0, ry = 0, area = 0;

    void add(const Quadric& q, double weight)
    {
        xx += weight * (q.xx - q.xz * q.xz / q.zz);
        xy += weight * (q.xy - q.xz * q.yz / q.zz);
        yy += weight * (q.yy - q.yz * q.yz / q.zz);
        rx -= weight * (q.x - q.xz * q.z / q.zz);
        ry -= weight * (q.y - q.yz * q.z / q.zz);
        area += weight * q.zz;
    }
};

class QuadricMetric : public CollapseMetric {
public:
    explicit QuadricMetric(PlainMesh& mesh);

    bool is_symmetric() const override { return true; }
    int candidates(Index t, Index u, Point* positions) const override;
    double cost(Index t, Index u, Point p) override;
    void merge(Index t, Index u, Point p) override;

private:
    Quadric sum(Index t, Index u, std::size_t channel) const
    {
        Quadric q = m_quadrics[t * m_channels + channel];
        q.add(m_quadrics[u * m_channels + channel]);
        return q;
    }
    void add_triangle(Index v, Index a, Index b);

    PlainMesh& m_mesh;
    std::size_t m_channels;
    std::vector<Quadric> m_quadrics;  ///< of every vertex, channel by channel; origin at the picture's
};

constexpr double kPixel = 1.0 / double(kSubpixels);

QuadricMetric::QuadricMetric(PlainMesh& mesh)
    : m_mesh(mesh),
      m_channels(mesh.z.size()),
      m_quadrics(mesh.points.size() * m_channels)
{
    for (Index v = 0; v < Index(mesh.points.size()); ++v)
        for (int j = 0; j < mesh.degrees[v]; ++j) {
            const Index a = mesh.rings[v].v[std::size_t(j)];
            const Index b = mesh.rings[v].v[std::size_t((j + 1) % mesh.degrees[v])];
            if (a != kGhost && b != kGhost)
                add_triangle(v, a, b);
        }
}

void QuadricMetric::add_triangle(Index v, Index a, Index b)
{
    const Point p = m_mesh.points[v];
    const double ax = double(m_mesh.points[a].x - p.x) * kPixel, ay = double(m_mesh.points[a].y - p.y) * kPixel;
    const double bx = double(m_mesh.points[b].x - p.x) * kPixel, by = double(m_mesh.points[b].y - p.y) * kPixel;
    const double area = ax * by - ay * bx;
    for (std::size_t c = 0; c < m_channels; ++c) {
        const double z = double(m_mesh.z[c][v]), az = double(m_mesh.z[c][a]) - z, bz = double(m_mesh.z[c][b]) - z;
        const double gx = (az * by - ay * bz) / area, gy = (ax * bz - az * bx) / area;
        const double steep = 1.0 + kIntensityScale * kIntensityScale * (gx * gx + gy * gy);
        m_quadrics[v * m_channels + c].add_plane(gx, gy, z - gx * double(p.x) * kPixel - gy * double(p.y) * kPixel,
                                                 area / steep);
    }
}

int QuadricMetric::candidates(Index t, Index u, Point* positions) const
{
    System s;
    for (std::size_t c = 0; c < m_channels; ++c)
        s.add(sum(t, u, c), double(m_mesh.weights[c]));
    const Point pt = m_mesh.points[t], pu = m_mesh.points[u];
    const double mx = 0.5 * double(pt.x + pu.x) * kPixel, my = 0.5 * double(pt.y + pu.y) * kPixel;
    const double pull = kPull * (s.xx + s.yy) + kPullArea * s.area;
    const double xx = s.xx + pull, yy = s.yy + pull;
    // The step from the midpoint, held to the sides that either end is on.
    double rx = s.rx - s.xx * mx - s.xy * my, ry = s.ry - s.xy * mx - s.yy * my;
    const auto side_or = [](bool first, bool second, int a, int b, double middle) {
        return first ? double(a) * kPixel : second ? double(b) * kPixel : middle;
    };
    const bool vt = m_mesh.on_vertical_side(t), vu = m_mesh.on_vertical_side(u);
    const bool ht = m_mesh.on_horizontal_side(t), hu = m_mesh.on_horizontal_side(u);
    const double hx = side_or(vt, vu, pt.x, pu.x, mx), hy = side_or(ht, hu, pt.y, pu.y, my);
    double dx = hx - mx, dy = hy - my;
    const bool fixed_x = vt || vu, fixed_y = ht || hu;
    if (!fixed_x && !fixed_y) {
        const double det = xx * yy - s.xy * s.xy;
        dx = (rx * yy - ry * s.xy) / det;
        dy = (ry * xx - rx * s.xy) / det;
    } else if (!fixed_x) {
        dx = (rx - s.xy * dy) / xx;
    } else if (!fixed_y) {
        dy = (ry - s.xy * dx) / yy;
    }
    const double reach = 4.0 * std::max(std::abs(pt.x - pu.x), std::abs(pt.y - pu.y)) * kPixel;
    const auto at = [&](double share) {
        const auto lattice = [](double v) {
            return std::int32_t(std::nearbyint(v * kSubpixels));
        };
        return Point { lattice(hx + share * (mx + std::clamp(dx, -reach, reach) - hx)),
                       lattice(hy + share * (my + std::clamp(dy, -reach, reach) - hy)) };
    };
    positions[0] = at(1.0);
    positions[1] = at(0.5);
    positions[2] = at(0.0);
    positions[3] = pt;
    positions[4] = pu;
    return kMaxCandidates;
}

double QuadricMetric::cost(Index t, Index u, Point p)
{
    const double x = double(p.x) * kPixel, y = double(p.y) * kPixel;
    const double ex = double(m_mesh.points[t].x - m_mesh.points[u].x) * kPixel;
    const double ey = double(m_mesh.points[t].y - m_mesh.points[u].y) * kPixel;
    double total = 0;
    for (std::size_t c = 0; c < m_channels; ++c) {
        const Quadric q = sum(t, u, c);
        total += double(m_mesh.weights[c]) * (q.at(x, y) + kLength * q.zz * (ex * ex + ey * ey));
    }
    return total;
}

void QuadricMetric::merge(Index t, Index u, Point p)
{
    for (std::size_t c = 0; c < m_channels; ++c) {
        const Quadric q = sum(t, u, c);
        m_quadrics[t * m_channels + c] = q;
        m_mesh.z[c][t] = float(q.best_z(double(p.x) * kPixel, double(p.y) * kPixel));
    }
}

}  // namespace

std::unique_ptr<CollapseMetric> quadric_metric(PlainMesh& mesh)
{
    return std::make_unique<QuadricMetric>(mesh);
}

}  // namespace PIMG_ABI
}  // namespace pimg
