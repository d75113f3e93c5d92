// SPDX-License-Identifier: BSD-3-Clause
// Repeats the collapse sequence: every collapse gives a split of the hierarchy and, from the same star, the coarse
// value of every channel (the volume under the surface stays, see analyse()).
#include <algorithm>
#include <cmath>
#include <cstring>

#include <pimg/detail/analyse.h>
#include <pimg/detail/projection.h>

#include "entropy/binary_coder.h"
#include "sequence/collapse_mesh.h"
#include "sequence/collapse_sequence.h"
#include "sequence/initial_mesh_code.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Shares of the star's vertices in the value of s.
struct VolumeShares {
    float ring[kMaxDegree], u;
};

void volume_shares(const CollapseStar& star, Point t, Point u, VolumeShares& shares)
{
    std::int64_t share[kMaxDegree];
    std::fill_n(share, star.degree, 0);
    std::int64_t whole = 0, of_u = 0;
    for (int i = 0; i < star.degree; ++i) {
        const int next = i + 1 < star.degree ? i + 1 : 0;
        if (star.ring[i] == kGhost || star.ring[next] == kGhost)
            continue;
        const bool with_u = i >= star.vl;
        const std::int64_t before = doubled_area(with_u ? u : t, star.points[i], star.points[next]);
        const std::int64_t lost = before - star.areas[i];
        whole += star.areas[i];
        of_u += with_u ? before : 0;
        share[i] += lost;
        share[next] += lost;
    }
    for (int i : { 0, star.vl }) {
        if (star.ring[i] == kGhost)
            continue;
        const std::int64_t gone = std::abs(doubled_area(t, u, star.points[i]));
        of_u += gone;
        share[i] += gone;
    }
    const double scale = whole > 0 ? 1.0 / double(whole) : 0.0;
    for (int i = 0; i < star.degree; ++i)
        shares.ring[i] = float(double(share[i]) * scale);
    shares.u = float(double(of_u) * scale);
}

/// As project(), for a star whose faces' areas are known already.
Projection project_onto(const CollapseStar& star, Point s, Point p)
{
    const std::int64_t px = p.x - s.x, py = p.y - s.y;
    const StarFace face = face_that_holds(star.degree, star.ring, 0, [&](int i) {
        return (star.points[i].x - s.x) * py - (star.points[i].y - s.y) * px;
    });
    if (face.a < 0)
        return { kGhost, kGhost, 0.0f, 0.0f };
    return projection(face, star.ring, star.areas[face.a]);
}

/// The vertices that are not merged yet, as bits.
class AliveSet {
public:
    void assign(const CollapseMesh& mesh)
    {
        m_words.assign((std::size_t(mesh.size()) + 63) / 64, 0);
        m_count = 0;
        for (Index v = 0; v < mesh.size(); ++v)
            if (mesh.alive(v)) {
                m_words[v / 64] |= std::uint64_t(1) << v % 64;
                ++m_count;
            }
    }
    void remove(Index v)
    {
        m_words[v / 64] &= ~(std::uint64_t(1) << v % 64);
        --m_count;
    }
    std::size_t count() const { return m_count; }

    /// Walks through them in order.
    class Walk {
    public:
        explicit Walk(const AliveSet& set) : m_words(set.m_words), m_rest(set.m_words.empty() ? 0 : set.m_words[0]) { }
        /// Leaves out `gap` of them and returns the next; kGhost at the end.
        Index next(std::uint32_t gap)
        {
            for (std::uint32_t here; (here = std::uint32_t(__builtin_popcountll(m_rest))) <= gap; gap -= here) {
                if (++m_word >= m_words.size())
                    return kGhost;
                m_rest = m_words[m_word];
            }
            for (; gap > 0; --gap)
                m_rest &= m_rest - 1;
            const Index v = Index(m_word * 64) + Index(__builtin_ctzll(m_rest));
            m_rest &= m_rest - 1;
            return v;
        }

    private:
        const std::vector<std::uint64_t>& m_words;
        std::size_t m_word = 0;
        std::uint64_t m_rest;
    };

private:
    std::vector<std::uint64_t> m_words;
    std::size_t m_count = 0;
};

/// Words of vertices that batches may walk through, per pixel and for any picture (docs/format.md, section 7). Written
/// sequences took at most 0.77 per pixel: 23 pictures, among them noise, ramps, one colour and strips.
constexpr std::uint64_t kWalksPerPixel = 16, kFewWalks = 1 << 20;

