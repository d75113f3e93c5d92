// SPDX-License-Identifier: BSD-3-Clause
// Turns the first splits of a hierarchy into batches. Three steps: order (which splits go into which batch), geometry
// (positions moved onto the file's coarser lattice where the mesh allows it), coding.
#include <algorithm>
#include <cmath>

#include "mesh_layer/mesh_layer.h"
#include "mesh_layer/mesh_layer_code.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Growth of the number of vertices from batch to batch. Twice the growth makes files of six pictures 0.0 to 1.2 % smaller
/// in this layer, half of it 1.5 to 2.3 % larger; in large batches vertices are split that matter less than later ones.
constexpr double kBatchGrowth = 1.12;

/// The same from chunk to chunk. A file that ends early shows the chunks that are complete: 8 to 11 steps. Twice as many
/// (1.3) take 0.5 to 1.1 % more bytes of this layer, half as many (4) save 0.4 to 0.9 %.
constexpr double kChunkGrowth = 1.6;

/// The splits in file order.
struct BatchOrder {
    std::vector<Level> splits;           ///< splits of the hierarchy
    std::vector<std::size_t> batch_end;  ///< in `splits`
};

/// For each split, the earlier ones that must come first: those that wrote a vertex of its star, and those whose star
/// held the vertex it splits.
Status find_dependencies(const Hierarchy& h, Level count, std::vector<std::vector<Level>>& needs)
{
    Mesh mesh;
    const Status status = refine(h, 0, mesh);
    if (!status)
        return status;
    constexpr Level kNone = 0xffffffffu;
    std::vector<Level> writer(h.base_vertices() + count, kNone);
    std::vector<std::vector<Level>> readers(writer.size());
    needs.assign(count, {});
    for (Level i = 0; i < count; ++i) {
        const Split& split = h.splits[i];
        const RingView ring = mesh.ring(split.s);
        std::vector<Level>& need = needs[i];
        need = readers[split.s];
        if (writer[split.s] != kNone)
            need.push_back(writer[split.s]);
        for (Index q : ring)
            if (q != kGhost) {
                if (writer[q] != kNone)
                    need.push_back(writer[q]);
                readers[q].push_back(i);
            }
        const Index u = mesh.size();
        if (!mesh.split(split.s, split.vl, split.vr, split.t, split.u))
            return Status::failure("hierarchy: split " + std::to_string(i) + " does not fit the mesh");
        writer[split.s] = writer[u] = i;
        readers[split.s].clear();
    }
    return {};
}

/// Fills batches with what is due; a split that needs one still to come in its own batch waits for the next.
BatchOrder order_splits(const Hierarchy& h, Level count, const std::vector<std::vector<Level>>& needs)
{
    constexpr Index kUnknown = 0xffffffffu;
    BatchOrder order;
    std::vector<Index> number(h.base_vertices() + count, kUnknown);  // in the file
    std::vector<std::uint32_t> batch_of(count, 0);                   // 0: still to come
    for (Index v = 0; v < h.base_vertices(); ++v)
        number[v] = v;
    std::vector<Level> waiting;
    Level due = 0;
    for (std::uint32_t batch = 1; order.splits.size() < count; ++batch) {
        const std::size_t vertices = h.base_vertices() + order.splits.size();
        const auto goal = std::size_t(std::ceil(double(vertices) * kBatchGrowth)) - h.base_vertices();
        for (; due < count && due < goal; ++due)
            waiting.push_back(due);
        std::vector<Level> now, later;
        for (Level i : waiting) {
            const Index s = number[h.splits[i].s];
            bool ready = s != kUnknown;
            for (Level need : needs[i])
                ready = ready && batch_of[need] != 0 && (batch_of[need] < batch || number[h.splits[need].s] < s);
            (ready ? now : later).push_back(i);
            if (ready)
                batch_of[i] = batch;
        }
        if (now.size() * kSparsestBatch < vertices)
            break;  // what is left is not worth a batch
        std::sort(now.begin(), now.end(),
                  [&](Level a, Level b) { return number[h.splits[a].s] < number[h.splits[b].s]; });
        for (Level i : now) {
            number[h.base_vertices() + i] = Index(h.base_vertices() + order.splits.size());
            order.splits.push_back(i);
        }
        order.batch_end.push_back(order.splits.size());
        waiting.swap(later);
    }
    return order;
}

/// Renumbers the splits of the file and moves their positions onto the lattice.
class GeometryPlan {
public:
    GeometryPlan(const Hierarchy& h, const BatchOrder& order) : m_hierarchy(h), m_order(order) { }

    /// False when some split has no place on the lattice; the plan then ends with the batch before it.
    bool make(std::uint32_t lattice_shift);
    std::vector<LayerSplit> splits;
    std::vector<std::size_t> batch_end;

private:
    bool place(const Mesh& mesh, const CanonicalRing& ring, std::uint32_t shift, const Split& exact, LayerSplit& split);

    const Hierarchy& m_hierarchy;
    const BatchOrder& m_order;
};

