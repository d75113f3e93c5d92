// SPDX-License-Identifier: BSD-3-Clause
// Writes the collapse sequence. The hierarchy's collapses, fine to coarse, are divided into batches. Within a batch
// they run through the picture row by row, as the engine did, so that most chains of dependent collapses fit into one
// batch. A collapse that would come before another it needs waits for the next batch.
#include <algorithm>
#include <cstring>

#include "entropy/binary_coder.h"
#include "sequence/collapse_mesh.h"
#include "sequence/collapse_sequence.h"
#include "sequence/initial_mesh_code.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Share of the vertices left that a batch collapses. A third of it makes the sequence of six pictures 8 to 10 %
/// larger; with three times as much it is 6 to 8 % smaller, but the order of splits within a batch is lost, which
/// docs/internals.md weighs.
constexpr double kBatchShare = 0.03;

/// Collapses of a chunk, or a few more: a reader holds a whole chunk, here at most some megabytes.
constexpr std::size_t kChunkCollapses = 1 << 20;

struct Collapse {
    std::uint64_t key;  ///< batch, then place in it
    Index t, u;
    Point s;
    float cost;

    std::uint32_t batch() const { return std::uint32_t(key >> 32); }
};

std::uint64_t make_key(std::uint64_t batch, Index t)
{
    return batch << 32 | t;
}

/// Keys such that collapses in order of their keys give the meshes of the hierarchy.
class Scheduler {
public:
    explicit Scheduler(Index vertices) : m_written(vertices, 0), m_read(vertices, 0) { }

    std::uint64_t schedule(std::uint64_t due, Index t, Index u, const CollapseStar& star)
    {
        std::uint64_t after = std::max({ m_written[t], m_written[u], m_read[t], m_read[u] });
        for (int i = 0; i < star.degree; ++i)
            if (star.ring[i] != kGhost)
                after = std::max(after, m_written[star.ring[i]]);
        std::uint64_t key = make_key(std::max(due, after >> 32), t);
        if (key <= after)
            key = make_key((after >> 32) + 1, t);
        for (int i = 0; i < star.degree; ++i)
            if (star.ring[i] != kGhost)
                m_read[star.ring[i]] = std::max(m_read[star.ring[i]], key);
        m_written[t] = m_read[t] = key;
        return key;
    }

private:
    std::vector<std::uint64_t> m_written, m_read;
};

/// The connectivity of the finest level, one flag per quad.
std::vector<std::uint8_t> find_diagonals(const Hierarchy& h, const Mesh& finest)
{
    const int width = h.mesh_width(), height = h.mesh_height();
    std::vector<Index> number(h.mesh_pixels());
    for (Index v = 0; v < h.vertices(); ++v)
        number[h.pixels[v]] = v;
    std::vector<std::uint8_t> falling;
    for (int y = 0; y + 1 < height; ++y)
        for (int x = 0; x + 1 < width; ++x) {
            const std::size_t at = std::size_t(y) * std::size_t(width) + std::size_t(x);
            const RingView ring = finest.ring(number[at]);
            const Index below = number[at + std::size_t(width) + 1];
            falling.push_back(std::find(ring.begin(), ring.end(), below) != ring.end());
        }
    return falling;
}

/// All collapses of the mesh with their keys, in the order of the file.
Status schedule_collapses(const Hierarchy& h, CollapseMesh mesh, const std::vector<Point>& coarse,
                          std::vector<Collapse>& collapses)
{
    Scheduler scheduler(mesh.size());
    std::vector<Index> name(h.pixels);  // smallest pixel merged into each vertex
    std::uint64_t batch = 1;
    double left = double(h.vertices());
    std::size_t in_batch = 0;
    for (Level i = h.levels(); i-- > 0;) {
        const Index s = h.splits[i].s, born = h.base_vertices() + i;
        const Index t = std::min(name[s], name[born]), u = std::max(name[s], name[born]);
        CollapseStar star;
        if (!mesh.load_star(t, u, star))
            return Status::failure("hierarchy: split " + std::to_string(i) + " cannot be undone");
        if (double(in_batch) >= std::max(8.0, left * kBatchShare)) {
            left -= double(in_batch);
            in_batch = 0;
            ++batch;
        }
        ++in_batch;
        collapses.push_back({ scheduler.schedule(batch, t, u, star), t, u, coarse[i], h.costs[i] });
        mesh.collapse(star, t, u, coarse[i]);
        name[s] = t;
    }
    std::sort(collapses.begin(), collapses.end(), [](const Collapse& a, const Collapse& b) { return a.key < b.key; });
    return {};
}