class SequenceReader {
public:
    SequenceReader(int width, int height, const std::vector<const float*>& channels)
        : m_mesh(std::max(width, 2), std::max(height, 2)),
          m_channels(channels)
    {
        m_h.width = width;
        m_h.height = height;
    }
    Status run(const std::vector<ByteSpan>& chunks, const std::vector<std::int32_t>& guide, Hierarchy& h,
               std::vector<Bands>& bands);

private:
    Status read_chunk(ByteSpan chunk, const std::vector<std::int32_t>& guide, bool first);
    bool read_start(const std::uint8_t* initial, std::size_t size, SymbolReader& diagonals,
                    const std::vector<std::int32_t>& guide);
    void read_diagonals(SymbolReader& in, const std::vector<std::int32_t>& guide);
    void keep_alive();
    bool read_batch(ByteReader& heads);
    bool read_collapse(Index t);
    void analyse_collapse(Index t, Index u);
    void take_base();
    Status finish(Hierarchy& h, std::vector<Bands>& bands);

    Hierarchy m_h;
    CollapseMesh m_mesh;
    const std::vector<const float*>& m_channels;
    std::vector<std::vector<float>> m_values;
    std::vector<Bands> m_bands;
    AliveSet m_alive;
    std::vector<Index> m_batch;  ///< t of each collapse of the current batch
    std::vector<Index> m_born;   ///< u of each collapse
    SymbolReader m_gap, m_choice, m_x, m_y;
    CollapseStar m_star;
    VolumeShares m_shares {};
    Index m_vertices = 0;        ///< of the mesh the sequence starts from
    std::uint64_t m_walked = 0;  ///< words of m_alive, in all batches
    std::uint32_t m_shift = 0;
    float m_cost = 0.0f;
};

/// The mesh the sequence starts from: some pixels, if there are bytes that say which, else all.
bool SequenceReader::read_start(const std::uint8_t* initial, std::size_t size, SymbolReader& diagonals,
                                const std::vector<std::int32_t>& guide)
{
    if (size == 0)
        read_diagonals(diagonals, guide);
    else if (!read_initial_mesh(initial, size, guide, m_mesh))
        return false;
    m_alive.assign(m_mesh);
    m_vertices = Index(m_alive.count());
    return diagonals.finished();
}

void SequenceReader::read_diagonals(SymbolReader& in, const std::vector<std::int32_t>& guide)
{
    const int width = m_h.mesh_width(), height = m_h.mesh_height();
    std::vector<std::uint8_t> falling(std::size_t(width - 1) * std::size_t(height - 1));
    std::size_t quad = 0;
    for (int y = 0; y + 1 < height; ++y)
        for (int x = 0; x + 1 < width; ++x) {
            const DiagonalGuess guess =
                guess_diagonal(&guide[std::size_t(y) * std::size_t(width) + std::size_t(x)], width);
            falling[quad++] = (in.next(guess.symbol_class) & 1) ? !guess.falling : guess.falling;
        }
    m_mesh.connect(falling);
}

void SequenceReader::analyse_collapse(Index t, Index u)
{
    if (m_values.empty())
        return;
    const CollapseStar& star = m_star;
    VolumeShares& shares = m_shares;
    volume_shares(star, m_mesh.vertices[t].at, m_mesh.vertices[u].at, shares);
    for (std::size_t c = 0; c < m_values.size(); ++c) {
        float* z = m_values[c].data();
        const float zt = z[t], zu = z[u];
        float change = shares.u * (zu - zt);
        for (int i = 0; i < star.degree; ++i)
            if (star.ring[i] != kGhost)
                change += shares.ring[i] * (z[star.ring[i]] - zt);
        m_bands[c].details.push_back({ zt, zu });
        z[t] = zt + change;
    }
}

