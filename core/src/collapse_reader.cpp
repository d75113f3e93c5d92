// SPDX-License-Identifier: BSD-3-Clause
// Repeats the collapse sequence: every collapse gives a split of the hierarchy and, from the same star, the coarse value of
// every channel (the volume under the surface stays, see analyse()).
#include <algorithm>
#include <cmath>
#include <cstring>

#include "binary_coder.h"
#include "collapse_mesh.h"
#include "collapse_record.h"
#include "collapse_sequence.h"

namespace pimg {

namespace {

/// Shares of the star's vertices in the value of s.
struct VolumeShares {
    float ring[kMaxDegree], u;
};

VolumeShares volume_shares(const Star& star, Point t, Point u, Point s)
{
    double share[kMaxDegree] = {};
    double whole = 0.0, of_u = 0.0;
    for (int i = 0; i < star.degree; ++i) {
        const int next = i + 1 < star.degree ? i + 1 : 0;
        if (star.ring[i] == kGhost || star.ring[next] == kGhost)
            continue;
        const bool with_u = i >= star.vl;
        const double before = double(doubled_area(with_u ? u : t, star.points[i], star.points[next]));
        const double after = double(doubled_area(s, star.points[i], star.points[next]));
        whole += after;
        of_u += with_u ? before : 0.0;
        share[i] += before - after;
        share[next] += before - after;
    }
    for (int i : { 0, star.vl }) {
        if (star.ring[i] == kGhost)
            continue;
        const double gone = std::fabs(double(doubled_area(t, u, star.points[i])));
        of_u += gone;
        share[i] += gone;
    }
    VolumeShares shares;
    const double scale = whole > 0.0 ? 1.0 / whole : 0.0;
    for (int i = 0; i < star.degree; ++i)
        shares.ring[i] = float(share[i] * scale);
    shares.u = float(of_u * scale);
    return shares;
}

class SequenceReader {
public:
    SequenceReader(int width, int height, const std::vector<const float*>& channels)
        : m_mesh(std::max(width, 2), std::max(height, 2)), m_channels(channels)
    {
        m_h.width = width;
        m_h.height = height;
    }
    Status run(const std::vector<ByteSpan>& chunks, const std::vector<std::int32_t>& guide, Hierarchy& h,
               std::vector<Bands>& bands);

private:
    Status read_chunk(ByteSpan chunk, const std::vector<std::int32_t>& guide, bool first);
    bool read_diagonals(SymbolReader& in, const std::vector<std::int32_t>& guide);
    bool read_batch(ByteReader& heads);
    bool read_collapse(Index t);
    void analyse_collapse(const Star& star, Index t, Index u, Point s);
    void finish(Hierarchy& h, std::vector<Bands>& bands);

