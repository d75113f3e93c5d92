// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_layer/mesh_layer.h"

#include <algorithm>

#include "mesh_layer/mesh_layer_code.h"
#include <pimg/detail/projection.h>

namespace pimg {
inline namespace PIMG_ABI {

CanonicalRing::CanonicalRing(const Mesh& mesh, Index s)
{
    const RingView ring = mesh.ring(s);
    degree = ring.degree;
    const int first = int(std::min_element(ring.begin(), ring.end()) - ring.begin());
    for (int k = 0; k < degree; ++k) {
        const int j = first + k < degree ? first + k : first + k - degree;
        vertex[k] = ring[j];
        point[k] = ring[j] == kGhost ? Point {} : mesh.point(ring[j]);
    }
}

bool CanonicalRing::has_ghost() const
{
    return std::find(vertex, vertex + degree, kGhost) != vertex + degree;
}

std::uint32_t CanonicalRing::radius(Point p) const
{
    std::int32_t r = 0;
    for (int k = 0; k < degree; ++k)
        if (vertex[k] != kGhost)
            r = std::max({ r, std::abs(point[k].x - p.x), std::abs(point[k].y - p.y) });
    return std::uint32_t(r);
}

namespace {

/// Whether a and b lie on a common side of the picture.
bool on_a_side(Point a, Point b, Point extent)
{
    return (a.x == b.x && (a.x == 0 || a.x == extent.x)) || (a.y == b.y && (a.y == 0 || a.y == extent.y));
}

/// The fan around `p` over ring places [from, from + count] and then `other`, closed: positive triangles; next to the
/// ghost, edges on the sides; without a ghost, no side touched.
bool is_fan_ok(const CanonicalRing& ring, int from, int count, Point p, Point other, Point extent)
{
    const auto place = [&](int k) {
        return (from + k) % ring.degree;
    };
    bool ghost = false;
    for (int k = 0; k <= count + 1; ++k) {
        const bool a_is_other = k == count + 1, b_is_other = k == count;
        const int ia = place(a_is_other ? 0 : k), ib = place(a_is_other ? 0 : k + 1);
        const bool a_ghost = !a_is_other && ring.vertex[ia] == kGhost;
        const bool b_ghost = !b_is_other && ring.vertex[ib] == kGhost;
        const Point a = a_is_other ? other : ring.point[ia], b = b_is_other ? other : ring.point[ib];
        ghost |= a_ghost;
        if (a_ghost && b_ghost)
            return false;
        if (a_ghost || b_ghost) {
            if (!on_a_side(p, a_ghost ? b : a, extent))
                return false;
        } else if (doubled_area(p, a, b) <= 0)
            return false;
    }
    return ghost || (p.x > 0 && p.y > 0 && p.x < extent.x && p.y < extent.y);
}

}  // namespace

bool is_split_ok(const Mesh& mesh, const CanonicalRing& ring, const LayerSplit& split)
{
    const Point extent = mesh.extent(), s = mesh.point(split.s);
    const int right_to_left = (split.vl - split.vr + ring.degree) % ring.degree;
    const int left_to_right = ring.degree - right_to_left;
    // A corner of the picture stays where it is.
    if ((s.x == 0 || s.x == extent.x) && (s.y == 0 || s.y == extent.y) && split.t != s && split.u != s)
        return false;
    return is_fan_ok(ring, split.vr, right_to_left, split.t, split.u, extent)
        && is_fan_ok(ring, split.vl, left_to_right, split.u, split.t, extent);
}

bool apply_split(Mesh& mesh, const CanonicalRing& ring, const LayerSplit& split, std::uint32_t batch,
                 std::vector<std::uint32_t>& touched)
{
    if (!mesh.split(split.s, ring.vertex[split.vl], ring.vertex[split.vr], split.t, split.u))
        return false;
    for (int k = 0; k < ring.degree; ++k)
        if (ring.vertex[k] != kGhost)
            touched[ring.vertex[k]] = batch;
    touched[split.s] = batch;
    touched.push_back(batch);
    return true;
}

IntegerStencil integer_stencil(Point p, Point s, const CanonicalRing& ring, int start)
{
    const StarFace face =
        face_that_holds(ring.degree, ring.vertex, start, [&](int i) { return doubled_area(s, ring.point[i], p); });
    if (!face.holds)
        return { kGhost, kGhost, 0, 0 };
    std::int64_t a = face.area_a, b = face.area_b, area = doubled_area(s, ring.point[face.a], ring.point[face.b]);
    for (; area >= std::int64_t(1) << 46; area >>= 1) {
        a >>= 1;
        b >>= 1;
    }
    return { ring.vertex[face.a], ring.vertex[face.b], std::min<std::int64_t>(65536, a * 65536 / area),
             std::min<std::int64_t>(65536, b * 65536 / area) };
}

std::int32_t IntegerStencil::predict(const std::vector<std::int32_t>& z, Index s) const
{
    if (a == kGhost)
        return z[s];
    const std::int64_t at_s = z[s];
    return std::int32_t(at_s + ((wa * (z[a] - at_s) + wb * (z[b] - at_s)) >> 16));
}

AdaptiveBit& flag_model(MeshModels& models, const MeshLayerHead& head, const CanonicalRing& ring, Point p, bool touched)
{
    const int size = std::min(31, bit_length(ring.radius(p) >> head.lattice_shift));
    return models.flag[size * 2 + int(touched)];
}

/// The values of one channel at the base mesh's vertices; false if one is out of range or the data end early.
static bool read_values(BinaryReader& in, std::uint64_t count, std::vector<std::int32_t>& values)
{
    LayerInput io { in };
    NumberModel model;
    std::int64_t last = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        last += signed_number(io, model, 0);
        if (last < kMeshValueLow || last > kMeshValueHigh || in.overrun())
            return false;
        values.push_back(std::int32_t(last));
    }
    return true;
}

Status MeshLayerReader::read_base(const std::uint8_t* data, std::size_t size)
{
    const auto bad = [] {
        return Status::failure("pimg: the base mesh is damaged");
    };
    ByteReader bytes(data, size);
    m_head.lattice_shift = bytes.u8();
    if (m_head.lattice_shift > 6)
        return bad();
    for (std::size_t c = 0; c < m_layer.values.size(); ++c) {
        m_head.value_shifts.push_back(bytes.u8());
        if (m_head.value_shifts.back() > 17)
            return bad();
    }
    const std::uint64_t points = bytes.varint(), count = bytes.varint();
    if (!bytes.ok() || points < 4 || points > std::min<std::uint64_t>(65536, m_max_vertices) || count > 2 * points)
        return bad();
    BinaryReader in(bytes.here(), bytes.left());
    LayerInput io { in };
    NumberModel x, y, first, second, third;
    std::vector<Point> positions;
    Point p;
    for (std::uint64_t i = 0; i < points; ++i) {
        const std::int64_t px = std::int64_t(p.x) + signed_number(io, x, 0);
        const std::int64_t py = std::int64_t(p.y) + signed_number(io, y, 0);
        if (px < 0 || py < 0 || px > m_extent.x || py > m_extent.y || in.overrun())
            return bad();
        p = { std::int32_t(px), std::int32_t(py) };
        positions.push_back(p);
    }
    std::vector<Triangle> triangles;
    Index v = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        v += first.read(in);
        triangles.push_back({ v, v + second.read(in), v + third.read(in) });
        if (in.overrun())
            return bad();
    }
    Status status = Mesh::from_triangles(std::move(positions), triangles, m_extent, m_layer.mesh);
    if (!status)
        return status;
    for (std::vector<std::int32_t>& z : m_layer.values)
        if (!read_values(in, points, z))
            return bad();
    m_touched.assign(std::size_t(points), 0);
    return {};
}

