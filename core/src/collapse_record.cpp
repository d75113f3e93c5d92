// SPDX-License-Identifier: BSD-3-Clause
#include "collapse_record.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

#include "pixel_stencils.h"

namespace pimg {

Projection project(Point p, Point s, int degree, const Index* ring, const Point* points)
{
    Projection found { kGhost, kGhost, 0.0f, 0.0f };
    for (int i = 0; i < degree; ++i) {
        const int next = i + 1 < degree ? i + 1 : 0;
        if (ring[i] == kGhost || ring[next] == kGhost)
            continue;
        const std::int64_t b = doubled_area(s, points[i], p);
        const std::int64_t a = doubled_area(s, p, points[next]);
        const bool holds = a >= 0 && b >= 0;
        if (!holds && found.a != kGhost)
            continue;
        const double area = double(doubled_area(s, points[i], points[next]));
        found = { ring[i], ring[next], float(double(a) / area), float(double(b) / area) };
        if (holds)
            return found;
        // Outside every face seen so far: keep the first only as an answer for a damaged star.
    }
    return found;
}

namespace {

/// Indices of `records` by increasing order, ties in the order they were done: a radix sort
/// on the bits of the floats, which are never negative.
std::vector<Index> sorted(const FlatArray<CollapseRecord>& records)
{
    constexpr int kBits = 11, kBuckets = 1 << kBits, kPasses = 3;
    struct Item {
        std::uint32_t key;
        Index index;
    };
    const std::size_t n = records.size();
    FlatArray<Item> from, to;
    from.extend(n);
    to.extend(n);
    std::vector<std::array<std::size_t, kBuckets + 1>> start(kPasses);
    const auto bucket = [](Item item, int pass) {
        return (item.key >> (pass * kBits)) & (kBuckets - 1);
    };
    for (std::size_t i = 0; i < n; ++i) {
        std::memcpy(&from[i].key, &records[i].order, sizeof from[i].key);
        from[i].index = Index(i);
        for (int pass = 0; pass < kPasses; ++pass)
            ++start[std::size_t(pass)][bucket(from[i], pass) + 1];
    }
    for (int pass = 0; pass < kPasses; ++pass) {
        auto& place = start[std::size_t(pass)];
        std::partial_sum(place.begin(), place.end(), place.begin());
        for (const Item& item : from)
            to[place[bucket(item, pass)]++] = item;
        std::swap(from, to);
    }
    std::vector<Index> by_order(n);
    std::transform(from.begin(), from.end(), by_order.begin(), [](const Item& item) { return item.index; });
    return by_order;
}

/// Calls visit(i, record) for each split i, coarse to fine. Their order is none in memory: records are fetched ahead, and
/// then what fetch(record) asks for.
template<class Fetch, class Visit>
void in_batches(const std::vector<Index>& by_order, const ParallelFor& parallel,
                const FlatArray<CollapseRecord>& records, Fetch&& fetch, Visit&& visit)
{
    constexpr std::size_t kBatch = 1 << 14, kAhead = 32;
    const std::size_t n = by_order.size();
    run(parallel, (n + kBatch - 1) / kBatch, [&](std::size_t batch) {
        const std::size_t last = std::min(n, (batch + 1) * kBatch);
        for (std::size_t i = batch * kBatch; i < last; ++i) {
            if (i + kAhead < last) {
                const CollapseRecord& later = records[by_order[n - 1 - i - kAhead]];
                __builtin_prefetch(&later);
                __builtin_prefetch(&later.order);
            }
            if (i + kAhead / 2 < last)
                fetch(records[by_order[n - 1 - i - kAhead / 2]]);
            visit(i, records[by_order[n - 1 - i]]);
        }
    });
}

/// Asks for the entry of a name; of the ghost, too: a wrong address does no harm.
void prefetch_entry(const std::vector<Index>& number, Index name)
{
    const std::uintptr_t first = reinterpret_cast<std::uintptr_t>(number.data());
    __builtin_prefetch(reinterpret_cast<const void*>(first + name * sizeof(Index)));
}

/// Number of each name: base vertices first, then one per split, coarse to fine.
std::vector<Index> number_names(std::size_t names, const CollapseSequence& sequence, const std::vector<Index>& by_order,
                                const ParallelFor& parallel)
{
    std::vector<Index> number(names);
    for (std::size_t v = 0; v < sequence.base.size(); ++v)
        number[sequence.base[v].name] = Index(v);
    const Index base = Index(sequence.base.size());
    in_batches(
        by_order, parallel, sequence.records, [&](const CollapseRecord& r) { prefetch_entry(number, r.u); },
        [&](std::size_t i, const CollapseRecord& r) { number[r.u] = base + Index(i); });
    return number;
}

void fill_base(const std::vector<BaseVertex>& base, const std::vector<Index>& number, Hierarchy& h,
               std::vector<Bands>& bands)
{
    for (const BaseVertex& v : base) {
        const Index n = number[v.name];
        h.base_points.push_back(v.p);
        for (std::size_t c = 0; c < bands.size(); ++c)
            bands[c].base.push_back(v.z[c]);
        for (int j = 0; j < v.degree; ++j) {
            const Index a = v.ring.v[std::size_t(j)], b = v.ring.v[std::size_t((j + 1) % v.degree)];
            if (a != kGhost && b != kGhost && n < number[a] && n < number[b])
                h.base_triangles.push_back({ n, number[a], number[b] });
        }
    }
}

/// Sorts the records while other threads get the memory for the hierarchy, which takes as long.
std::vector<Index> sort_and_allocate(const CollapseSequence& sequence, std::size_t vertices,
                                     const ParallelFor& parallel, Hierarchy& h, std::vector<Bands>& bands)
{
    const std::size_t n = sequence.records.size();
    std::vector<Index> by_order;
    run(parallel, 4, [&](std::size_t task) {
        if (task == 0)
            by_order = sorted(sequence.records);
        else if (task == 1)
            h.splits.resize(n);
        else if (task == 2)
            h.stencils.resize(n);
        else {
            h.costs.resize(n);
            h.pixels.resize(vertices);
            for (Bands& b : bands)
                b.details.resize(n);
        }
    });
    return by_order;
}

/// Splits, stencils and costs in coarse-to-fine order; details hold the true intensities of t and u for now.
void fill_splits(const CollapseSequence& sequence, const std::vector<Index>& by_order, const std::vector<Index>& number,
                 const ParallelFor& parallel, Hierarchy& h, std::vector<Bands>& bands)
{
    const std::size_t n = sequence.records.size(), more = bands.size() - 1;
    const auto renumber = [&](Index name) {
        return name == kGhost ? kGhost : number[name];
    };
    const auto fetch = [&](const CollapseRecord& r) {
        const Stencil& k = r.stencil;
        for (Index name : { r.split.s, r.split.vl, r.split.vr, k.at, k.bt, k.au, k.bu })
            prefetch_entry(number, name);
    };
    in_batches(by_order, parallel, sequence.records, fetch, [&](std::size_t i, const CollapseRecord& r) {
        h.splits[i] = { number[r.split.s], renumber(r.split.vl), renumber(r.split.vr), r.split.t, r.split.u };
        h.stencils[i] = { number[r.stencil.s],  number[r.stencil.at], number[r.stencil.bt],
                          number[r.stencil.au], number[r.stencil.bu], r.stencil.wat,
                          r.stencil.wbt,        r.stencil.wau,        r.stencil.wbu };
        h.costs[i] = r.order;
        bands[0].details[i] = { r.zt, r.zu };
        for (std::size_t c = 0; c < more; ++c)
            bands[c + 1].details[i] = sequence.more[by_order[n - 1 - i] * more + c];
    });
}

/// Pixels of the finest mesh: of vertices by their number, and those between.
void fill_pixels(const Finest& finest, const std::vector<Index>& number, Hierarchy& h)
{
    constexpr std::size_t kBatch = 1 << 16;
    run(finest.parallel, (number.size() + kBatch - 1) / kBatch, [&](std::size_t batch) {
        for (std::size_t name = batch * kBatch; name < std::min(number.size(), (batch + 1) * kBatch); ++name)
            h.pixels[number[name]] = finest.initial ? finest.initial->pixels[name] : Index(name);
    });
    if (number.size() == h.mesh_pixels())
        return;
    std::vector<Triangle> triangles(finest.initial->triangles());
    for (std::size_t e = 0; e < finest.initial->corners.size(); ++e)
        triangles[e / 3][e % 3] = finest.initial->pixels[finest.initial->corners[e]];
    h.between = pixel_stencils(h.mesh_width(), h.mesh_height(), h.pixels, triangles, finest.parallel);
}

}  // namespace

Status assemble(int width, int height, const Finest& finest, CollapseSequence&& sequence, Index base_faces,
                Hierarchy& hierarchy, std::vector<Bands>& bands)
{
    Hierarchy h;
    std::vector<Bands> b(std::size_t(sequence.channels));
    h.width = width;
    h.height = height;
    std::vector<Index> number;
    {
        const CollapseSequence done = std::move(sequence);
        const std::size_t names = finest.initial ? finest.initial->pixels.size() : h.mesh_pixels();
        const std::vector<Index> by_order = sort_and_allocate(done, names, finest.parallel, h, b);
        number = number_names(names, done, by_order, finest.parallel);
        fill_base(done.base, number, h, b);
        fill_splits(done, by_order, number, finest.parallel, h, b);
    }
    fill_pixels(finest, number, h);
    std::vector<Index>().swap(number);
    for (std::size_t c = 0; c < b.size(); ++c)
        values_to_details(h, finest.guide.channels[c].samples, b[c]);
    const Level level = h.level_of_faces(base_faces);
    Status status = level > 0 ? rebase(h, b, level, finest.parallel) : Status();
    if (status) {
        hierarchy = std::move(h);
        bands = std::move(b);
    }
    return status;
}

}  // namespace pimg
