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

/// Floats 4 part .. 4 part + 3 of the nodes of lanes j ..., a vector for each.
template<class D>
HWY_INLINE void load_columns(D d, const Neighbours& from, int j, int part, hn::Vec<D> (&column)[4])
{
    const Four f;
    for (int k = 0; k < 4; ++k) {
        const V4 low = hn::Load(f, &from.node[j + k]->sums.xx + 4 * part);
        if constexpr (hn::MaxLanes(D()) == 8)
            column[k] = hn::Combine(d, hn::Load(f, &from.node[j + k + 4]->sums.xx + 4 * part), low);
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

/// Places of lanes j ... relative to `centre`, in lattice units, and their corners in pixels and guide units. Also
/// gives the column of Nz, which lies beside them.
HWY_INLINE hn::Vec<Lanes> load_corners(const Neighbours& from, const Index* ring, const Node& centre, int j, Corners& c,
                                       hn::Vec<Integers>& px, hn::Vec<Integers>& py)
{
    const Lanes d;
    const Integers i;
    hn::Vec<Lanes> column[4];
    load_columns(d, from, j, 2, column);
    const auto real = hn::IfThenElseZero(real_lanes(ring, j), hn::Set(d, 1.0f));
    const auto pixel = hn::Set(d, kPixel);
    px = hn::BitCast(i, column[2]) - hn::Set(i, centre.p.x);
    py = hn::BitCast(i, column[3]) - hn::Set(i, centre.p.y);
    hn::Store(real, d, c.real + j);
    hn::Store(real * (column[1] - hn::Set(d, centre.z)), d, c.z + j);
    hn::Store(real * (hn::ConvertTo(d, px) * pixel), d, c.x + j);
    hn::Store(real * (hn::ConvertTo(d, py) * pixel), d, c.y + j);
    return column[0];
}

/// What the last quarter of a node says about lanes j ...
struct Membership {
    hn::Vec<Integers> flags;     ///< degree, side << 8
    hn::Mask<Integers> outside;  ///< the zone; never a ghost
};

HWY_INLINE Membership load_membership(const Neighbours& from, const Index* ring, const Zone& zone, int j)
{
    const Lanes d;
    const Integers i;
    const hn::RebindToUnsigned<Integers> u;
    hn::Vec<Lanes> column[4];
    load_columns(d, from, j, 3, column);
    const auto home = hn::BitCast(i, column[2]);
    const auto x = hn::And(home, hn::Set(i, 0xffff));
    const auto y = hn::BitCast(i, hn::ShiftRight<16>(hn::BitCast(u, home)));
    const auto low = hn::Or(hn::Lt(x, hn::Set(i, zone.x0)), hn::Lt(y, hn::Set(i, zone.y0)));
    const auto high = hn::Or(hn::Gt(x, hn::Set(i, zone.x1 - 1)), hn::Gt(y, hn::Set(i, zone.y1 - 1)));
    return { hn::BitCast(i, column[3]), hn::And(hn::RebindMask(i, real_lanes(ring, j)), hn::Or(low, high)) };
}

/// The part of load_corners() that guide channels after the first need.
HWY_INLINE void load_more_channels(const WorkingMesh& mesh, Index v, EdgeFan& fan)
{
    const ChannelSums none {};
    for (int c = 0; c < fan.more_channels; ++c) {
        ChannelFan& m = fan.more[c];
        m.sums.value = mesh.more_of(v)[c].value;
        for (int j = 0; j < fan.lanes; ++j) {
            const Index q = mesh.rings[v].v[std::size_t(j)];
            const ChannelSums& s = q < kNoVertex ? mesh.more_of(q)[c] : none;
            m.z[j] = q < kNoVertex ? s.value - m.sums.value : 0.0f;
            m.a[0][j] = s.xx;
            m.a[1][j] = s.xy;
            m.a[2][j] = s.yy;
            m.a[3][j] = s.xz;
            m.a[4][j] = s.yz;
            m.n[0][j] = s.x;
            m.n[1][j] = s.y;
        }
        m.z[fan.lanes] = 0.0f;
        m.z[fan.degree] = m.z[0];
    }
}

/// Gathers the places of v's neighbours; false when one is outside the zone.
HWY_INLINE bool load_corners(const WorkingMesh& mesh, Index v, const Neighbours& from, const Zone& zone, EdgeFan& fan)
{
    const Lanes d;
    const Integers i;
    const Node& node = mesh.nodes[v];
    const Index* ring = mesh.rings[v].v.data();
    const auto one = hn::Set(d, 1.0f);
    fan.degree = node.degree;
    fan.lanes = lanes_for(node.degree);
    fan.side = node.side;
    auto outside = hn::Zero(i), sides = hn::Set(i, node.side << 8);
    for (int j = 0; j < fan.lanes; j += int(hn::Lanes(d))) {
        hn::Vec<Integers> px, py;
        hn::Store(load_corners(from, ring, node, j, fan.corners, px, py), d, fan.n[2] + j);
        const Membership m = load_membership(from, ring, zone, j);
        outside = hn::Or(outside, hn::VecFromMask(i, m.outside));
        sides = hn::Or(sides, m.flags);
        const auto fixed = [&](int side) {
            return hn::RebindMask(d, hn::Ne(hn::And(m.flags, hn::Set(i, side << 8)), hn::Zero(i)));
        };
        hn::Store(hn::IfThenElseZero(fixed(kFixedX), one), d, fan.fixed_x + j);
        hn::Store(hn::IfThenElseZero(fixed(kFixedY), one), d, fan.fixed_y + j);
    }
    close(fan.corners, fan.degree, fan.lanes);
    fan.on_border = !hn::AllTrue(i, hn::Eq(hn::And(sides, hn::Set(i, kCorner << 8)), hn::Zero(i)));
    if (fan.more_channels > 0)
        load_more_channels(mesh, v, fan);
    return hn::AllTrue(i, hn::Eq(outside, hn::Zero(i)));
}

/// The sums of the neighbours.
HWY_INLINE void load_sums(const Neighbours& from, EdgeFan& fan)
{
    const Lanes d;
    for (int j = 0; j < fan.lanes; j += int(hn::Lanes(d))) {
        hn::Vec<Lanes> column[4];
        load_columns(d, from, j, 0, column);
        for (int k = 0; k < 4; ++k)
            hn::Store(column[k], d, fan.a[k] + j);
        load_columns(d, from, j, 1, column);
        hn::Store(column[0], d, fan.a[4] + j);
        hn::Store(column[1], d, fan.a[5] + j);
        hn::Store(column[2], d, fan.n[0] + j);
        hn::Store(column[3], d, fan.n[1] + j);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#endif