/// The symbol streams of one chunk.
struct Streams {
    SymbolWriter diagonal, gap, choice, x, y;
    Bytes heads;  ///< count and cost of each batch
    Bytes start;  ///< the mesh the sequence starts from, if it is not one of every pixel; in the first chunk
    std::size_t batches = 0, collapses = 0;

    Bytes finish(std::uint32_t lattice_shift)
    {
        Bytes out;
        put_u8(out, lattice_shift);
        put_varint(out, batches);
        for (const Bytes* part : { &heads, &start }) {
            put_varint(out, part->size());
            put_bytes(out, part->data(), part->size());
        }
        for (SymbolWriter* w : { &diagonal, &gap, &choice, &x, &y }) {
            const Bytes coded = w->finish();
            put_bytes(out, coded.data(), coded.size());
        }
        heads.clear();
        start.clear();
        batches = collapses = 0;
        return out;
    }
};

class SequenceWriter {
public:
    /// Either `falling`, the diagonals of a mesh of every pixel, or the bytes of the initial mesh.
    SequenceWriter(const CollapseMesh& mesh, std::uint32_t lattice_shift, const std::vector<std::uint8_t>& falling,
                   const Bytes& initial, const std::vector<std::int32_t>& guide);
    /// False when a position has no place on the lattice.
    bool run(const std::vector<Collapse>& collapses, CollapseChunks& chunks);

private:
    bool write_batch(const Collapse* first, const Collapse* last, float cost);
    bool find_place(CollapseStar& star, const Collapse& c, Point& s) const;

    CollapseMesh m_mesh;
    std::uint32_t m_shift;
    std::vector<Index> m_alive;
    Streams m_streams;
};

bool SequenceWriter::find_place(CollapseStar& star, const Collapse& c, Point& s) const
{
    const Point e = m_mesh.extent();
    const CollapseClasses free = collapse_classes(m_mesh.vertices[c.t].at, m_mesh.vertices[c.u].at, e);
    const std::int32_t half = 1 << m_shift >> 1;
    for (std::int32_t reach = 0; reach <= 3; ++reach)
        for (std::int32_t dy = -reach; dy <= reach; ++dy)
            for (std::int32_t dx = -reach; dx <= reach; ++dx) {
                if (std::max(std::abs(dx), std::abs(dy)) != reach)
                    continue;
                s.x = free.x_free ? (((c.s.x + half) >> m_shift) + dx) * (1 << m_shift) : c.s.x;
                s.y = free.y_free ? (((c.s.y + half) >> m_shift) + dy) * (1 << m_shift) : c.s.y;
                if (m_mesh.is_place_ok(star, c.t, c.u, s))
                    return true;
            }
    return false;
}

