// SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of collapse_cost.h, included once per instruction set. Every target gives the same bits: no fused
// multiply-add, no reordered sum, and lanes never mix but in sum_lanes(), whose tree is fixed.
#if defined(PIMG_COLLAPSE_COST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PIMG_COLLAPSE_COST_INL_H
#undef PIMG_COLLAPSE_COST_INL_H
#else
#define PIMG_COLLAPSE_COST_INL_H
#endif

#include <algorithm>
#include <limits>

#include <hwy/highway.h>

#include "simplify/collapse_cost.h"

HWY_BEFORE_NAMESPACE();
namespace pimg {
inline namespace PIMG_ABI {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 8>;
using Four = hn::FixedTag<float, 4>;
using V4 = hn::Vec<Four>;

/// Transposes the 4 x 4 numbers that four vectors have in each block of four lanes.
template<class D, class V = hn::Vec<D>>
HWY_INLINE void transpose(D d, V& a, V& b, V& c, V& e)
{
    const hn::Repartition<std::uint64_t, D> two;
    const auto ab_low = hn::BitCast(two, hn::InterleaveLower(d, a, b));
    const auto ab_high = hn::BitCast(two, hn::InterleaveUpper(d, a, b));
    const auto ce_low = hn::BitCast(two, hn::InterleaveLower(d, c, e));
    const auto ce_high = hn::BitCast(two, hn::InterleaveUpper(d, c, e));
    a = hn::BitCast(d, hn::InterleaveLower(two, ab_low, ce_low));
    b = hn::BitCast(d, hn::InterleaveUpper(two, ab_low, ce_low));
    c = hn::BitCast(d, hn::InterleaveLower(two, ab_high, ce_high));
    e = hn::BitCast(d, hn::InterleaveUpper(two, ab_high, ce_high));
}

/// The nine products of four normals.
HWY_INLINE void products(const Normals& n, int j, V4 (&p)[9])
{
    const Four f;
    const V4 x = hn::Load(f, n.x + j), y = hn::Load(f, n.y + j), z = hn::Load(f, n.z + j);
    p[0] = x * x;
    p[1] = x * y;
    p[2] = y * y;
    p[3] = x * z;
    p[4] = y * z;
    p[5] = z * z;
    p[6] = x;
    p[7] = y;
    p[8] = z;
}

/// Sums of n n^T and n over all lanes: lane j + 8 is added to lane j, then 4 to 0, 2 to 0 and 1 to 0.
HWY_INLINE FanSums add_up(const Normals& n, int lanes)
{
    const Four f;
    V4 s[9], t[9];
    products(n, 0, s);
    products(n, 4, t);
    if (lanes > 8) {
        V4 u[9], v[9];
        products(n, 8, u);
        products(n, 12, v);
        for (int k = 0; k < 9; ++k) {
            s[k] = s[k] + u[k];
            t[k] = t[k] + v[k];
        }
    }
    for (int k = 0; k < 9; ++k)
        s[k] = s[k] + t[k];
    transpose(f, s[0], s[1], s[2], s[3]);
    transpose(f, s[4], s[5], s[6], s[7]);
    const V4 z = s[8] + hn::Shuffle1032(s[8]);
    FanSums sums;
    hn::StoreU((s[0] + s[2]) + (s[1] + s[3]), f, &sums.xx);
    hn::StoreU((s[4] + s[6]) + (s[5] + s[7]), f, &sums.yz);
    sums.z = hn::GetLane(z) + hn::GetLane(hn::Shuffle2301(z));
    return sums;
}

/// Repeats the first corner after the last; the entries past it must be zero up to `lanes`.
HWY_INLINE void close(Corners& c, int degree, int lanes)
{
    c.x[lanes] = c.y[lanes] = c.z[lanes] = c.real[lanes] = 0.0f;
    c.x[degree] = c.x[0];
    c.y[degree] = c.y[0];
    c.z[degree] = c.z[0];
    c.real[degree] = c.real[0];
}

/// 1 for lanes that hold a triangle (corner j, corner j + 1), else 0.
HWY_INLINE hn::Vec<Lanes> whole(const Corners& c, int j)
{
    const Lanes d;
    return hn::Load(d, c.real + j) * hn::LoadU(d, c.real + j + 1);
}

struct Vec3 {
    hn::Vec<Lanes> x, y, z;
};

/// Corners j ..., with intensities from `z`.
HWY_INLINE Vec3 corner(const Corners& c, const float* z, int j)
{
    const Lanes d;
    return { hn::LoadU(d, c.x + j), hn::LoadU(d, c.y + j), hn::LoadU(d, z + j) };
}

HWY_INLINE Vec3 operator-(Vec3 a, Vec3 b)
{
    return { a.x - b.x, a.y - b.y, a.z - b.z };
}

HWY_INLINE Vec3 cross(Vec3 a, Vec3 b, hn::Vec<Lanes> mask)
{
    return { mask * (a.y * b.z - a.z * b.y), mask * (a.z * b.x - a.x * b.z), mask * (a.x * b.y - a.y * b.x) };
}

HWY_INLINE void store(Vec3 v, Normals& n, int j)
{
    const Lanes d;
    hn::Store(v.x, d, n.x + j);
    hn::Store(v.y, d, n.y + j);
    hn::Store(v.z, d, n.z + j);
}

/// Normals of the fan around the origin, with intensities from `z` (default: the first channel's).
HWY_INLINE void fan_normals(const Corners& c, int degree, int lanes, Normals& n, const float* z = nullptr)
{
    const Lanes d;
    z = z ? z : c.z;
    for (int j = 0; j < lanes; j += int(hn::Lanes(d)))
        store(cross(corner(c, z, j), corner(c, z, j + 1), whole(c, j)), n, j);
    n.before_x = n.x[degree - 1];
    n.before_y = n.y[degree - 1];
    n.before_z = n.z[degree - 1];
}

/// One guide channel of a fan, first or further alike.
struct Channel {
    const float *z, *axx, *axy, *ayy, *axz, *ayz, *nx, *ny;
    const Normals& normals;
    float sum_xx, sum_xy, sum_yy, sum_xz, sum_yz, sum_x, sum_y;
};

HWY_INLINE Channel channel(const EdgeFan& f, int c)
{
    if (c == 0)
        return { f.corners.z, f.a[0],    f.a[1],    f.a[2],    f.a[3],    f.a[4],    f.n[0],   f.n[1],
                 f.normals,   f.sums.xx, f.sums.xy, f.sums.yy, f.sums.xz, f.sums.yz, f.sums.x, f.sums.y };
    const ChannelFan& m = f.more[c - 1];
    return { m.z,       m.a[0],    m.a[1],    m.a[2],    m.a[3],    m.a[4],    m.n[0],   m.n[1],
             m.normals, m.sums.xx, m.sums.xy, m.sums.yy, m.sums.xz, m.sums.yz, m.sums.x, m.sums.y };
}

/// The quadratic form of one channel for eight edges: the sum of squared volumes at u is u H u - 2 b u + k.
struct Quadric {
    hn::Vec<Lanes> xx, xy, yy, xz, yz, zz, bx, by, bz, k;
    hn::Vec<Lanes> alpha, beta, offset, area;  // volume preservation: z = offset - alpha x - beta y
};

HWY_INLINE Quadric edge_quadrics(const EdgeFan& f, const Channel& c, int j)
{
    const Lanes d;
    const auto ux = hn::Load(d, f.corners.x + j), uy = hn::Load(d, f.corners.y + j), uz = hn::Load(d, c.z + j);
    const auto px = hn::LoadU(d, c.normals.x + j - 1), py = hn::LoadU(d, c.normals.y + j - 1);
    const auto pz = hn::LoadU(d, f.normals.z + j - 1), qz = hn::Load(d, f.normals.z + j);
    const auto qx = hn::Load(d, c.normals.x + j), qy = hn::Load(d, c.normals.y + j);
    const auto axx = hn::Load(d, c.axx + j), axy = hn::Load(d, c.axy + j), ayy = hn::Load(d, c.ayy + j);
    const auto axz = hn::Load(d, c.axz + j), ayz = hn::Load(d, c.ayz + j), azz = hn::Load(d, f.a[5] + j);
    const auto nx = hn::Load(d, c.nx + j), ny = hn::Load(d, c.ny + j), nz = hn::Load(d, f.n[2] + j);
    Quadric h;
    h.bx = axx * ux + axy * uy + axz * uz;
    h.by = axy * ux + ayy * uy + ayz * uz;
    h.bz = axz * ux + ayz * uy + azz * uz;
    h.k = h.bx * ux + h.by * uy + h.bz * uz;
    h.xx = hn::Set(d, c.sum_xx) + axx - px * px - qx * qx;
    h.xy = hn::Set(d, c.sum_xy) + axy - px * py - qx * qy;
    h.yy = hn::Set(d, c.sum_yy) + ayy - py * py - qy * qy;
    h.xz = hn::Set(d, c.sum_xz) + axz - px * pz - qx * qz;
    h.yz = hn::Set(d, c.sum_yz) + ayz - py * pz - qy * qz;
    h.zz = hn::Set(d, f.sums.zz) + azz - pz * pz - qz * qz;
    h.area = hn::Set(d, f.sums.z) + nz - pz - qz;
    const auto inverse = hn::Load(d, f.corners.real + j) / hn::Max(h.area, hn::Set(d, 1e-20f));
    h.alpha = (hn::Set(d, c.sum_x) + nx - px - qx) * inverse;
    h.beta = (hn::Set(d, c.sum_y) + ny - py - qy) * inverse;
    h.offset = (nx * ux + ny * uy + nz * uz) * inverse;
    return h;
}

/// Squared volumes at (x, y), the intensity following from volume preservation.
HWY_INLINE hn::Vec<Lanes> volume_at(const Quadric& h, hn::Vec<Lanes> x, hn::Vec<Lanes> y)
{
    const Lanes d;
    const auto two = hn::Set(d, 2.0f);
    const auto z = h.offset - h.alpha * x - h.beta * y;
    return hn::Max(x * (h.xx * x + two * (h.xy * y + h.xz * z - h.bx)) + y * (h.yy * y + two * (h.yz * z - h.by))
                       + z * (h.zz * z - two * h.bz) + h.k,
                   hn::Zero(d));
}

/// The 2 x 2 system for (x, y) that is left once every channel's intensity is eliminated by its own volume equation.
struct System {
    hn::Vec<Lanes> xx, xy, yy, x, y;
};

HWY_INLINE System reduce(const Quadric& h, float weight)
{
    const Lanes d;
    const auto w = hn::Set(d, weight), two = hn::Set(d, 2.0f);
    return { w * (h.xx - two * h.alpha * h.xz + h.alpha * h.alpha * h.zz),
             w * (h.xy - h.alpha * h.yz - h.beta * h.xz + h.alpha * h.beta * h.zz),
             w * (h.yy - two * h.beta * h.yz + h.beta * h.beta * h.zz),
             w * (h.bx - h.alpha * h.bz - h.offset * (h.xz - h.alpha * h.zz)),
             w * (h.by - h.beta * h.bz - h.offset * (h.yz - h.beta * h.zz)) };
}

/// Solution of the system for edges that have an end on a side of the picture: it stays there, sliding along.
HWY_INLINE void hold_to_sides(const EdgeFan& f, const System& g, int j, hn::Vec<Lanes>& x, hn::Vec<Lanes>& y)
{
    const Lanes d;
    const auto one = hn::Set(d, 1.0f), tiny = hn::Set(d, 1e-30f);
    const auto other_x = hn::Load(d, f.fixed_x + j), other_y = hn::Load(d, f.fixed_y + j);
    const auto own_x = hn::Set(d, f.side & kFixedX ? 1.0f : 0.0f), own_y = hn::Set(d, f.side & kFixedY ? 1.0f : 0.0f);
    const auto side_x = other_x * (one - own_x) * hn::Load(d, f.corners.x + j);
    const auto side_y = other_y * (one - own_y) * hn::Load(d, f.corners.y + j);
    const auto on_side_x = hn::Gt(hn::Max(own_x, other_x), hn::Zero(d));
    const auto on_side_y = hn::Gt(hn::Max(own_y, other_y), hn::Zero(d));
    const auto slide_x = (g.x - g.xy * side_y) / hn::Max(g.xx, tiny);
    const auto slide_y = (g.y - g.xy * side_x) / hn::Max(g.yy, tiny);
    x = hn::IfThenElse(on_side_x, side_x, hn::IfThenElse(on_side_y, slide_x, x));
    y = hn::IfThenElse(on_side_y, side_y, hn::IfThenElse(on_side_x, slide_y, y));
}

HWY_INLINE void store_plane(const Quadric& h, int j, float* alpha, float* beta, float* offset)
{
    const Lanes d;
    hn::Store(h.alpha, d, alpha + j);
    hn::Store(h.beta, d, beta + j);
    hn::Store(h.offset, d, offset + j);
}

/// Cost of lanes j ... at (x, y): the weighted squared volumes of all channels and the floor. `first` is the form of
/// the first channel; those of the others are computed again, because there are too many to keep.
HWY_INLINE hn::Vec<Lanes> cost_at(const EdgeFan& f, const Quadric& first, int j, hn::Vec<Lanes> x, hn::Vec<Lanes> y)
{
    const Lanes d;
    auto cost = hn::Set(d, f.weights[0]) * volume_at(first, x, y);
    for (int c = 1; c <= f.more_channels; ++c)
        cost = cost + hn::Set(d, f.weights[c]) * volume_at(edge_quadrics(f, channel(f, c), j), x, y);
    const auto ux = hn::Load(d, f.corners.x + j), uy = hn::Load(d, f.corners.y + j);
    return cost + hn::Set(d, kCostFloor) * first.area * (ux * ux + uy * uy);
}

/// Optimum and cost of lanes j ... of the fan.
HWY_INLINE void evaluate_lanes(EdgeFan& f, int j)
{
    const Lanes d;
    const Quadric h = edge_quadrics(f, channel(f, 0), j);
    store_plane(h, j, f.alpha, f.beta, f.offset);
    System g = reduce(h, f.weights[0]);
    for (int c = 1; c <= f.more_channels; ++c) {
        ChannelFan& m = f.more[c - 1];
        const Quadric hc = edge_quadrics(f, channel(f, c), j);
        store_plane(hc, j, m.alpha, m.beta, m.offset);
        const System gc = reduce(hc, f.weights[c]);
        g = { g.xx + gc.xx, g.xy + gc.xy, g.yy + gc.yy, g.x + gc.x, g.y + gc.y };
    }
    // Pulled a little to the midpoint.
    const auto half = hn::Set(d, 0.5f);
    const auto pull = hn::Set(d, kPullOfTrace) * (g.xx + g.yy) + hn::Set(d, kPullOfArea) * h.area * h.area;
    g.x = g.x + pull * half * hn::Load(d, f.corners.x + j);
    g.y = g.y + pull * half * hn::Load(d, f.corners.y + j);
    g.xx = g.xx + pull;
    g.yy = g.yy + pull;
    const auto det = hn::Max(g.xx * g.yy - g.xy * g.xy, hn::Set(d, 1e-30f));
    auto x = (g.x * g.yy - g.y * g.xy) / det;
    auto y = (g.y * g.xx - g.x * g.xy) / det;
    if (f.on_border)
        hold_to_sides(f, g, j, x, y);

    // Infinite where there is no neighbour, and where numbers overflowed: NaN compares as false.
    const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
    const auto cost = cost_at(f, h, j, x, y);
    const auto inside = hn::Lt(hn::Iota(d, float(j)), hn::Set(d, float(f.degree)));
    const auto real = hn::And(inside, hn::Gt(hn::Load(d, f.corners.real + j), hn::Zero(d)));
    const auto known = hn::And(real, hn::Lt(cost, infinite));
    hn::Store(hn::IfThenElse(known, cost, infinite), d, f.cost + j);
    hn::Store(x, d, f.x + j);
    hn::Store(y, d, f.y + j);
}

/// Normals and sums of every channel.
HWY_INLINE void add_up_channels(EdgeFan& f)
{
    fan_normals(f.corners, f.degree, f.lanes, f.normals);
    f.sums = add_up(f.normals, f.lanes);
    for (int c = 0; c < f.more_channels; ++c) {
        ChannelFan& m = f.more[c];
        fan_normals(f.corners, f.degree, f.lanes, m.normals, m.z);
        const FanSums s = add_up(m.normals, f.lanes);
        m.sums = { s.xx, s.xy, s.yy, s.xz, s.yz, s.x, s.y };
    }
}

/// Fills sums, normals, and for every edge optimum and cost.
HWY_INLINE void evaluate_edges(EdgeFan& f)
{
    add_up_channels(f);
    for (int j = 0; j < f.lanes; j += int(hn::Lanes(Lanes())))
        evaluate_lanes(f, j);
}

/// The first of the edges that cost least.
HWY_INLINE int cheapest_edge(const EdgeFan& f)
{
    const Lanes d;
    auto least = hn::Load(d, f.cost);
    for (int j = int(hn::Lanes(d)); j < f.lanes; j += int(hn::Lanes(d)))
        least = hn::Min(least, hn::Load(d, f.cost + j));
    least = hn::MinOfLanes(d, least);
    for (int j = 0; j < f.lanes; j += int(hn::Lanes(d)))
        if (const auto lane = hn::FindFirstTrue(d, hn::Eq(hn::Load(d, f.cost + j), least)); lane >= 0)
            return j + int(lane);
    return 0;
}

/// The error of the vertex's own fan if the vertex moved along one of its edges to the other end: squared volumes plus
/// the cost's floor, at the end where that is least.
HWY_INLINE float least_own_error(const EdgeFan& f)
{
    const Lanes d;
    const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
    auto least = infinite;
    for (int j = 0; j < f.lanes; j += int(hn::Lanes(d))) {
        const Vec3 u = corner(f.corners, f.corners.z, j);
        const auto length = u.x * u.x + u.y * u.y;
        auto error = hn::Set(d, kCostFloor * f.sums.z) * length;
        for (int c = 0; c <= f.more_channels; ++c) {
            const Channel a = channel(f, c);
            const auto uz = hn::Load(d, a.z + j), two = hn::Set(d, 2.0f);
            const auto xx = hn::Set(d, a.sum_xx), xy = hn::Set(d, a.sum_xy), xz = hn::Set(d, a.sum_xz);
            const auto x = u.x * (xx * u.x + two * (xy * u.y + xz * uz));
            const auto y = u.y * (hn::Set(d, a.sum_yy) * u.y + two * hn::Set(d, a.sum_yz) * uz);
            error = error + hn::Set(d, f.weights[c]) * hn::Max(x + y + hn::Set(d, f.sums.zz) * uz * uz, hn::Zero(d));
        }
        // Nothing is known where there is no neighbour or where numbers overflowed.
        const auto known = hn::And(hn::Gt(length, hn::Zero(d)), hn::Lt(error, infinite));
        least = hn::Min(least, hn::IfThenElse(known, error, infinite));
    }
    const float found = hn::GetLane(hn::MinOfLanes(d, least));
    return found < std::numeric_limits<float>::infinity() ? found : 0.0f;
}

/// Cost of edge j with its optimum moved to (x, y).
HWY_INLINE float edge_cost_at(const EdgeFan& f, int j, float x, float y)
{
    const Lanes d;
    const int first = j - j % int(hn::Lanes(d));
    HWY_ALIGN float cost[8];
    const Quadric h = edge_quadrics(f, channel(f, 0), first);
    hn::Store(cost_at(f, h, first, hn::Set(d, x), hn::Set(d, y)), d, cost);
    return cost[j - first];
}

}  // namespace HWY_NAMESPACE
}  // namespace PIMG_ABI
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#endif