bool SequenceReader::read_collapse(Index t)
{
    if (!m_mesh.alive(t))
        return false;
    const CollapseMesh::Candidates near = m_mesh.candidates(t);
    const std::uint32_t choice = m_choice.next(near.symbol_class);
    if (choice >= std::uint32_t(near.count))
        return false;
    const Index u = choice == 0 ? near.nearest : m_mesh.candidate(t, choice);
    CollapseStar& star = m_star;
    if (!m_mesh.load_star(t, u, star))
        return false;
    const Point pt = m_mesh.vertices[t].at, pu = m_mesh.vertices[u].at, e = m_mesh.extent();
    const CollapseClasses k = collapse_classes(pt, pu, e);
    Point s { expected(pt.x, pu.x, e.x), expected(pt.y, pu.y, e.y) };
    const auto moved = [&](SymbolReader& in, std::uint32_t symbol_class, std::int32_t from, std::int32_t most) {
        const std::int64_t v = (std::int64_t(from >> m_shift) + unfold(in.next(symbol_class))) * (1 << m_shift);
        return std::int32_t(std::clamp<std::int64_t>(v, -1, std::int64_t(most) + 1));
    };
    if (k.x_free)
        s.x = moved(m_x, k.x, s.x, e.x);
    if (k.y_free)
        s.y = moved(m_y, k.y, s.y, e.y);
    if (!m_mesh.is_place_ok(star, t, u, s))
        return false;
    const Projection at_t = project_onto(star, s, pt);
    const Projection at_u = project_onto(star, s, pu);
    const auto pixel = [&](Index v) {
        return v == kGhost ? kGhost : m_mesh.vertices[v].pixel;
    };
    m_h.splits.push_back({ pixel(t), pixel(star.ring[star.vl]), pixel(star.ring[0]), pt, pu });
    m_h.stencils.push_back(
        { pixel(t), pixel(at_t.a), pixel(at_t.b), pixel(at_u.a), pixel(at_u.b), at_t.wa, at_t.wb, at_u.wa, at_u.wb });
    m_h.costs.push_back(m_cost);
    m_born.push_back(pixel(u));
    analyse_collapse(t, u);
    m_mesh.collapse(star, t, u, s);
    m_alive.remove(u);
    return true;
}

/// Drops merged vertices, so that the others lie close to each other.
void SequenceReader::keep_alive()
{
    std::vector<Index> survivors;
    survivors.reserve(m_alive.count());
    AliveSet::Walk walk(m_alive);
    for (Index v; (v = walk.next(0)) != kGhost;)
        survivors.push_back(v);
    m_mesh.keep(survivors);
    for (std::vector<float>& z : m_values) {
        for (std::size_t i = 0; i < survivors.size(); ++i)
            z[i] = z[survivors[i]];
        z.resize(survivors.size());
    }
    m_alive.assign(m_mesh);
}

bool SequenceReader::read_batch(ByteReader& heads)
{
    const std::uint64_t count = heads.varint();
    const std::uint32_t bits = heads.u32();
    float cost;
    std::memcpy(&cost, &bits, 4);
    if (!heads.ok() || count < 1 || count > m_alive.count() || !(cost >= m_cost) || !std::isfinite(cost))
        return false;
    m_cost = cost;
    if (2 * m_alive.count() < m_mesh.size())
        keep_alive();
    // Every batch walks through all vertices: a file of batches with one collapse each would never end.
    m_walked += m_mesh.size() / 64 + 1;
    if (m_walked > kWalksPerPixel * m_h.mesh_pixels() + kFewWalks)
        return false;
    const std::uint32_t density = class_of(std::uint32_t(m_alive.count() / count));
    m_batch.clear();
    AliveSet::Walk walk(m_alive);
    for (std::uint64_t i = 0; i < count; ++i) {
        m_batch.push_back(walk.next(m_gap.next(density)));
        if (m_batch.back() == kGhost)
            return false;
    }
    // The vertices of the whole batch are known by now, so memory can be prefetched.
    constexpr std::size_t kFar = 12, kNear = 5;
    for (std::size_t i = 0; i < m_batch.size(); ++i) {
        if (i + kFar < m_batch.size())
            m_mesh.prefetch(m_batch[i + kFar]);
        if (i + kNear < m_batch.size())
            m_mesh.prefetch_ring(m_batch[i + kNear]);
        if (!read_collapse(m_batch[i]))
            return false;
    }
    return true;
}

Status SequenceReader::read_chunk(ByteSpan chunk, const std::vector<std::int32_t>& guide, bool first)
{
    const auto bad = [] {
        return Status::failure("pimg: the hierarchy is damaged");
    };
    ByteReader in(chunk.data, chunk.size);
    m_shift = in.u8();
    const std::uint64_t batches = in.varint(), size = in.varint();
    if (!in.ok() || m_shift > 6 || size > in.left() || batches > size)
        return bad();
    ByteReader heads(in.take(std::size_t(size)), std::size_t(size));
    const std::uint64_t initial_size = in.varint();
    if (!in.ok() || initial_size > in.left() || (!first && initial_size > 0))
        return bad();
    const std::uint8_t* const initial = in.take(std::size_t(initial_size));
    SymbolReader diagonals;
    if (!diagonals.open(in) || !m_gap.open(in) || !m_choice.open(in) || !m_x.open(in) || !m_y.open(in)
        || !in.finished())
        return bad();
    if (first ? !read_start(initial, std::size_t(initial_size), diagonals, guide) : !diagonals.finished())
        return bad();
    for (std::uint64_t b = 0; b < batches; ++b)
        if (!read_batch(heads))
            return bad();
    const bool whole = heads.finished() && m_gap.finished() && m_choice.finished() && m_x.finished() && m_y.finished();
    return whole ? Status() : bad();
}