bool MeshLayerReader::read_split(BinaryReader& in, Index s)
{
    LayerInput io { in };
    const CanonicalRing ring(m_layer.mesh, s);
    LayerSplit split;
    split.s = s;
    if (!code_geometry(io, m_models, m_head, m_layer.mesh, ring, split) || !is_split_ok(m_layer.mesh, ring, split))
        return false;
    code_values(io, m_models, m_head, m_layer, ring, split, nullptr);
    return !in.overrun() && apply_split(m_layer.mesh, ring, split, m_batch, m_touched);
}

Status MeshLayerReader::read_batches(const std::uint8_t* data, std::size_t size)
{
    ByteReader bytes(data, size);
    const std::uint64_t before = bytes.varint(), after = bytes.varint(), batches = bytes.varint();
    if (!bytes.ok() || before != m_layer.mesh.size() || after < before || after > m_max_vertices
        || batches > bytes.left())
        return Status::failure("pimg: a batch of splits does not continue the mesh");
    BinaryReader in(bytes.here(), bytes.left());
    for (std::uint64_t b = 0; b < batches; ++b) {
        ++m_batch;
        const Index vertices = m_layer.mesh.size();
        for (Index v = 0; v < vertices; ++v) {
            const CanonicalRing ring(m_layer.mesh, v);
            const bool touched = m_touched[v] + 1 >= m_batch && m_batch > 1;
            if (!in.bit(flag_model(m_models, m_head, ring, m_layer.mesh.point(v), touched)))
                continue;
            if (m_layer.mesh.size() >= after || !read_split(in, v))
                return Status::failure("pimg: a split does not fit the mesh");
        }
        if ((m_layer.mesh.size() - vertices) * std::uint64_t(kSparsestBatch) < vertices)
            return Status::failure("pimg: a batch of splits has too few of them");
    }
    if (m_layer.mesh.size() != after || in.overrun())
        return Status::failure("pimg: a batch of splits is damaged");
    return {};
}

}  // namespace PIMG_ABI
}  // namespace pimg