bool GeometryPlan::place(const Mesh& mesh, const CanonicalRing& ring, std::uint32_t shift, const Split& exact,
                         LayerSplit& split)
{
    const auto snapped = [&](Point p, int dx, int dy) {
        return Point { (in_steps(p.x, shift) + dx) * (1 << shift), (in_steps(p.y, shift) + dy) * (1 << shift) };
    };
    // Nearest points first, then one step aside for either end.
    constexpr int kNear[9][2] = { { 0, 0 }, { 1, 0 },  { -1, 0 }, { 0, 1 },  { 0, -1 },
                                  { 1, 1 }, { -1, 1 }, { 1, -1 }, { -1, -1 } };
    for (int sum = 0; sum <= 16; ++sum)
        for (int i = std::max(0, sum - 8); i <= std::min(sum, 8); ++i) {
            split.t = snapped(exact.t, kNear[i][0], kNear[i][1]);
            split.u = snapped(exact.u, kNear[sum - i][0], kNear[sum - i][1]);
            const Point e = mesh.extent();
            const auto inside = [&](Point p) {
                return p.x >= 0 && p.y >= 0 && p.x <= e.x && p.y <= e.y;
            };
            if (inside(split.t) && inside(split.u) && is_split_ok(mesh, ring, split))
                return true;
        }
    return false;
}

bool GeometryPlan::make(std::uint32_t lattice_shift)
{
    splits.clear();
    batch_end.clear();
    Mesh mesh;
    if (!refine(m_hierarchy, 0, mesh))
        return false;
    const Index base = m_hierarchy.base_vertices();
    std::vector<Index> number(base + m_hierarchy.levels(), kGhost);
    for (Index v = 0; v < base; ++v)
        number[v] = v;
    const auto renumber = [&](Index v) {
        return v == kGhost ? kGhost : number[v];
    };
    for (std::size_t i = 0; i < m_order.splits.size(); ++i) {
        const Split& exact = m_hierarchy.splits[m_order.splits[i]];
        LayerSplit split;
        split.s = number[exact.s];
        const CanonicalRing ring(mesh, split.s);
        split.vr = int(std::find(ring.vertex, ring.vertex + ring.degree, renumber(exact.vr)) - ring.vertex);
        split.vl = int(std::find(ring.vertex, ring.vertex + ring.degree, renumber(exact.vl)) - ring.vertex);
        if (split.vr == ring.degree || split.vl == ring.degree || !place(mesh, ring, lattice_shift, exact, split)
            || !mesh.split(split.s, renumber(exact.vl), renumber(exact.vr), split.t, split.u)) {
            splits.resize(batch_end.empty() ? 0 : batch_end.back());
            return false;
        }
        number[base + m_order.splits[i]] = base + Index(i);
        splits.push_back(split);
        if (i + 1 == m_order.batch_end[batch_end.size()])
            batch_end.push_back(i + 1);
    }
    return true;
}

/// Values of t and u of each split and channel, as the hierarchy has them.
std::vector<float> split_values(const Hierarchy& h, const std::vector<Bands>& bands, Level count)
{
    std::vector<float> targets(std::size_t(count) * 2 * bands.size());
    for (std::size_t c = 0; c < bands.size(); ++c) {
        std::vector<float> z(h.base_vertices() + count);
        std::copy(bands[c].base.begin(), bands[c].base.end(), z.begin());
        for (Level i = 0; i < count; ++i) {
            const Stencil& k = h.stencils[i];
            const Detail d = bands[c].details[i];
            const SplitPair predicted = predict(k, z.data());
            const float t = predicted.t + d.t, u = predicted.u + d.u;
            z[k.s] = t;
            z[h.base_vertices() + i] = u;
            float* to = &targets[(std::size_t(i) * bands.size() + c) * 2];
            to[0] = std::clamp(t, float(kMeshValueLow), float(kMeshValueHigh));
            to[1] = std::clamp(u, float(kMeshValueLow), float(kMeshValueHigh));
        }
    }
    return targets;
}

Bytes write_base(const MeshLayerHead& head, const MeshLayer& layer)
{
    Bytes out;
    put_u8(out, head.lattice_shift);
    for (std::uint32_t shift : head.value_shifts)
        put_u8(out, shift);
    const std::vector<Triangle> triangles = ordered_triangles(layer.mesh);
    put_varint(out, layer.mesh.size());
    put_varint(out, triangles.size());
    BinaryWriter stream;
    LayerOutput io { stream };
    NumberModel x, y, first, second, third;
    Point last;
    for (Index v = 0; v < layer.mesh.size(); ++v) {
        const Point p = layer.mesh.point(v);
        signed_number(io, x, p.x - last.x);
        signed_number(io, y, p.y - last.y);
        last = p;
    }
    Index v = 0;
    for (const Triangle& t : triangles) {
        first.write(stream, t[0] - v);
        v = t[0];
        second.write(stream, t[1] - v);
        third.write(stream, t[2] - v);
    }
    for (const std::vector<std::int32_t>& z : layer.values) {
        NumberModel value;
        std::int32_t before = 0;
        for (std::int32_t at : z) {
            signed_number(io, value, at - before);
            before = at;
        }
    }
    const Bytes coded = stream.finish();
    put_bytes(out, coded.data(), coded.size());
    return out;
}

