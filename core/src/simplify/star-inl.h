// SPDX-License-Identifier: BSD-3-Clause
// The star a collapse leaves: its topology, its shape, its projections, and how it changes the fans around it. Included
// once per instruction set.
#if defined(PIMG_STAR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PIMG_STAR_INL_H
#undef PIMG_STAR_INL_H
#else
#define PIMG_STAR_INL_H
#endif

#include <pimg/detail/projection.h>

#include "simplify/collapse_record.h"
#include "simplify/edge_fan-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pimg {
inline namespace PIMG_ABI {
namespace HWY_NAMESPACE {

/// The star s will have: ring of t from vr to vl, then that of u back to vr. Places are relative to t.
struct Star {
    int degree, vl;                                         ///< place of vl; vr is at 0
    Corners corners;                                        ///< in pixels
    alignas(64) std::int32_t x[kLanes + 8], y[kLanes + 8];  ///< in lattice units, closed like corners
    alignas(64) float more_z[kMaxGuideChannels - 1][kLanes + 8];
    alignas(64) Index ring[kLanes];  ///< padded like the rings of WorkingMesh
};

struct Placement {
    float x, y;
};

// -- rings, all their lanes at once --------------------------------------------------------------------------------

/// Place of `x` in a padded ring, or -1.
HWY_INLINE int place_in(const Index* ring, Index x)
{
    const Integers i;
    const auto wanted = hn::Set(i, std::int32_t(x));
    for (int j = 0; j < kLanes; j += int(hn::Lanes(i))) {
        const auto v = hn::LoadU(i, reinterpret_cast<const std::int32_t*>(ring) + j);
        if (const auto place = hn::FindFirstTrue(i, hn::Eq(v, wanted)); place >= 0)
            return j + int(place);
    }
    return -1;
}

HWY_INLINE void replace_in(Ring& ring, Index from, Index to)
{
    const Integers i;
    const auto old = hn::Set(i, std::int32_t(from)), now = hn::Set(i, std::int32_t(to));
    for (int j = 0; j < kLanes; j += int(hn::Lanes(i))) {
        auto* p = reinterpret_cast<std::int32_t*>(ring.v.data()) + j;
        const auto v = hn::LoadU(i, p);
        hn::StoreU(hn::IfThenElse(hn::Eq(v, old), now, v), i, p);
    }
}

/// Removes `x` from a padded ring.
HWY_INLINE void remove_from(Ring& ring, Index x)
{
    for (std::size_t j = std::size_t(place_in(ring.v.data(), x)); j + 1 < kLanes && ring.v[j] != kNoVertex; ++j)
        ring.v[j] = ring.v[j + 1];
    ring.v[kLanes - 1] = kNoVertex;
}

/// Copies a ring so that it starts at `first`; what follows the last neighbour is left to the caller.
HWY_INLINE void rotate(const Ring& ring, int degree, int first, Index* to)
{
    const Integers i;
    std::int32_t twice[2 * kLanes + 8];
    for (int start : { 0, degree })
        for (int j = 0; j < kLanes; j += int(hn::Lanes(i)))
            hn::StoreU(hn::LoadU(i, reinterpret_cast<const std::int32_t*>(ring.v.data()) + j), i, twice + start + j);
    for (int j = 0; j < kLanes; j += int(hn::Lanes(i)))
        hn::StoreU(hn::LoadU(i, twice + first + j), i, reinterpret_cast<std::int32_t*>(to) + j);
}

HWY_INLINE void pad(Index* ring, int degree)
{
    const Integers i;
    const auto none = hn::Set(i, std::int32_t(kNoVertex));
    for (int j = 0; j < kLanes; j += int(hn::Lanes(i))) {
        auto* p = reinterpret_cast<std::int32_t*>(ring) + j;
        hn::StoreU(hn::IfThenElse(hn::Lt(hn::Iota(i, j), hn::Set(i, degree)), hn::LoadU(i, p), none), i, p);
    }
}

// -- before the collapse -------------------------------------------------------------------------------------------

/// Finds the ring that merging t with its neighbour j would give. False when the link condition (with the ghost counted
/// as a vertex) or the sides of the picture forbid the collapse.
HWY_INLINE bool join_rings(const WorkingMesh& mesh, Index t, int j, Star& star)
{
    const Node& node = mesh.nodes[t];
    const Ring& ring = mesh.rings[t];
    const Index u = ring.v[std::size_t(j)];
    const Node& other = mesh.nodes[u];
    const Ring& other_ring = mesh.rings[u];
    const int degree = node.degree + other.degree - 4;
    if (degree > kMaxDegree || degree < 3)
        return false;
    if ((node.side & other.side & kFixedX && node.p.x != other.p.x)
        || (node.side & other.side & kFixedY && node.p.y != other.p.y))
        return false;  // two opposite sides

    rotate(ring, node.degree, j + 1, star.ring);
    star.vl = node.degree - 2;
    star.degree = degree;
    Index* next = star.ring + node.degree - 1;
    int at = place_in(other_ring.v.data(), t) + 2;
    for (int k = other.degree - 3; k > 0; --k, ++at) {
        const Index q = other_ring.v[std::size_t(at < other.degree ? at : at - other.degree)];
        if (place_in(ring.v.data(), q) >= 0)
            return false;  // a third common neighbour
        *next++ = q;
    }
    pad(star.ring, degree);
    for (int k : { 0, star.vl })
        if (star.ring[k] != kGhost && mesh.nodes[star.ring[k]].degree <= 3)
            return false;
    return true;
}

/// The star's vertices; false when one is outside the zone.
HWY_INLINE bool load_star(const WorkingMesh& mesh, Index t, const Zone& zone, int more_channels, Star& star)
{
    const Integers i;
    const int n = star.degree, lanes = lanes_for(n);
    const Neighbours from(mesh, star.ring, n);
    if (!all_in_zone(from, star.ring, n, zone))
        return false;
    for (int j = 0; j < lanes; j += int(hn::Lanes(i))) {
        hn::Vec<Integers> px, py;
        load_corners(from, star.ring, mesh.nodes[t], j, star.corners, px, py);
        hn::Store(px, i, star.x + j);
        hn::Store(py, i, star.y + j);
    }
    close(star.corners, n, lanes);
    star.x[lanes] = star.y[lanes] = 0;
    star.x[n] = star.x[0];
    star.y[n] = star.y[0];
    for (int c = 0; c < more_channels; ++c) {
        float* z = star.more_z[c];
        std::fill(z, z + lanes + 1, 0.0f);
        for (int k = 0; k < n; ++k)
            if (star.ring[k] != kGhost)
                z[k] = mesh.more_of(star.ring[k])[c].value - mesh.more_of(t)[c].value;
        z[n] = z[0];
    }
    return true;
}

/// The guard: every triangle of the star keeps its orientation and stays away from a sliver. The margin is far
/// above what single precision can lose in the area, so orientation is certain.
HWY_INLINE bool keeps_shape(const Star& star, float least, float x, float y)
{
    const Lanes d;
    const auto vx = hn::Set(d, x), vy = hn::Set(d, y), guard = hn::Set(d, least);
    bool ok = true;
    for (int j = 0; j < star.degree; j += int(hn::Lanes(d))) {
        const Vec3 a = corner(star.corners, star.corners.z, j), b = corner(star.corners, star.corners.z, j + 1);
        const auto ex = a.x - vx, ey = a.y - vy, fx = b.x - vx, fy = b.y - vy, gx = a.x - b.x, gy = a.y - b.y;
        const auto longest = hn::Max(hn::Max(ex * ex + ey * ey, fx * fx + fy * fy), gx * gx + gy * gy);
        // Written so that a NaN counts as refused.
        const auto enough = hn::Ge(ex * fy - fx * ey, guard * longest);
        const auto none = hn::Le(whole(star.corners, j), hn::Zero(d));
        ok &= hn::AllTrue(d, hn::Or(enough, none));
    }
    return ok;
}

// -- the record ----------------------------------------------------------------------------------------------------

/// Whether all corners are so close that areas fit into 32 bits, as they do on all but the coarsest levels.
HWY_INLINE bool is_near(const Star& star)
{
    constexpr float kNear = 256.0f;  // pixels: 2^14 lattice units, whose doubled areas are below 2^31
    const Lanes d;
    auto far = hn::Zero(d);
    for (int j = 0; j < lanes_for(star.degree); j += int(hn::Lanes(d)))
        far = hn::Max(far, hn::Max(hn::Abs(hn::Load(d, star.corners.x + j)), hn::Abs(hn::Load(d, star.corners.y + j))));
    return hn::AllTrue(d, hn::Lt(far, hn::Set(d, kNear)));
}

/// The same as project() of pimg/detail/projection.h, with `p` and `s` relative to t, for all faces at once.
HWY_INLINE Projection project(const Star& star, Point p, Point s, bool near)
{
    if (near) {
        const Lanes d;
        const Integers i;
        const auto sx = hn::Set(i, s.x), sy = hn::Set(i, s.y), x = hn::Set(i, p.x - s.x), y = hn::Set(i, p.y - s.y);
        for (int j = 0; j < star.degree; j += int(hn::Lanes(i))) {
            // Twice the area of (s, corner, p) for the two corners of a face; that of (s, p, corner) is its opposite.
            const auto before = (hn::Load(i, star.x + j) - sx) * y - (hn::Load(i, star.y + j) - sy) * x;
            const auto after = (hn::LoadU(i, star.x + j + 1) - sx) * y - (hn::LoadU(i, star.y + j + 1) - sy) * x;
            const auto face = hn::RebindMask(i, hn::Gt(whole(star.corners, j), hn::Zero(d)));
            const auto holds = hn::And(face, hn::And(hn::Gt(before, hn::Set(i, -1)), hn::Lt(after, hn::Set(i, 1))));
            const auto lane = hn::FindFirstTrue(i, holds);
            if (lane < 0)
                continue;
            const int k = j + int(lane), next = k + 1 < star.degree ? k + 1 : 0;
            const Point a { star.x[k], star.y[k] }, b { star.x[next], star.y[next] };
            const double area = double(doubled_area(s, a, b));
            return { star.ring[k], star.ring[next], float(double(doubled_area(s, p, b)) / area),
                     float(double(doubled_area(s, a, p)) / area) };
        }
    }
    Point points[kLanes];
    for (int k = 0; k < star.degree; ++k)
        points[k] = { star.x[k], star.y[k] };
    return pimg::project(p, s, star.degree, star.ring, points);
}

// -- the fans around it --------------------------------------------------------------------------------------------

/// New minus old products of the normals around a star, triangle by triangle, in the order of FanSums. A normal does
/// not depend on the origin, so the three vertices of a triangle share its contribution. Lane -1 (`before`) repeats
/// the last triangle.
struct Changes {
    alignas(64) float row[9][16 + kLanes];
    float* of(int k) { return row[k] + 16; }
};

/// Fills the changes of one channel and the new normals. `z` are the corners' intensities, `u` the far end of the edge
/// and `s` the new place, all relative to t.
HWY_INLINE void star_changes(const Star& star, const float* z, const float (&u)[3], const float (&s)[3],
                             Changes& changes, Normals& after)
{
    const Lanes d;
    const Vec3 to { hn::Set(d, s[0]), hn::Set(d, s[1]), hn::Set(d, s[2]) };
    const auto ux = hn::Set(d, u[0]), uy = hn::Set(d, u[1]), uz = hn::Set(d, u[2]);
    const auto last_of_t = hn::Set(d, float(star.vl));
    for (int k = 0; k < lanes_for(star.degree); k += int(hn::Lanes(d))) {
        // The old triangles have their apex in t up to vl, in u from there on.
        const auto of_t = hn::Lt(hn::Iota(d, float(k)), last_of_t);
        const Vec3 apex { hn::IfThenZeroElse(of_t, ux), hn::IfThenZeroElse(of_t, uy), hn::IfThenZeroElse(of_t, uz) };
        const Vec3 a = corner(star.corners, z, k), b = corner(star.corners, z, k + 1);
        const auto mask = whole(star.corners, k);
        const Vec3 o = cross(a - apex, b - apex, mask), p = cross(a - to, b - to, mask);
        store(p, after, k);
        hn::Store(p.x * p.x - o.x * o.x, d, changes.of(0) + k);
        hn::Store(p.x * p.y - o.x * o.y, d, changes.of(1) + k);
        hn::Store(p.y * p.y - o.y * o.y, d, changes.of(2) + k);
        hn::Store(p.x * p.z - o.x * o.z, d, changes.of(3) + k);
        hn::Store(p.y * p.z - o.y * o.z, d, changes.of(4) + k);
        hn::Store(p.z * p.z - o.z * o.z, d, changes.of(5) + k);
        hn::Store(p.x - o.x, d, changes.of(6) + k);
        hn::Store(p.y - o.y, d, changes.of(7) + k);
        hn::Store(p.z - o.z, d, changes.of(8) + k);
    }
    for (int k = 0; k < 9; ++k)
        changes.of(k)[-1] = changes.of(k)[star.degree - 1];
}

/// Adds `d`, in the order of FanSums, to the sums of a vertex.
HWY_INLINE void add(FanSums& s, V4 first, V4 second, float z)
{
    const Four f;
    float* sums = &s.xx;
    hn::Store(hn::Load(f, sums) + first, f, sums);
    hn::Store(hn::Load(f, sums + 4) + second, f, sums + 4);
    s.z += z;
}

HWY_INLINE void add(ChannelSums& s, V4 first, V4 second, float)
{
    const Four f;
    HWY_ALIGN float d[8];
    hn::Store(first, f, d);
    hn::Store(second, f, d + 4);
    s.xx += d[0];
    s.xy += d[1];
    s.yy += d[2];
    s.xz += d[3];
    s.yz += d[4];
    s.x += d[6];
    s.y += d[7];
}

/// Applies the changes to every vertex of the star, and takes away the two triangles that vanish with edge j.
/// `sums_of(q)` gives the sums of vertex q.
template<class SumsOf>
HWY_INLINE void apply(const Star& star, Changes& changes, const EdgeFan& fan, const Normals& old, int j,
                      SumsOf&& sums_of)
{
    const Four f;
    for (int k = 0; k < star.degree; k += 4) {
        V4 d[9];
        for (int r = 0; r < 9; ++r)
            d[r] = hn::Load(f, changes.of(r) + k) + hn::LoadU(f, changes.of(r) + k - 1);
        HWY_ALIGN float z[4];
        hn::Store(d[8], f, z);
        transpose(f, d[0], d[1], d[2], d[3]);
        transpose(f, d[4], d[5], d[6], d[7]);
        for (int i = 0; i < 4; ++i)
            if (star.ring[k + i] < kNoVertex)
                add(sums_of(star.ring[k + i]), d[i], d[4 + i], z[i]);
    }
    const auto drop = [&](Index q, int lane) {
        const float x = old.x[lane], y = old.y[lane], z = fan.normals.z[lane];
        HWY_ALIGN const float gone[8] = { -x * x, -x * y, -y * y, -x * z, -y * z, -z * z, -x, -y };
        if (q != kGhost)
            add(sums_of(q), hn::Load(f, gone), hn::Load(f, gone + 4), -z);
    };
    drop(star.ring[0], j);
    drop(star.ring[star.vl], j > 0 ? j - 1 : fan.degree - 1);
}

}  // namespace HWY_NAMESPACE
}  // namespace PIMG_ABI
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#endif
