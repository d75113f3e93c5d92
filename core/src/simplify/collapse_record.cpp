// SPDX-License-Identifier: BSD-3-Clause
#include "simplify/collapse_record.h"

#include <algorithm>
#include <utility>

#include "mesh/pixel_stencils.h"
#include <pimg/detail/analyse.h>
#include <pimg/detail/parallel.h>

#include "simplify/key_sort.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Indices of `records` by increasing order, ties in the order they were done.
std::vector<Index> sorted(const CollapseRecords& records, const ParallelFor& parallel)
{
    FlatArray<KeyedIndex> items;
    items.extend(records.size());
    in_batches(parallel, records.size(), [&](std::size_t i) { items[i] = { records.rest()[i].order, Index(i) }; });
    return pimg::sorted(std::move(items), parallel);
}

/// Calls visit(i, part) for the splits i of a batch, coarse to fine; `parts` are those of their records. These are scattered
/// in memory, so they are prefetched; some splits later fetch(part) prefetches what visit() will need besides.
template<class Part, class Fetch, class Visit>
void for_batch(std::size_t batch, const std::vector<Index>& by_order, const FlatArray<Part>& parts, Fetch&& fetch,
               Visit&& visit)
{
    constexpr std::size_t kAhead = 32;
    const std::size_t n = by_order.size(), last = std::min(n, (batch + 1) * kBatch);
    for (std::size_t i = batch * kBatch; i < last; ++i) {
        if (i + kAhead < last) {
            const Part& later = parts[by_order[n - 1 - i - kAhead]];
            __builtin_prefetch(&later);
            __builtin_prefetch(reinterpret_cast<const char*>(&later + 1) - 1);
        }
        if (i + kAhead / 2 < last)
            fetch(parts[by_order[n - 1 - i - kAhead / 2]]);
        visit(i, parts[by_order[n - 1 - i]]);
    }
}

/// Prefetches the entry of a name, also for the ghost, which has none: a wrong address does no harm here.
void prefetch_entry(const std::vector<Index>& number, Index name)
{
    const std::uintptr_t first = reinterpret_cast<std::uintptr_t>(number.data());
    __builtin_prefetch(reinterpret_cast<const void*>(first + name * sizeof(Index)));
}

/// Allocates one of several parts of the hierarchy's memory, all but the splits. Clearing it takes about as long as filling
/// it, so the parts are tasks for several threads.
void allocate(std::size_t part, std::size_t splits, std::size_t vertices, Hierarchy& h, std::vector<Bands>& bands)
{
    if (part == 0)
        h.stencils.resize(splits);
    else if (part == 1) {
        h.costs.resize(splits);
        h.pixels.resize(vertices);
    } else
        bands[part - 2].details.resize(splits);
}

/// Number of each name: base vertices first, then one per split, coarse to fine. The memory of the hierarchy is
/// allocated at the same time, by other threads.
std::vector<Index> number_names(std::size_t names, const CollapseSequence& sequence, const std::vector<Index>& by_order,
                                const ParallelFor& parallel, Hierarchy& h, std::vector<Bands>& bands)
{
    std::vector<Index> number(names);
    for (std::size_t v = 0; v < sequence.base.size(); ++v)
        number[sequence.base[v].name] = Index(v);
    const Index base = Index(sequence.base.size());
    const std::size_t parts = 2 + bands.size();
    run(parallel, parts + batches_of(by_order.size()), [&](std::size_t task) {
        if (task < parts)
            allocate(task, by_order.size(), names, h, bands);
        else
            for_batch(
                task - parts, by_order, sequence.records.rest(),
                [&](const CollapseRecords::Rest& r) { prefetch_entry(number, r.u); },
                [&](std::size_t i, const CollapseRecords::Rest& r) { number[r.u] = base + Index(i); });
    });
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

/// Stencils and costs in coarse-to-fine order; details hold the true intensities of t and u for now.
void fill_stencils(const CollapseSequence& sequence, const std::vector<Index>& by_order,
                   const std::vector<Index>& number, const ParallelFor& parallel, Hierarchy& h,
                   std::vector<Bands>& bands)
{
    using Rest = CollapseRecords::Rest;
    const std::size_t n = by_order.size(), more = bands.size() - 1;
    const auto fetch = [&](const Rest& r) {
        const Stencil& k = r.stencil;
        for (Index name : { k.s, k.at, k.bt, k.au, k.bu })
            prefetch_entry(number, name);
    };
    const auto fill = [&](std::size_t i, const Rest& r) {
        const Stencil& k = r.stencil;
        h.stencils[i] = { number[k.s], number[k.at], number[k.bt], number[k.au], number[k.bu],
                          k.wat,       k.wbt,        k.wau,        k.wbu };
        h.costs[i] = r.order;
        bands[0].details[i] = { r.zt, r.zu };
        for (std::size_t c = 0; c < more; ++c) {
            const SplitPair z = sequence.more[by_order[n - 1 - i] * more + c];
            bands[c + 1].details[i] = { z.t, z.u };
        }
    };
    run(parallel, batches_of(n),
        [&](std::size_t batch) { for_batch(batch, by_order, sequence.records.rest(), fetch, fill); });
}

void fill_splits(const FlatArray<Split>& splits, const std::vector<Index>& by_order, const std::vector<Index>& number,
                 const ParallelFor& parallel, Hierarchy& h)
{
    const auto renumber = [&](Index name) {
        return name == kGhost ? kGhost : number[name];
    };
    const auto fetch = [&](const Split& split) {
        for (Index name : { split.s, split.vl, split.vr })
            prefetch_entry(number, name);
    };
    const auto fill = [&](std::size_t i, const Split& split) {
        h.splits[i] = { number[split.s], renumber(split.vl), renumber(split.vr), split.t, split.u };
    };
    h.splits.resize(splits.size());
    run(parallel, batches_of(splits.size()),
        [&](std::size_t batch) { for_batch(batch, by_order, splits, fetch, fill); });
}

/// Pixels of the finest mesh: of vertices by their number, and those between.
void fill_pixels(const Finest& finest, const std::vector<Index>& number, Hierarchy& h)
{
    in_batches(finest.parallel, number.size(), [&](std::size_t name) {
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
    CollapseSequence done = std::move(sequence);
    const std::size_t names = finest.initial ? finest.initial->pixels.size() : h.mesh_pixels();
    std::vector<Index> by_order = sorted(done.records, finest.parallel);
    std::vector<Index> number = number_names(names, done, by_order, finest.parallel, h, b);
    fill_base(done.base, number, h, b);
    fill_stencils(done, by_order, number, finest.parallel, h, b);
    done.records.free_rest();
    done.more = {};
    fill_splits(done.records.splits(), by_order, number, finest.parallel, h);
    fill_pixels(finest, number, h);
    run(finest.parallel, 1 + b.size(), [&](std::size_t task) {
        if (task > 0) {
            subtract_predictions(h, finest.guide.channels[task - 1].samples, b[task - 1]);
            return;
        }
        // Freeing memory takes as long as the work on a channel, so it is a task, too.
        done = {};
        std::vector<Index>().swap(by_order);
        std::vector<Index>().swap(number);
    });
    const Level level = h.level_of_faces(base_faces);
    Status status = level > 0 ? rebase(h, b, level, finest.parallel) : Status();
    if (status) {
        hierarchy = std::move(h);
        bands = std::move(b);
    }
    return status;
}

}  // namespace PIMG_ABI
}  // namespace pimg
