// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/dual_pieces.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include <pimg/detail/stop.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// For each mesh pixel the vertex of the finest mesh that it belongs to: its own vertex if it has one, else the corner
/// with the largest weight of the face that the pixel lies in. kGhost in a damaged hierarchy.
std::vector<Index> finest_pieces(const Hierarchy& h)
{
    std::vector<Index> vertex_at(h.mesh_pixels(), kGhost);
    for (Index v = 0; v < h.vertices(); ++v)
        if (h.pixels[v] < vertex_at.size())
            vertex_at[h.pixels[v]] = v;
    for (const PixelStencil& s : h.between) {
        const float wa = 1.0f - s.wb - s.wc;
        const Index corner = wa >= s.wb && wa >= s.wc ? s.a : s.wb >= s.wc ? s.b : s.c;
        if (s.pixel < vertex_at.size() && corner < vertex_at.size())
            vertex_at[s.pixel] = vertex_at[corner];
    }
    return vertex_at;
}

/// Where each vertex's run of pixels begins. The run holds the pixels of the vertex itself, then the runs of its
/// children, which are the vertices split from it, the youngest first. So if children are taken from old to young, each
/// gets the end of what is left of its parent's run.
std::vector<Index> first_of_runs(const std::vector<Index>& parents, const std::vector<Index>& span, Index base)
{
    std::vector<Index> first(parents.size()), left = span;
    Index next = 0;
    for (Index v = 0; v < parents.size(); ++v) {
        const Index parent = parents[v];
        if (v < base) {
            first[v] = next;
            next += span[v];
        } else {
            left[parent] -= span[v];
            first[v] = first[parent] + left[parent];
        }
    }
    return first;
}

}  // namespace

Status DualPieces::from_hierarchy(const Hierarchy& h, DualPieces& pieces)
{
    if (h.pixels.size() != h.vertices() || h.vertices() + h.between.size() != h.mesh_pixels())
        return Status::failure("hierarchy: sizes do not agree");
    DualPieces d;
    d.m_width = h.width;
    d.m_height = h.height;
    d.m_base = h.base_vertices();
    const Index vertices = h.vertices();
    d.m_parents.resize(vertices);
    std::iota(d.m_parents.begin(), d.m_parents.begin() + d.m_base, Index(0));
    for (Level i = 0; i < h.levels(); ++i) {
        if (h.splits[i].s >= d.m_base + i)
            return Status::failure("hierarchy: split " + std::to_string(i) + " names a vertex that does not exist yet");
        d.m_parents[d.m_base + i] = h.splits[i].s;
    }

    stop_point();
    const std::vector<Index> vertex_at = finest_pieces(h);
    stop_point();
    const std::size_t width = std::size_t(h.width), height = std::size_t(h.height);
    d.m_vertex_of.reserve(width * height);
    d.m_span.assign(vertices, 0);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const Index v = vertex_at[y * std::size_t(h.mesh_width()) + x];
            if (v == kGhost)
                return Status::failure("hierarchy: a pixel belongs to no vertex");
            d.m_vertex_of.push_back(v);
            ++d.m_span[v];
        }
    std::vector<Index> own = d.m_span;
    for (Index v = vertices; v-- > d.m_base;)
        d.m_span[d.m_parents[v]] += d.m_span[v];

    stop_point();
    d.m_first = first_of_runs(d.m_parents, d.m_span, d.m_base);
    stop_point();
    d.m_order.resize(d.m_vertex_of.size());
    for (Index p = Index(d.m_vertex_of.size()); p-- > 0;) {
        const Index v = d.m_vertex_of[p];
        d.m_order[d.m_first[v] + --own[v]] = p;
    }
    pieces = std::move(d);
    return {};
}

std::vector<Index> DualPieces::labels(Level level) const
{
    // Parents have smaller numbers, so one pass finds the piece of every vertex.
    const Index n = count(std::min(level, levels()));
    std::vector<Index> piece(m_parents.size());
    for (Index v = 0; v < Index(piece.size()); ++v)
        piece[v] = v < n ? v : piece[m_parents[v]];
    stop_point();
    std::vector<Index> result(m_vertex_of.size());
    for (std::size_t p = 0; p < result.size(); ++p)
        result[p] = piece[m_vertex_of[p]];
    return result;
}

