// SPDX-License-Identifier: BSD-3-Clause
// Structure tensors on a pyramid. Each level gives directions at its own scale. Where it shows only noise, or structure
// in all directions, the next coarser level decides. So an edge keeps its exact direction, and a flat sky takes the
// directions of what borders it, without a gap in between.
#include <pimg/detail/parallel.h>
#include <pimg/direction.h>

#include <algorithm>
#include <cmath>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Direction of a picture that has none: strokes fall from right to left, as a right hand draws them.
constexpr Vec2 kDefaultDoubled { 0.0f, -0.05f };

/// Sums of gx gx, gy gy and gx gy over a neighbourhood.
struct Tensor {
    float xx = 0.0f, yy = 0.0f, xy = 0.0f;
};

Tensor operator+(Tensor a, Tensor b)
{
    return { a.xx + b.xx, a.yy + b.yy, a.xy + b.xy };
}
Tensor operator*(float k, Tensor a)
{
    return { k * a.xx, k * a.yy, k * a.xy };
}

/// A raster that knows its size. Outside it has the sample of the nearest place inside.
template<class T>
struct Grid {
    int width = 0, height = 0;
    std::vector<T> v;

    Grid() = default;
    Grid(int w, int h) : width(w), height(h), v(std::size_t(w) * std::size_t(h)) { }
    T* row(int y) { return v.data() + std::size_t(std::clamp(y, 0, height - 1)) * std::size_t(width); }
    const T* row(int y) const { return v.data() + std::size_t(std::clamp(y, 0, height - 1)) * std::size_t(width); }
};

/// Mean of 2 x 2 pixels.
Grid<float> halve(const float* samples, int width, int height, const ParallelFor& parallel)
{
    Grid<float> half((width + 1) / 2, (height + 1) / 2);
    for_rows(parallel, 0, half.height, [&](int y) {
        const float* a = samples + std::size_t(2 * y) * std::size_t(width);
        const float* b = 2 * y + 1 < height ? a + width : a;
        float* out = half.row(y);
        for (int x = 0; x < half.width; ++x) {
            const int right = std::min(2 * x + 1, width - 1);
            out[x] = 0.25f * ((a[2 * x] + a[right]) + (b[2 * x] + b[right]));
        }
    });
    return half;
}

/// Binomial 1 4 6 4 1 along rows and columns.
template<class T>
Grid<T> blur(const Grid<T>& in, const ParallelFor& parallel)
{
    Grid<T> across(in.width, in.height), out(in.width, in.height);
    const auto weigh = [](T a, T b, T c, T d, T e) {
        return 0.0625f * (a + e) + (0.25f * (b + d) + 0.375f * c);
    };
    for_rows(parallel, 0, in.height, [&](int y) {
        const T* r = in.row(y);
        T* o = across.row(y);
        const int last = in.width - 1;
        for (int x = 0; x <= last; ++x)
            o[x] = weigh(r[std::max(x - 2, 0)], r[std::max(x - 1, 0)], r[x], r[std::min(x + 1, last)],
                         r[std::min(x + 2, last)]);
    });
    for_rows(parallel, 0, in.height, [&](int y) {
        const T *a = across.row(y - 2), *b = across.row(y - 1), *c = across.row(y), *d = across.row(y + 1),
                *e = across.row(y + 2);
        T* o = out.row(y);
        for (int x = 0; x < in.width; ++x)
            o[x] = weigh(a[x], b[x], c[x], d[x], e[x]);
    });
    return out;
}

Grid<Tensor> halve(const Grid<Tensor>& in)
{
    Grid<Tensor> half((in.width + 1) / 2, (in.height + 1) / 2);
    for (int y = 0; y < half.height; ++y) {
        const Tensor *a = in.row(2 * y), *b = in.row(2 * y + 1);
        for (int x = 0; x < half.width; ++x) {
            const int right = std::min(2 * x + 1, in.width - 1);
            half.row(y)[x] = 0.25f * ((a[2 * x] + a[right]) + (b[2 * x] + b[right]));
        }
    }
    return half;
}

/// The tensors of all channels, in (units per pixel)^2.
Grid<Tensor> tensors(const ChannelsView& guides, const ParallelFor& parallel)
{
    Grid<Tensor> sum((guides.width + 1) / 2, (guides.height + 1) / 2);
    for (const float* samples : guides.channels) {
        const Grid<float> smooth = blur(halve(samples, guides.width, guides.height, parallel), parallel);
        for_rows(parallel, 0, sum.height, [&](int y) {
            const float *above = smooth.row(y - 1), *here = smooth.row(y), *below = smooth.row(y + 1);
            Tensor* out = sum.row(y);
            for (int x = 0; x < sum.width; ++x) {
                const float gx = 0.25f * (here[std::min(x + 1, sum.width - 1)] - here[std::max(x - 1, 0)]);
                const float gy = 0.25f * (below[x] - above[x]);
                out[x] = out[x] + Tensor { gx * gx, gy * gy, gx * gy };
            }
        });
    }
    return blur(sum, parallel);
}

