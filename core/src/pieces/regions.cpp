// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/regions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include <pimg/detail/elementary.h>
#include <pimg/detail/stop.h>
#include <pimg/dual_pieces.h>

#include "pieces/region_graph.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr std::size_t kMaxChannels = 64;  ///< more than any picture needs; limits what an untrusted caller can ask for

/// The number of sample i - before of a line of `count`: beyond its ends the other end, or the end again.
std::size_t before(std::size_t i, std::size_t steps, std::size_t count, bool wraps)
{
    if (wraps)
        return (i + count - steps % count) % count;
    return i < steps ? 0 : std::min(i - steps, count - 1);
}

/// The number of the sample after i.
std::size_t after(std::size_t i, std::size_t count, bool wraps)
{
    return i + 1 < count ? i + 1 : wraps ? 0 : i;
}

/// Gaussian of one channel. In place, through one row or column at a time.
void smooth(std::vector<float>& samples, std::size_t width, std::size_t height, const RegionOptions& options)
{
    const float sigma = options.smoothing;
    if (!(sigma > 0.0f))
        return;
    const int reach = int(std::ceil(3.0f * sigma));
    std::vector<float> kernel(std::size_t(2 * reach + 1));
    for (int k = -reach; k <= reach; ++k)
        kernel[std::size_t(k + reach)] =
            float(elementary::exp2(double(-0.5f * float(k * k) / (sigma * sigma)) / elementary::kLn2));
    const float total = std::accumulate(kernel.begin(), kernel.end(), 0.0f);
    for (float& k : kernel)
        k /= total;
    std::vector<float> line;
    const auto pass = [&](std::size_t first, std::size_t step, std::size_t count, bool wraps) {
        stop_point();
        line.resize(count + 2 * std::size_t(reach));
        for (std::size_t i = 0; i < line.size(); ++i)
            line[i] = samples[first + before(i, std::size_t(reach), count, wraps) * step];
        for (std::size_t i = 0; i < count; ++i) {
            float sum = 0.0f;
            for (std::size_t k = 0; k < kernel.size(); ++k)
                sum += kernel[k] * line[i + k];
            samples[first + i * step] = sum;
        }
    };
    for (std::size_t y = 0; y < height; ++y)
        pass(y * width, 1, width, options.wrap_x);
    for (std::size_t x = 0; x < width; ++x)
        pass(x, width, height, options.wrap_y);
}

/// Length of the gradient per pixel over all channels, by central differences.
std::vector<float> gradient(const ChannelsView& picture, const RegionOptions& options)
{
    const std::size_t w = std::size_t(picture.width), h = std::size_t(picture.height);
    std::vector<float> squares(w * h, 0.0f), samples;
    for (const float* channel : picture.channels) {
        samples.assign(channel, channel + w * h);
        smooth(samples, w, h, options);
        for (std::size_t y = 0; y < h; ++y) {
            const float* up = &samples[before(y, 1, h, options.wrap_y) * w];
            const float* here = &samples[y * w];
            const float* down = &samples[after(y, h, options.wrap_y) * w];
            for (std::size_t x = 0; x < w; ++x) {
                const float gx = 0.5f * (here[after(x, w, options.wrap_x)] - here[before(x, 1, w, options.wrap_x)]);
                const float gy = 0.5f * (down[x] - up[x]);
                squares[y * w + x] += gx * gx + gy * gy;
            }
        }
    }
    for (float& s : squares)
        s = std::sqrt(s);
    return squares;
}

constexpr std::uint32_t kPassedBetweenStops = 1024;  ///< candidates; up to some microseconds each