    Hierarchy m_h;
    CollapseMesh m_mesh;
    const std::vector<const float*>& m_channels;
    std::vector<std::vector<float>> m_values;
    std::vector<Bands> m_bands;
    std::vector<Index> m_alive;
    std::vector<Index> m_born;  ///< u of each collapse
    SymbolReader m_gap, m_choice, m_x, m_y;
    std::uint32_t m_shift = 0;
    float m_cost = 0.0f;
};

bool SequenceReader::read_diagonals(SymbolReader& in, const std::vector<std::int32_t>& guide)
{
    const int width = m_h.mesh_width(), height = m_h.mesh_height();
    std::vector<std::uint8_t> falling(std::size_t(width - 1) * std::size_t(height - 1));
    std::size_t quad = 0;
    for (int y = 0; y + 1 < height; ++y)
        for (int x = 0; x + 1 < width; ++x) {
            const DiagonalGuess guess
                = guess_diagonal(&guide[std::size_t(y) * std::size_t(width) + std::size_t(x)], width);
            falling[quad++] = (in.next(guess.klass) & 1) ? !guess.falling : guess.falling;
        }
    m_mesh.connect(falling);
    return in.finished();
}

void SequenceReader::analyse_collapse(const Star& star, Index t, Index u, Point s)
{
    if (m_values.empty())
        return;
    const VolumeShares shares = volume_shares(star, m_mesh.points[t], m_mesh.points[u], s);
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
    const std::uint32_t choice = m_choice.next(near.klass);
    if (choice >= std::uint32_t(near.count))
        return false;
    const Index u = near.vertex[choice];
    Star star;
    if (!m_mesh.load_star(t, u, star))
        return false;
    const Point pt = m_mesh.points[t], pu = m_mesh.points[u], e = m_mesh.extent();
    const CollapseClasses k = collapse_classes(pt, pu, e);
    Point s { expected(pt.x, pu.x, e.x), expected(pt.y, pu.y, e.y) };
    const auto moved = [&](SymbolReader& in, std::uint32_t klass, std::int32_t from, std::int32_t most) {
        const std::int64_t v = (std::int64_t(from >> m_shift) + unfold(in.next(klass))) * (1 << m_shift);
        return std::int32_t(std::clamp<std::int64_t>(v, -1, std::int64_t(most) + 1));
    };
    if (k.x_free)
        s.x = moved(m_x, k.x, s.x, e.x);
    if (k.y_free)
        s.y = moved(m_y, k.y, s.y, e.y);
    if (!m_mesh.is_place_ok(star, t, u, s))
        return false;
    const Projection at_t = project(pt, s, star.degree, star.ring, star.points);
    const Projection at_u = project(pu, s, star.degree, star.ring, star.points);
    m_h.splits.push_back({ t, star.ring[star.vl], star.ring[0], pt, pu });
    m_h.stencils.push_back({ t, at_t.a, at_t.b, at_u.a, at_u.b, at_t.wa, at_t.wb, at_u.wa, at_u.wb });
    m_h.costs.push_back(m_cost);
    m_born.push_back(u);
    analyse_collapse(star, t, u, s);
    m_mesh.collapse(star, t, u, s);
    return true;
}

bool SequenceReader::read_batch(ByteReader& heads)
{
    const std::uint64_t count = heads.varint();
    const std::uint32_t bits = heads.u32();
    float cost;
    std::memcpy(&cost, &bits, 4);
    m_alive.erase(std::remove_if(m_alive.begin(), m_alive.end(), [&](Index v) { return !m_mesh.alive(v); }),
                  m_alive.end());
    if (!heads.ok() || count < 1 || count > m_alive.size() || !(cost >= m_cost) || !std::isfinite(cost))
        return false;
    m_cost = cost;
    const std::uint32_t density = class_of(std::uint32_t(m_alive.size() / count));
    std::size_t at = 0;
    for (std::uint64_t i = 0; i < count; ++i, ++at) {
        at += m_gap.next(density);
        if (at >= m_alive.size() || !read_collapse(m_alive[at]))
            return false;
    }
    return true;
}

Status SequenceReader::read_chunk(ByteSpan chunk, const std::vector<std::int32_t>& guide, bool first)
{
    const auto bad = [] { return Status::failure("pimg: the hierarchy is damaged"); };
    ByteReader in(chunk.data, chunk.size);
    m_shift = in.u8();
    const std::uint64_t batches = in.varint(), size = in.varint();
    if (!in.ok() || m_shift > 6 || size > in.left() || batches > size)
        return bad();
    ByteReader heads(in.take(std::size_t(size)), std::size_t(size));
    SymbolReader diagonals;
    if (!diagonals.open(in) || !m_gap.open(in) || !m_choice.open(in) || !m_x.open(in) || !m_y.open(in) || !in.finished())
        return bad();
    if (first ? !read_diagonals(diagonals, guide) : !diagonals.finished())
        return bad();
    for (std::uint64_t b = 0; b < batches; ++b)
        if (!read_batch(heads))
            return bad();
    const bool whole = heads.finished() && m_gap.finished() && m_choice.finished() && m_x.finished() && m_y.finished();
    return whole ? Status() : bad();
}

/// Numbers the vertices, base first and then by the split that makes each, and turns the sequence around.
void SequenceReader::finish(Hierarchy& h, std::vector<Bands>& bands)
{
    std::vector<Index> number(m_mesh.size());
    Index base = 0;
    for (Index v = 0; v < m_mesh.size(); ++v)
        if (m_mesh.alive(v))
            number[v] = base++;
    const Level levels = Level(m_born.size());
    for (Level i = 0; i < levels; ++i)
        number[m_born[i]] = base + levels - 1 - i;
    const auto renumber = [&](Index v) { return v == kGhost ? kGhost : number[v]; };

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
    m_h.pixels.resize(m_mesh.size());
    for (Index v = 0; v < m_mesh.size(); ++v)
        m_h.pixels[number[v]] = v;
    for (Bands& b : m_bands) {
        std::reverse(b.details.begin(), b.details.end());
        b.base.resize(base);
    }
    for (Index v = 0; v < m_mesh.size(); ++v) {
        if (!m_mesh.alive(v))
            continue;
        m_h.base_points.push_back(m_mesh.points[v]);
        for (std::size_t c = 0; c < m_bands.size(); ++c)
            m_bands[c].base[number[v]] = m_values[c][v];
        const int degree = m_mesh.degrees[v];
        for (int j = 0; j < degree; ++j) {
            const Index a = m_mesh.rings[v].v[std::size_t(j)], b = m_mesh.rings[v].v[std::size_t((j + 1) % degree)];
            if (a != kGhost && b != kGhost && v < a && v < b)
                m_h.base_triangles.push_back({ number[v], number[a], number[b] });
        }
    }
    h = std::move(m_h);
    for (Bands& b : m_bands)
        values_to_details(h, nullptr, b);  // every pixel is a vertex: no residual
    bands = std::move(m_bands);
}

Status SequenceReader::run(const std::vector<ByteSpan>& chunks, const std::vector<std::int32_t>& guide, Hierarchy& h,
                           std::vector<Bands>& bands)
{
    const std::size_t n = m_mesh.size();
    m_h.splits.reserve(n);
    m_h.stencils.reserve(n);
    m_h.costs.reserve(n);
    m_born.reserve(n);
    m_alive.reserve(n);
    for (Index v = 0; v < Index(n); ++v)
        m_alive.push_back(v);
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
    finish(h, bands);
    return {};
}

}  // namespace

Status read_collapse_sequence(const std::vector<ByteSpan>& chunks, int width, int height,
                              const std::vector<std::int32_t>& guide, const std::vector<const float*>& channels,
                              Hierarchy& hierarchy, std::vector<Bands>& bands)
{
    return SequenceReader(width, height, channels).run(chunks, guide, hierarchy, bands);
}

}  // namespace pimg
