// SPDX-License-Identifier: BSD-3-Clause
// Loads the neighbours of a vertex, one cache line each, and transposes them into SIMD lanes, one neighbour per lane.
// Included once per instruction set.
#if defined(PIMG_EDGE_FAN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PIMG_EDGE_FAN_INL_H
#undef PIMG_EDGE_FAN_INL_H
#else
#define PIMG_EDGE_FAN_INL_H
#endif

#include "simplify/collapse_cost-inl.h"
#include "simplify/working_mesh.h"

HWY_BEFORE_NAMESPACE();
namespace pimg {
inline namespace PIMG_ABI {
namespace HWY_NAMESPACE {

using Integers = hn::RebindToSigned<Lanes>;

constexpr float kPixel = 1.0f / float(kSubpixels);

/// Stands in for the ghost and for lanes past the degree.
const Node kNoNode = {};

inline int lanes_for(int degree)
{
    return degree <= 8 ? 8 : kLanes;
}

/// The nodes of a padded ring's vertices.
struct Neighbours {
    const Node* node[kLanes];

    Neighbours(const WorkingMesh& mesh, const Index* ring, int degree)
    {
        for (int j = 0; j < lanes_for(degree); ++j)
            node[j] = ring[j] < kNoVertex ? &mesh.nodes[ring[j]] : &kNoNode;
    }
};

/// Quarter `part` of the nodes of lanes j ...: its four numbers, a vector for each.
template<class D>
HWY_INLINE void load_columns(D d, const Neighbours& from, int j, int part, hn::Vec<D> (&column)[4])
{
    const Four f;
    const auto quarter = [&](int k) {
        return reinterpret_cast<const float*>(from.node[j + k]) + 4 * part;
    };
    for (int k = 0; k < 4; ++k) {
        const V4 low = hn::Load(f, quarter(k));
        if constexpr (hn::MaxLanes(D()) == 8)
            column[k] = hn::Combine(d, hn::Load(f, quarter(k + 4)), low);
        else
            column[k] = low;
    }
    transpose(d, column[0], column[1], column[2], column[3]);
}

/// All ones for lanes that hold a vertex: neither ghost nor padding, whose numbers are negative as signed ones.
HWY_INLINE hn::Mask<Lanes> real_lanes(const Index* ring, int j)
{
    const Integers i;
    const auto v = hn::LoadU(i, reinterpret_cast<const std::int32_t*>(ring) + j);
    return hn::RebindMask(Lanes(), hn::Gt(v, hn::Set(i, -1)));
}

/// The homes of lanes j ..., y above x. One number is read of each node, for the rest may be changing.
template<class D>
HWY_INLINE hn::Vec<D> load_homes([[maybe_unused]] D d, const Neighbours& from, int j)
{
    const hn::FixedTag<std::int32_t, 1> one;
    const hn::FixedTag<std::int32_t, 2> two;
    const hn::FixedTag<std::int32_t, 4> four;
    const auto home = [&](int k) {
        return hn::LoadU(one, reinterpret_cast<const std::int32_t*>(&from.node[j + k]->home));
    };
    const auto homes = [&](int k) {
        return hn::Combine(four, hn::Combine(two, home(k + 3), home(k + 2)), hn::Combine(two, home(k + 1), home(k)));
    };
    if constexpr (hn::MaxLanes(D()) == 8)
        return hn::Combine(d, homes(4), homes(0));
    else
        return homes(0);
}

/// Whether the zone has all vertices of a padded ring. To be asked before any other number of their nodes is read:
/// what lies outside may be written by another tile at this moment, but a home never changes.
HWY_INLINE bool all_in_zone(const Neighbours& from, const Index* ring, int degree, const Zone& zone)
{
    const Integers i;
    const hn::RebindToUnsigned<Integers> u;
    auto outside = hn::Zero(i);
    for (int j = 0; j < lanes_for(degree); j += int(hn::Lanes(i))) {
        const auto home = load_homes(i, from, j);
        const auto x = hn::And(home, hn::Set(i, 0xffff));
        const auto y = hn::BitCast(i, hn::ShiftRight<16>(hn::BitCast(u, home)));
        const auto low = hn::Or(hn::Lt(x, hn::Set(i, zone.x0)), hn::Lt(y, hn::Set(i, zone.y0)));
        const auto high = hn::Or(hn::Gt(x, hn::Set(i, zone.x1 - 1)), hn::Gt(y, hn::Set(i, zone.y1 - 1)));
        const auto real = hn::RebindMask(i, real_lanes(ring, j));
        outside = hn::Or(outside, hn::VecFromMask(i, hn::And(real, hn::Or(low, high))));
    }
    return hn::AllTrue(i, hn::Eq(outside, hn::Zero(i)));
}

/// Places of lanes j ... relative to `centre`, in lattice units, and their corners in pixels and guide units.
HWY_INLINE void load_corners(const Neighbours& from, const Index* ring, const Node& centre, int j, Corners& c,
                             hn::Vec<Integers>& px, hn::Vec<Integers>& py)
{
    const Lanes d;
    const Integers i;
    hn::Vec<Lanes> column[4];
    load_columns(d, from, j, 0, column);
    const auto real = hn::IfThenElseZero(real_lanes(ring, j), hn::Set(d, 1.0f));
    const auto pixel = hn::Set(d, kPixel);
    px = hn::BitCast(i, column[2]) - hn::Set(i, centre.p.x);
    py = hn::BitCast(i, column[3]) - hn::Set(i, centre.p.y);
    hn::Store(real, d, c.real + j);
    hn::Store(real * (column[1] - hn::Set(d, centre.z)), d, c.z + j);
    hn::Store(real * (hn::ConvertTo(d, px) * pixel), d, c.x + j);
    hn::Store(real * (hn::ConvertTo(d, py) * pixel), d, c.y + j);
}

/// The places of v's neighbours in every channel.
HWY_INLINE void load_corners(const WorkingMesh& mesh, Index v, const Neighbours& from, EdgeFan& fan)
{
    const Node& node = mesh.nodes[v];
    const Index* ring = mesh.rings[v].v.data();
    fan.degree = node.degree;
    fan.lanes = lanes_for(node.degree);
    fan.side = node.side;
    for (int j = 0; j < fan.lanes; j += int(hn::Lanes(Lanes()))) {
        hn::Vec<Integers> px, py;
        load_corners(from, ring, node, j, fan.corners, px, py);
    }
    close(fan.corners, fan.degree, fan.lanes);
    for (int c = 0; c < fan.more_channels; ++c) {
        ChannelFan& m = fan.more[c];
        m.value = mesh.more_of(v)[c].value;
        for (int j = 0; j < fan.lanes; ++j)
            m.z[j] = ring[j] < kNoVertex ? mesh.more_of(ring[j])[c].value - m.value : 0.0f;
        m.z[fan.lanes] = 0.0f;
        m.z[fan.degree] = m.z[0];
    }
}

/// The part of load_sums() that guide channels after the first need.
HWY_INLINE void load_more_sums(const WorkingMesh& mesh, const Index* ring, EdgeFan& fan)
{
    const ChannelSums none {};
    for (int c = 0; c < fan.more_channels; ++c) {
        ChannelFan& m = fan.more[c];
        for (int j = 0; j < fan.lanes; ++j) {
            const ChannelSums& s = ring[j] < kNoVertex ? mesh.more_of(ring[j])[c].sums : none;
            m.a[0][j] = s.xx;
            m.a[1][j] = s.xy;
            m.a[2][j] = s.yy;
            m.a[3][j] = s.xz;
            m.a[4][j] = s.yz;
            m.n[0][j] = s.x;
            m.n[1][j] = s.y;
        }
    }
}

/// The sums of the neighbours in every channel, and which sides they must stay on.
HWY_INLINE void load_sums(const WorkingMesh& mesh, const Index* ring, const Neighbours& from, EdgeFan& fan)
{
    const Lanes d;
    const Integers i;
    const auto one = hn::Set(d, 1.0f);
    auto sides = hn::Set(i, fan.side << 8);
    for (int j = 0; j < fan.lanes; j += int(hn::Lanes(d))) {
        hn::Vec<Lanes> column[4];
        load_columns(d, from, j, 1, column);
        for (int k = 0; k < 4; ++k)
            hn::Store(column[k], d, fan.a[k] + j);
        load_columns(d, from, j, 2, column);
        hn::Store(column[0], d, fan.a[4] + j);
        hn::Store(column[1], d, fan.a[5] + j);
        hn::Store(column[2], d, fan.n[0] + j);
        hn::Store(column[3], d, fan.n[1] + j);
        load_columns(d, from, j, 3, column);
        hn::Store(column[0], d, fan.n[2] + j);
        const auto flags = hn::BitCast(i, column[3]);  // degree, side << 8
        sides = hn::Or(sides, flags);
        const auto fixed = [&](int side) {
            return hn::RebindMask(d, hn::Ne(hn::And(flags, hn::Set(i, side << 8)), hn::Zero(i)));
        };
        hn::Store(hn::IfThenElseZero(fixed(kFixedX), one), d, fan.fixed_x + j);
        hn::Store(hn::IfThenElseZero(fixed(kFixedY), one), d, fan.fixed_y + j);
    }
    fan.on_border = !hn::AllTrue(i, hn::Eq(hn::And(sides, hn::Set(i, kCorner << 8)), hn::Zero(i)));
    if (fan.more_channels > 0)
        load_more_sums(mesh, ring, fan);
}

}  // namespace HWY_NAMESPACE
}  // namespace PIMG_ABI
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#endif