/// A vector at twice the angle of the edge, which is at 90 degrees to the gradient: hence the signs. It is longer, the
/// more the tensor prefers one direction.
Vec2 edge_direction(Tensor t)
{
    const float trace = t.xx + t.yy;
    return trace > 0.0f ? Vec2 { (t.yy - t.xx) / trace, -2.0f * t.xy / trace } : Vec2 {};
}

/// Bilinear sample of a grid of half this resolution.
Vec2 from_coarser(const Grid<Vec2>& coarse, int x, int y)
{
    const float fx = 0.5f * float(x) - 0.25f, fy = 0.5f * float(y) - 0.25f;
    const int x0 = int(std::floor(fx)), y0 = int(std::floor(fy));
    const float wx = fx - float(x0), wy = fy - float(y0);
    const int xa = std::clamp(x0, 0, coarse.width - 1), xb = std::clamp(x0 + 1, 0, coarse.width - 1);
    const Vec2 *a = coarse.row(y0), *b = coarse.row(y0 + 1);
    const auto mix = [&](float aa, float ab, float ba, float bb) {
        return (1 - wy) * ((1 - wx) * aa + wx * ab) + wy * ((1 - wx) * ba + wx * bb);
    };
    return { mix(a[xa].x, a[xb].x, b[xa].x, b[xb].x), mix(a[xa].y, a[xb].y, b[xa].y, b[xb].y) };
}

}  // namespace

DirectionField::DirectionField(const ChannelsView& guides, const ParallelFor& parallel, float noise)
    : m_width(guides.width),
      m_height(guides.height)
{
    std::vector<Grid<Tensor>> levels { tensors(guides, parallel) };
    while (levels.back().width > 1 || levels.back().height > 1)
        levels.push_back(blur(halve(levels.back()), parallel));
    Grid<Vec2> coarse(1, 1);
    coarse.v[0] = kDefaultDoubled;
    for (std::size_t k = levels.size(); k-- > 0;) {
        const Grid<Tensor>& level = levels[k];
        Grid<Vec2> fine(level.width, level.height);
        // At coarser levels, where edges are farther away, weaker ones count: there may be no others.
        const float floor = noise * noise / float(1u << std::min<std::size_t>(2 * k, 30));
        for_rows(parallel, 0, level.height, [&](int y) {
            for (int x = 0; x < level.width; ++x) {
                const Tensor t = level.row(y)[x];
                const Vec2 own = edge_direction(t), far = from_coarser(coarse, x, y);
                const float energy = t.xx + t.yy, one_way = std::sqrt(own.x * own.x + own.y * own.y);
                const float trust = one_way * energy / (energy + floor);
                fine.row(y)[x] = { trust * own.x + (1 - trust) * far.x, trust * own.y + (1 - trust) * far.y };
            }
        });
        coarse = std::move(fine);
    }
    m_columns = coarse.width;
    m_rows = coarse.height;
    m_doubled = std::move(coarse.v);
}

Vec2 DirectionField::doubled(Vec2 p) const
{
    const float fx = std::clamp(0.5f * p.x - 0.25f, 0.0f, float(m_columns - 1));
    const float fy = std::clamp(0.5f * p.y - 0.25f, 0.0f, float(m_rows - 1));
    const int x = int(fx), y = int(fy);
    const float wx = fx - float(x), wy = fy - float(y);
    const Vec2* a = m_doubled.data() + std::size_t(y) * std::size_t(m_columns) + x;
    const Vec2* b = y + 1 < m_rows ? a + m_columns : a;
    const int right = x + 1 < m_columns ? 1 : 0;
    return { (1 - wy) * ((1 - wx) * a[0].x + wx * a[right].x) + wy * ((1 - wx) * b[0].x + wx * b[right].x),
             (1 - wy) * ((1 - wx) * a[0].y + wx * a[right].y) + wy * ((1 - wx) * b[0].y + wx * b[right].y) };
}

Vec2 DirectionField::at(Vec2 p) const
{
    Vec2 d = doubled(p);
    float length = std::sqrt(d.x * d.x + d.y * d.y);
    if (!(length > 1e-12f)) {
        d = kDefaultDoubled;
        length = -kDefaultDoubled.y;
    }
    // Half of the angle, by the half-angle formulas.
    const float c = d.x / length, s = d.y / length;
    const float x = std::sqrt(std::max(0.0f, 0.5f * (1.0f + c)));
    const float y = std::sqrt(std::max(0.0f, 0.5f * (1.0f - c)));
    return { x, s < 0.0f ? -y : y };
}

float DirectionField::certainty(Vec2 p) const
{
    const Vec2 d = doubled(p);
    return std::min(1.0f, std::sqrt(d.x * d.x + d.y * d.y));
}

}  // namespace PIMG_ABI
}  // namespace pimg