/// What is left of the mesh is the base.
void SequenceReader::take_base()
{
    const Index base = m_mesh.size();
    for (Index v = 0; v < base; ++v) {
        m_h.base_points.push_back(m_mesh.vertices[v].at);
        const int degree = m_mesh.vertices[v].degree;
        for (int j = 0; j < degree; ++j) {
            const Index a = m_mesh.rings[v].v[std::size_t(j)], b = m_mesh.rings[v].v[std::size_t((j + 1) % degree)];
            if (a != kGhost && b != kGhost && v < a && v < b)
                m_h.base_triangles.push_back({ v, a, b });
        }
    }
}

/// Numbers the vertices, base first and then by the split that makes each, and turns the sequence around.
Status SequenceReader::finish(Hierarchy& h, std::vector<Bands>& bands)
{
    keep_alive();
    const std::size_t pixels = m_h.mesh_pixels();
    const Index base = m_mesh.size();
    std::vector<Index> number(pixels, kGhost);  // of each pixel
    for (Index v = 0; v < base; ++v)
        number[m_mesh.vertices[v].pixel] = v;
    const Level levels = Level(m_born.size());
    for (Level i = 0; i < levels; ++i)
        number[m_born[i]] = base + levels - 1 - i;
    const auto renumber = [&](Index v) {
        return v == kGhost ? kGhost : number[v];
    };

    std::reverse(m_h.splits.begin(), m_h.splits.end());
    std::reverse(m_h.stencils.begin(), m_h.stencils.end());
    std::reverse(m_h.costs.begin(), m_h.costs.end());
    for (Split& s : m_h.splits) {
        s.s = number[s.s];
        s.vl = renumber(s.vl);
        s.vr = renumber(s.vr);
    }
    for (Stencil& k : m_h.stencils)
        for (Index* v : { &k.s, &k.at, &k.bt, &k.au, &k.bu })
            *v = number[*v];
    m_h.pixels.resize(m_vertices);
    for (Index pixel = 0; pixel < pixels; ++pixel)
        if (number[pixel] != kGhost)
            m_h.pixels[number[pixel]] = pixel;
    for (std::size_t c = 0; c < m_bands.size(); ++c) {
        std::reverse(m_bands[c].details.begin(), m_bands[c].details.end());
        m_bands[c].base = std::move(m_values[c]);
    }
    take_base();
    const Status status = find_pixels_between(m_h);
    if (!status)
        return status;
    h = std::move(m_h);
    for (std::size_t c = 0; c < m_bands.size(); ++c)
        subtract_predictions(h, h.between.empty() ? nullptr : m_channels[c], m_bands[c]);
    bands = std::move(m_bands);
    return {};
}

Status SequenceReader::run(const std::vector<ByteSpan>& chunks, const std::vector<std::int32_t>& guide, Hierarchy& h,
                           std::vector<Bands>& bands)
{
    const std::size_t n = m_mesh.size();
    m_h.splits.reserve(n);
    m_h.stencils.reserve(n);
    m_h.costs.reserve(n);
    m_born.reserve(n);
    m_bands.resize(m_channels.size());
    for (std::size_t c = 0; c < m_channels.size(); ++c) {
        m_values.emplace_back(m_channels[c], m_channels[c] + n);
        m_bands[c].details.reserve(n);
    }
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        const Status status = read_chunk(chunks[i], guide, i == 0);
        if (!status)
            return status;
    }
    return finish(h, bands);
}

}  // namespace

Status read_collapse_sequence(const std::vector<ByteSpan>& chunks, int width, int height,
                              const std::vector<std::int32_t>& guide, const std::vector<const float*>& channels,
                              Hierarchy& hierarchy, std::vector<Bands>& bands)
{
    return SequenceReader(width, height, channels).run(chunks, guide, hierarchy, bands);
}

}  // namespace PIMG_ABI
}  // namespace pimg