/// Codes the batches of a plan, several to a chunk.
class BatchWriter {
public:
    BatchWriter(const MeshLayerHead& head, MeshLayer& layer)
        : m_head(head),
          m_layer(layer),
          m_models(layer.values.size()),
          m_touched(layer.mesh.size(), 0)
    {
    }
    /// Batches [first, last) of the plan as one chunk.
    bool write(const GeometryPlan& plan, const BatchOrder& order, const std::vector<float>& targets, std::size_t first,
               std::size_t last, Bytes& chunk);

private:
    bool write_batch(BinaryWriter& stream, const GeometryPlan& plan, const BatchOrder& order,
                     const std::vector<float>& targets, std::size_t begin, std::size_t end);

    const MeshLayerHead& m_head;
    MeshLayer& m_layer;
    MeshModels m_models;
    std::vector<std::uint32_t> m_touched;
    std::uint32_t m_batch = 0;
};

bool BatchWriter::write_batch(BinaryWriter& stream, const GeometryPlan& plan, const BatchOrder& order,
                              const std::vector<float>& targets, std::size_t begin, std::size_t end)
{
    LayerOutput io { stream };
    ++m_batch;
    const Index vertices = m_layer.mesh.size();
    std::size_t next = begin;
    for (Index v = 0; v < vertices; ++v) {
        const CanonicalRing ring(m_layer.mesh, v);
        const bool touched = m_touched[v] + 1 >= m_batch && m_batch > 1;
        const bool split = next < end && plan.splits[next].s == v;
        stream.bit(flag_model(m_models, m_head, ring, m_layer.mesh.point(v), touched), split);
        if (!split)
            continue;
        LayerSplit fields = plan.splits[next];
        if (!code_geometry(io, m_models, m_head, m_layer.mesh, ring, fields))
            return false;
        code_values(io, m_models, m_head, m_layer, ring, fields,
                    &targets[order.splits[next] * 2 * m_layer.values.size()]);
        if (!apply_split(m_layer.mesh, ring, fields, m_batch, m_touched))
            return false;
        ++next;
    }
    return next == end;
}

bool BatchWriter::write(const GeometryPlan& plan, const BatchOrder& order, const std::vector<float>& targets,
                        std::size_t first, std::size_t last, Bytes& chunk)
{
    BinaryWriter stream;
    put_varint(chunk, m_layer.mesh.size());
    for (std::size_t b = first; b < last; ++b)
        if (!write_batch(stream, plan, order, targets, b > 0 ? plan.batch_end[b - 1] : 0, plan.batch_end[b]))
            return false;
    put_varint(chunk, m_layer.mesh.size());
    put_varint(chunk, last - first);
    const Bytes coded = stream.finish();
    put_bytes(chunk, coded.data(), coded.size());
    return true;
}

/// Steps in which a channel's details are coded: about 1/128 of its range in the base mesh.
std::uint32_t value_shift(const Bands& bands)
{
    const auto [low, high] = std::minmax_element(bands.base.begin(), bands.base.end());
    const std::uint32_t range = std::uint32_t(std::min(double(*high) - double(*low), 262143.0));
    return std::uint32_t(std::max(0, bit_length(range) - 7));
}

}  // namespace

Status write_mesh_layer(const Hierarchy& h, const std::vector<Bands>& bands, double vertices, MeshLayerChunks& chunks)
{
    const Level count = h.level_of_vertices(vertices);
    MeshLayerHead head;
    Status status = refine(h, 0, chunks.layer.mesh);
    if (!status)
        return status;
    for (const Bands& b : bands) {
        head.value_shifts.push_back(value_shift(b));
        std::vector<std::int32_t> z;
        for (float v : b.base)
            z.push_back(std::int32_t(std::lround(std::clamp(v, float(kMeshValueLow), float(kMeshValueHigh)))));
        chunks.layer.values.push_back(std::move(z));
    }
    std::vector<std::vector<Level>> needs;
    status = find_dependencies(h, count, needs);
    if (!status)
        return status;
    const BatchOrder order = order_splits(h, count, needs);
    GeometryPlan plan(h, order);
    for (head.lattice_shift = 4; !plan.make(head.lattice_shift) && head.lattice_shift > 0;)
        --head.lattice_shift;

    chunks.base = write_base(head, chunks.layer);
    BatchWriter writer(head, chunks.layer);
    const std::vector<float> targets = split_values(h, bands, count);
    for (std::size_t first = 0; first < plan.batch_end.size();) {
        const double goal = double(chunks.layer.mesh.size()) * kChunkGrowth - double(h.base_vertices());
        std::size_t last = first + 1;
        while (last < plan.batch_end.size() && double(plan.batch_end[last]) <= goal)
            ++last;
        chunks.batches.emplace_back();
        if (!writer.write(plan, order, targets, first, last, chunks.batches.back()))
            return Status::failure("pimg: the mesh layer could not be written");
        first = last;
    }
    return {};
}

}  // namespace PIMG_ABI
}  // namespace pimg
