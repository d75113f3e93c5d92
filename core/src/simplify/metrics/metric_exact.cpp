// SPDX-License-Identifier: BSD-3-Clause
// Maximum deviation with half-edge collapse: t goes to where u is, its fan is filled with triangles around u, and the
// cost is how far any pixel inside is from them. Vertices stay on pixels, with the pixels' intensities.
#include <algorithm>
#include <cmath>

#include <pimg/detail/pixel_span.h>

#include "simplify/metrics/collapse_metric.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Intensity that each pixel of the edge counts for: makes flat places coarsen evenly.
constexpr double kLength = 1e-3;

class ExactMetric : public CollapseMetric {
public:
    explicit ExactMetric(PlainMesh& mesh) : m_mesh(mesh), m_pixels(mesh.z) { }

    bool is_symmetric() const override { return false; }
    int candidates(Index, Index u, Point* positions) const override
    {
        positions[0] = m_mesh.points[u];
        return 1;
    }
    double cost(Index t, Index u, Point p) override;
    void merge(Index, Index, Point) override { }  // the one that stays has the intensity it had

private:
    double deviation(Index a, Index b, Index c) const;

    PlainMesh& m_mesh;
    std::vector<std::vector<float>> m_pixels;  ///< the picture
};

double ExactMetric::cost(Index t, Index u, Point p)
{
    const Ring& ring = m_mesh.rings[t];
    const int degree = m_mesh.degrees[t];
    double worst = 0;
    for (int j = 0; j < degree; ++j) {
        const Index a = ring.v[std::size_t(j)], b = ring.v[std::size_t((j + 1) % degree)];
        if (a != kGhost && b != kGhost && a != u && b != u)
            worst = std::max(worst, deviation(u, a, b));
    }
    const double dx = double(m_mesh.points[t].x - p.x) / kSubpixels, dy = double(m_mesh.points[t].y - p.y) / kSubpixels;
    return worst + kLength * std::sqrt(dx * dx + dy * dy);
}

/// Largest weighted difference between the triangle's plane and the pixels in it, over all channels.
double ExactMetric::deviation(Index a, Index b, Index c) const
{
    const Point p[3] = { m_mesh.points[a], m_mesh.points[b], m_mesh.points[c] };
    std::int64_t x[3], y[3];
    for (int k = 0; k < 3; ++k) {
        x[k] = p[k].x / kSubpixels;
        y[k] = p[k].y / kSubpixels;
    }
    const double area = double((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]));
    const std::int64_t top = std::min({ y[0], y[1], y[2] }), bottom = std::max({ y[0], y[1], y[2] });
    double worst = 0;
    for (std::int64_t row = top; row <= bottom; ++row) {
        const auto [first, last] = pixel_span(p, row);
        for (std::size_t ch = 0; ch < m_pixels.size() && first <= last; ++ch) {
            const double z = double(m_mesh.z[ch][a]), bz = double(m_mesh.z[ch][b]) - z,
                         cz = double(m_mesh.z[ch][c]) - z;
            const double gx = (bz * double(y[2] - y[0]) - cz * double(y[1] - y[0])) / area;
            const double gy = (cz * double(x[1] - x[0]) - bz * double(x[2] - x[0])) / area;
            const double start = z + gx * double(first - x[0]) + gy * double(row - y[0]);
            const float* pixels = &m_pixels[ch][std::size_t(row) * std::size_t(m_mesh.width) + std::size_t(first)];
            double here = 0;
            for (std::int64_t i = 0; i <= last - first; ++i)
                here = std::max(here, std::fabs(start + gx * double(i) - double(pixels[i])));
            worst = std::max(worst, double(m_mesh.weights[ch]) * here);
        }
    }
    return worst;
}

}  // namespace

std::unique_ptr<CollapseMetric> exact_metric(PlainMesh& mesh)
{
    return std::make_unique<ExactMetric>(mesh);
}

}  // namespace PIMG_ABI
}  // namespace pimg