bool SequenceWriter::write_batch(const Collapse* first, const Collapse* last, float cost)
{
    m_alive.erase(std::remove_if(m_alive.begin(), m_alive.end(), [&](Index v) { return !m_mesh.alive(v); }),
                  m_alive.end());
    const std::size_t count = std::size_t(last - first);
    const std::uint32_t density = class_of(std::uint32_t(m_alive.size() / count));
    put_varint(m_streams.heads, count);
    std::uint32_t bits;
    std::memcpy(&bits, &cost, 4);
    put_u32(m_streams.heads, bits);
    std::size_t at = 0;
    for (const Collapse* c = first; c != last; ++c) {
        std::uint32_t gap = 0;
        for (; m_alive[at] != c->t; ++at)
            ++gap;
        ++at;
        m_streams.gap.add(density, gap);
        const CollapseMesh::Candidates near = m_mesh.candidates(c->t);
        std::uint32_t choice = 0;
        if (c->u != near.nearest)
            while (m_mesh.candidate(c->t, ++choice) != c->u) { }
        m_streams.choice.add(near.symbol_class, choice);
        CollapseStar star;
        Point s;
        if (!m_mesh.load_star(c->t, c->u, star) || !find_place(star, *c, s))
            return false;
        const Point t = m_mesh.vertices[c->t].at, u = m_mesh.vertices[c->u].at, e = m_mesh.extent();
        const CollapseClasses k = collapse_classes(t, u, e);
        if (k.x_free)
            m_streams.x.add(k.x, fold((s.x >> m_shift) - (expected(t.x, u.x, e.x) >> m_shift)));
        if (k.y_free)
            m_streams.y.add(k.y, fold((s.y >> m_shift) - (expected(t.y, u.y, e.y) >> m_shift)));
        m_mesh.collapse(star, c->t, c->u, s);
    }
    ++m_streams.batches;
    m_streams.collapses += count;
    return true;
}

SequenceWriter::SequenceWriter(const CollapseMesh& mesh, std::uint32_t lattice_shift,
                               const std::vector<std::uint8_t>& falling, const Bytes& initial,
                               const std::vector<std::int32_t>& guide)
    : m_mesh(mesh),
      m_shift(lattice_shift)
{
    const int width = mesh.extent().x / kSubpixels + 1;
    for (std::size_t quad = 0; quad < falling.size(); ++quad) {
        const std::size_t x = quad % std::size_t(width - 1), y = quad / std::size_t(width - 1);
        const DiagonalGuess guess = guess_diagonal(&guide[y * std::size_t(width) + x], width);
        m_streams.diagonal.add(guess.symbol_class, falling[quad] != (guess.falling ? 1 : 0));
    }
    m_streams.start = initial;
    for (Index v = 0; v < m_mesh.size(); ++v)
        if (m_mesh.alive(v))
            m_alive.push_back(v);
}

bool SequenceWriter::run(const std::vector<Collapse>& collapses, CollapseChunks& chunks)
{
    chunks.chunks.clear();
    float cost = 0.0f;
    for (std::size_t i = 0; i < collapses.size();) {
        std::size_t end = i;
        for (; end < collapses.size() && collapses[end].batch() == collapses[i].batch(); ++end)
            cost = std::max(cost, collapses[end].cost);
        if (!write_batch(&collapses[i], &collapses[0] + end, cost))
            return false;
        i = end;
        if (m_streams.collapses >= kChunkCollapses)
            chunks.chunks.push_back(m_streams.finish(m_shift));
    }
    if (m_streams.batches > 0 || chunks.chunks.empty())
        chunks.chunks.push_back(m_streams.finish(m_shift));
    return true;
}

}  // namespace

Status write_collapse_sequence(const Hierarchy& h, const PictureDesc& desc,
                               const std::vector<ConstStridedChannel>& samples, std::uint32_t lattice_shift,
                               CollapseChunks& chunks)
{
    Mesh finest;
    std::vector<Point> coarse;
    Status status = refine(h, h.levels(), finest, &coarse);
    if (!status)
        return status;
    const std::vector<std::int32_t> guide = diagonal_guide(desc, samples);
    CollapseMesh mesh(h.mesh_width(), h.mesh_height());
    std::vector<std::uint8_t> falling;
    Bytes initial;
    if (h.vertices() == h.mesh_pixels()) {
        falling = find_diagonals(h, finest);
        mesh.connect(falling);
    } else
        initial = write_initial_mesh(h, finest, guide, mesh);
    std::vector<Collapse> collapses;
    status = schedule_collapses(h, mesh, coarse, collapses);
    if (!status)
        return status;
    for (std::uint32_t shift = lattice_shift;; --shift) {
        SequenceWriter writer(mesh, shift, falling, initial, guide);
        if (writer.run(collapses, chunks))
            return {};
        if (shift == 0)
            return Status::failure("pimg: the hierarchy could not be written");
    }
}

}  // namespace PIMG_ABI
}  // namespace pimg