/// The parts of `pieces`, connected across the sides that meet, too: numbers from 0 in the order of their first pixels.
/// Returns how many there are.
Index parts_of(const std::vector<Index>& pieces, const ChannelsView& picture, const RegionOptions& options,
               std::vector<Index>& parts)
{
    const std::size_t w = std::size_t(picture.width), h = std::size_t(picture.height);
    parts = pieces;
    const Index count = connected_parts(parts, picture.width, picture.height);
    std::vector<Index> first(count);  // of the parts that are one
    std::iota(first.begin(), first.end(), Index(0));
    const auto root = [&](Index part) {
        while (first[part] != part)
            part = first[part] = first[first[part]];
        return part;
    };
    const auto join = [&](std::size_t p, std::size_t q) {
        const Index a = root(parts[p]), b = root(parts[q]);
        if (pieces[p] == pieces[q])
            first[std::max(a, b)] = std::min(a, b);
    };
    for (std::size_t y = 0; options.wrap_x && y < h; ++y)
        join(y * w, y * w + w - 1);
    for (std::size_t x = 0; options.wrap_y && x < w; ++x)
        join(x, (h - 1) * w + x);
    std::vector<Index> number(count);
    Index joined = 0;
    for (Index part = 0; part < count; ++part)  // roots have the lowest numbers, so they come first
        number[part] = first[part] == part ? joined++ : number[root(part)];
    for (Index& part : parts)
        part = number[part];
    return joined;
}

struct Candidate {
    float cost;
    Index region, stamp;
};

/// Cheapest first; among equals the lower number, so that the order is the same everywhere.
struct Later {
    bool operator()(const Candidate& a, const Candidate& b) const
    {
        return a.cost != b.cost ? a.cost > b.cost : a.region > b.region;
    }
};

}  // namespace

/// Greedy merging. A queue holds every region, ordered by the cost of its cheapest border.
class RegionMerger {
public:
    RegionMerger(const ChannelsView& picture, const RegionOptions& options, RegionTree& tree);
    bool run();

private:
    struct Region {
        float area = 0;       ///< pixels
        Index best = kGhost;  ///< neighbour across the cheapest border
        float cost = 0;
        Index stamp = 0;  ///< grows whenever best or cost change
    };

    const float* mean(Index r) const { return &m_means[r * m_channels]; }
    void add_pieces(const ChannelsView& picture);
    void add_borders(const ChannelsView& picture);
    float cost(Index a, Index b, const RegionGraph::Shared& shared) const;
    void find_best(Index r);
    void enqueue(Index r) { m_queue.push({ m_regions[r].cost, r, m_regions[r].stamp }); }
    void merge(Index kept, Index gone);
    void update_neighbours(Index kept, Index gone);

    const RegionOptions& m_options;
    RegionTree& m_tree;
    std::size_t m_channels;
    std::vector<Region> m_regions;
    std::vector<float> m_means;  ///< interleaved
    RegionGraph m_graph;
    std::priority_queue<Candidate, std::vector<Candidate>, Later> m_queue;
};

RegionMerger::RegionMerger(const ChannelsView& picture, const RegionOptions& options, RegionTree& tree)
    : m_options(options),
      m_tree(tree),
      m_channels(picture.channels.size()),
      m_regions(tree.m_leaves),
      m_means(tree.m_leaves * m_channels),
      m_graph(tree.m_leaves)
{
    add_pieces(picture);
    add_borders(picture);
}