Index DualPieces::ancestor(Index v, Level level) const
{
    const Index n = count(std::min(level, levels()));
    while (v >= n)
        v = m_parents[v];
    return v;
}

std::vector<Index> DualPieces::sizes(Level level) const
{
    const Index n = count(std::min(level, levels()));
    std::vector<Index> result(m_span.begin(), m_span.begin() + n);
    for (Index v = m_base; v < n; ++v)
        result[m_parents[v]] -= m_span[v];
    return result;
}

std::vector<Border> borders(const std::vector<Index>& labels, int width, int height)
{
    // Counting sort by the smaller label keeps this linear; the few neighbours of each are then sorted.
    const std::size_t w = std::size_t(width), h = std::size_t(height);
    const Index count = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
    std::vector<std::size_t> start(std::size_t(count) + 1, 0);
    const auto each_side = [&](auto&& visit) {
        for (std::size_t y = 0; y < h; ++y)
            for (std::size_t x = 0; x < w; ++x) {
                const Index a = labels[y * w + x];
                if (x + 1 < w && labels[y * w + x + 1] != a)
                    visit(std::minmax(a, labels[y * w + x + 1]));
                if (y + 1 < h && labels[(y + 1) * w + x] != a)
                    visit(std::minmax(a, labels[(y + 1) * w + x]));
            }
    };
    each_side([&](std::pair<Index, Index> side) { ++start[side.first + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<Index> other(start.back());
    std::vector<std::size_t> at(start.begin(), start.end() - 1);
    each_side([&](std::pair<Index, Index> side) { other[at[side.first]++] = side.second; });

    std::vector<Border> result;
    for (Index a = 0; a < count; ++a) {
        std::sort(other.begin() + std::ptrdiff_t(start[a]), other.begin() + std::ptrdiff_t(start[a + 1]));
        for (std::size_t i = start[a]; i < start[a + 1]; ++i)
            if (i > start[a] && other[i] == other[i - 1])
                ++result.back().length;
            else
                result.push_back({ a, other[i], 1 });
    }
    return result;
}

Index connected_parts(std::vector<Index>& labels, int width, int height)
{
    const std::size_t w = std::size_t(width), n = w * std::size_t(height);
    std::vector<Index> part(n, kGhost), stack;
    Index count = 0;
    for (std::size_t p = 0; p < n; ++p) {
        if (part[p] != kGhost)
            continue;
        const auto reach = [&](std::size_t q) {
            if (part[q] == kGhost && labels[q] == labels[p]) {
                part[q] = count;
                stack.push_back(Index(q));
            }
        };
        for (reach(p); !stack.empty();) {
            const std::size_t q = stack.back();
            stack.pop_back();
            if (q % w > 0)
                reach(q - 1);
            if (q % w + 1 < w)
                reach(q + 1);
            if (q >= w)
                reach(q - w);
            if (q + w < n)
                reach(q + w);
        }
        ++count;
    }
    labels = std::move(part);
    return count;
}

std::vector<float> label_means(const std::vector<Index>& labels, Index count, const float* samples)
{
    std::vector<double> sum(count, 0.0), size(count, 0.0);
    for (std::size_t p = 0; p < labels.size(); ++p) {
        sum[labels[p]] += double(samples[p]);
        size[labels[p]] += 1.0;
    }
    std::vector<float> mean(count);
    for (Index k = 0; k < count; ++k)
        mean[k] = float(sum[k] / std::max(size[k], 1.0));
    return mean;
}

std::vector<Centroid> label_centroids(const std::vector<Index>& labels, Index count, int width)
{
    struct Sum {
        double x = 0, y = 0, n = 0;
    };
    std::vector<Sum> sums(count);
    for (std::size_t p = 0; p < labels.size(); ++p) {
        Sum& s = sums[labels[p]];
        s.x += double(p % std::size_t(width));
        const std::size_t row = p / std::size_t(width);
        s.y += double(row);
        s.n += 1.0;
    }
    std::vector<Centroid> result(count);
    for (Index k = 0; k < count; ++k)
        result[k] = { float(sums[k].x / std::max(sums[k].n, 1.0)), float(sums[k].y / std::max(sums[k].n, 1.0)) };
    return result;
}

}  // namespace PIMG_ABI
}  // namespace pimg