void RegionMerger::add_pieces(const ChannelsView& picture)
{
    const std::vector<Index>& leaf_of = m_tree.m_leaf_of;
    std::vector<double> sums(m_means.size(), 0.0);
    for (std::size_t p = 0; p < leaf_of.size(); ++p) {
        for (std::size_t c = 0; c < m_channels; ++c)
            sums[leaf_of[p] * m_channels + c] += double(picture.channels[c][p]);
        m_regions[leaf_of[p]].area += 1.0f;
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        m_means[i] = float(sums[i] / double(m_regions[i / m_channels].area));
}

/// Adds one border per pair of neighbouring pieces. The borders of a piece are gathered from the sides of its pixels,
/// sorted.
void RegionMerger::add_borders(const ChannelsView& picture)
{
    const std::vector<Index>& leaf_of = m_tree.m_leaf_of;
    const std::size_t w = std::size_t(picture.width), n = leaf_of.size();
    const std::vector<float> slope = gradient(picture, m_options);
    struct Side {
        std::uint64_t pair;
        float strength;
    };
    stop_point();
    std::vector<Side> sides;
    sides.reserve(2 * n);
    const auto add = [&](std::size_t p, std::size_t q) {
        const Index a = std::min(leaf_of[p], leaf_of[q]), b = std::max(leaf_of[p], leaf_of[q]);
        if (a != b)
            sides.push_back({ std::uint64_t(a) << 32 | b, slope[p] + slope[q] });
    };
    for (std::size_t p = 0; p < n; ++p) {
        const bool ends = (p + 1) % w == 0;
        if (!ends || m_options.wrap_x)
            add(p, ends ? p + 1 - w : p + 1);
        if (p + w < n || m_options.wrap_y)
            add(p, (p + w) % n);
    }
    std::uint32_t compared = 0;
    std::stable_sort(sides.begin(), sides.end(), [&compared](const Side& a, const Side& b) {
        if (++compared % kBetweenStops == 0)
            stop_point();
        return a.pair < b.pair;
    });
    m_graph.reserve(sides.size());
    for (std::size_t i = 0; i < sides.size();) {
        if (++compared % kBetweenStops == 0)
            stop_point();
        const std::uint64_t pair = sides[i].pair;
        RegionGraph::Shared shared { 0.0f, 0.0f };
        for (; i < sides.size() && sides[i].pair == pair; ++i) {
            shared.length += 1.0f;
            shared.strength += sides[i].strength;
        }
        m_graph.add(Index(pair >> 32), Index(pair & 0xffffffffu), shared);
    }
}

float RegionMerger::cost(Index a, Index b, const RegionGraph::Shared& shared) const
{
    const Region &ra = m_regions[a], &rb = m_regions[b];
    const float *ma = mean(a), *mb = mean(b);
    float difference = 0.0f;
    for (std::size_t c = 0; c < m_channels; ++c)
        difference += (ma[c] - mb[c]) * (ma[c] - mb[c]);
    const float weight = ra.area * rb.area / (ra.area + rb.area);
    const float edge = shared.strength / shared.length;
    // A square root has the same bits on every machine; other powers have not.
    const float contact = std::min(ra.area, rb.area) / (shared.length * shared.length);
    const float shape = std::sqrt(std::sqrt(std::sqrt(std::sqrt(contact))));
    return weight * (m_options.floor + difference + m_options.boundary * edge) * shape;
}

void RegionMerger::find_best(Index r)
{
    Region& region = m_regions[r];
    region.best = kGhost;
    ++region.stamp;
    for (Index h = m_graph.first(r); h != kGhost; h = m_graph.next(h)) {
        const Index q = m_graph.to(h);
        const float c = cost(r, q, m_graph.shared(h));
        if (region.best == kGhost || c < region.cost || (c == region.cost && q < region.best)) {
            region.best = q;
            region.cost = c;
        }
    }
}

void RegionMerger::merge(Index kept, Index gone)
{
    Region &k = m_regions[kept], &g = m_regions[gone];
    const float share = g.area / (k.area + g.area);
    for (std::size_t c = 0; c < m_channels; ++c)
        m_means[kept * m_channels + c] += share * (mean(gone)[c] - mean(kept)[c]);
    k.area += g.area;
    ++g.stamp;
    m_graph.merge(kept, gone);
}

void RegionMerger::update_neighbours(Index kept, Index gone)
{
    for (Index h = m_graph.first(kept); h != kGhost; h = m_graph.next(h)) {
        const Index q = m_graph.to(h);
        Region& region = m_regions[q];
        if (region.best == kept || region.best == gone) {
            find_best(q);
            enqueue(q);
            continue;
        }
        const float c = cost(q, kept, m_graph.shared(h));
        if (c < region.cost) {
            region.best = kept;
            region.cost = c;
            ++region.stamp;
            enqueue(q);
        }
    }
}

bool RegionMerger::run()
{
    const Index leaves = Index(m_regions.size());
    for (Index r = 0; r < leaves; ++r) {
        if (r % kPassedBetweenStops == 0)
            stop_point();
        find_best(r);
        if (m_regions[r].best != kGhost)
            enqueue(r);
    }
    m_tree.m_merges.reserve(leaves - 1);
    m_tree.m_costs.reserve(leaves - 1);
    float highest = 0.0f;
    std::uint32_t passed = 0;
    while (!m_queue.empty()) {
        if (++passed % kPassedBetweenStops == 0)
            stop_point();
        const Candidate next = m_queue.top();
        m_queue.pop();
        if (m_regions[next.region].stamp != next.stamp)
            continue;
        const Index a = next.region, b = m_regions[a].best;
        const Index kept = std::min(a, b), gone = std::max(a, b);
        merge(kept, gone);
        highest = std::max(highest, next.cost);
        m_tree.m_merges.push_back({ kept, gone });
        m_tree.m_costs.push_back(highest);
        update_neighbours(kept, gone);
        find_best(kept);
        if (m_regions[kept].best != kGhost)
            enqueue(kept);
        if (m_options.progress && m_tree.m_merges.size() % 65536 == 0
            && !m_options.progress(float(m_tree.m_merges.size()) / float(leaves)))
            return false;
    }
    return true;
}

Status RegionTree::build(const ChannelsView& picture, const RegionOptions& options, RegionTree& tree)
{
    const std::size_t n = std::size_t(std::max(picture.width, 0)) * std::size_t(std::max(picture.height, 0));
    if (n == 0 || picture.channels.empty())
        return Status::failure("the picture is empty");
    if (n > std::size_t(1) << 30 || picture.channels.size() > kMaxChannels)
        return Status::failure("segmentation takes at most 2^30 pixels and 64 channels");
    if (options.pieces && options.pieces->size() != n)
        return Status::failure("the pieces to merge are not those of this picture");
    RegionTree t;
    if (options.pieces) {
        t.m_leaves = parts_of(*options.pieces, picture, options, t.m_leaf_of);
    } else {
        t.m_leaf_of.resize(n);
        std::iota(t.m_leaf_of.begin(), t.m_leaf_of.end(), Index(0));
        t.m_leaves = Index(n);
    }
    if (!RegionMerger(picture, options, t).run())
        return Status::failure("segmentation was stopped");
    tree = std::move(t);
    return {};
}

std::vector<Index> RegionTree::labels(Index regions) const
{
    regions = std::max(std::min(regions, m_leaves), Index(m_leaves > 0));
    // Undoing the last merges first: a region that is gone by then stands for the one it went into.
    std::vector<Index> owner(m_leaves);
    std::iota(owner.begin(), owner.end(), Index(0));
    for (std::size_t i = std::size_t(m_leaves - regions); i-- > 0;)
        owner[m_merges[i].gone] = owner[m_merges[i].kept];
    std::vector<Index> number(m_leaves, kGhost), result(m_leaf_of.size());
    Index next = 0;
    for (std::size_t p = 0; p < result.size(); ++p) {
        Index& label = number[owner[m_leaf_of[p]]];
        if (label == kGhost)
            label = next++;
        result[p] = label;
    }
    return result;
}

std::size_t RegionTree::memory() const
{
    return m_leaf_of.capacity() * sizeof(Index) + m_merges.capacity() * sizeof(Merge)
        + m_costs.capacity() * sizeof(float);
}

Index RegionTree::regions_above(float threshold) const
{
    const auto end = std::upper_bound(m_costs.begin(), m_costs.end(), threshold);
    return m_leaves - Index(end - m_costs.begin());
}

}  // namespace PIMG_ABI
}  // namespace pimg
