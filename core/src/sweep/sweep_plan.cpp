// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/sweep_plan.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>

#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kTileBits = 6;
constexpr Index kTile = 1 << kTileBits;  ///< side of a tile, in pixels
constexpr Level kTogether = 16384;   ///< splits of the first stage: with fewer vertices, faces are larger than tiles
constexpr Level kTaskSplits = 1024;  ///< at least, of several tiles if need be

/// Where the value of every mesh pixel is: tile by tile, row by row.
class TiledRaster {
public:
    explicit TiledRaster(const Hierarchy& h)
        : m_width(Index(h.mesh_width())),
          m_across((m_width + kTile - 1) / kTile),
          m_down((Index(h.mesh_height()) + kTile - 1) / kTile)
    {
    }

    Index tiles() const { return m_across * m_down; }
    std::size_t count() const { return std::size_t(tiles()) << (2 * kTileBits); }
    Index of(Index pixel) const { return of(pixel % m_width, pixel / m_width); }
    Index of(Index x, Index y) const
    {
        const Index tile = (y >> kTileBits) * m_across + (x >> kTileBits);
        return (((tile << kTileBits) + (y & (kTile - 1))) << kTileBits) + (x & (kTile - 1));
    }
    static Index tile_of(Index place) { return place >> (2 * kTileBits); }

private:
    Index m_width, m_across, m_down;
};

/// Stage and tile in which something was done.
struct StageAndTile {
    static constexpr Index kTileBitsPacked = 20, kAnyTile = (1u << kTileBitsPacked) - 1, kFirstTile = kAnyTile - 1;
    static constexpr Index kLastStage = (1u << (32 - kTileBitsPacked)) - 1;

    Index packed = kFirstTile;  ///< stage 0

    StageAndTile() = default;
    StageAndTile(Index stage, Index tile) : packed((stage << kTileBitsPacked) | tile) { }
    Index stage() const { return packed >> kTileBitsPacked; }
    Index tile() const { return packed & kAnyTile; }
    /// The first stage in which `other`, a tile, may build on it.
    Index stage_for(Index other) const { return stage() + (tile() != other); }
    /// The later of two; of two in one stage, that stage and any tile. Without branches, which would be as good as
    /// random.
    void join(StageAndTile other)
    {
        const Index any = other.packed | kAnyTile;
        const bool is_before = packed < (other.packed & ~kAnyTile) || packed == other.packed;
        packed = std::max(packed, is_before ? other.packed : any);
    }
};

/// Prefetches the entries of a split's vertices.
template<class T>
void prefetch(const std::vector<T>& of_vertices, const Stencil& k)
{
    for (const Index v : { k.s, k.at, k.bt, k.au, k.bu })
        __builtin_prefetch(&of_vertices[v]);
}

/// When a value was last written, and last read.
struct LastUse {
    StageAndTile write, read;
};

/// Decides in which stage and tile each split is done. Splits come in the hierarchy's order.
class Scheduler {
public:
    explicit Scheduler(std::size_t vertices) : m_last_uses(vertices) { }

    const std::vector<LastUse>& last_uses() const { return m_last_uses; }

    StageAndTile schedule(const Stencil& k, Index u, Index tile)
    {
        Index stage = std::max(m_last_uses[k.s].write.stage_for(tile), m_last_uses[k.s].read.stage_for(tile));
        for (const Index v : { k.at, k.bt, k.au, k.bu })
            stage = std::max(stage, m_last_uses[v].write.stage_for(tile));
        // From here on one split is done after the other. Only a hierarchy made to that end needs so many stages.
        if (stage >= StageAndTile::kLastStage) {
            stage = StageAndTile::kLastStage;
            tile = StageAndTile::kFirstTile;
        }
        const StageAndTile now(stage, tile);
        for (const Index v : { k.at, k.bt, k.au, k.bu })
            m_last_uses[v].read.join(now);
        m_last_uses[k.s] = m_last_uses[u] = { now, now };
        return now;
    }

private:
    std::vector<LastUse> m_last_uses;
};

/// A split and when it is done.
struct Scheduled {
    StageAndTile when;
    Level split;
};

std::vector<Scheduled> schedule(const Hierarchy& h, const std::vector<Index>& places)
{
    constexpr Level kAhead = 16;
    const Level n = h.levels();
    std::vector<Scheduled> all(n);
    Scheduler scheduler(h.vertices());
    for (Level i = 0; i < n; ++i) {
        if (i % kTogether == 0)
            stop_point();
        __builtin_prefetch(reinterpret_cast<const char*>(&h.stencils[i]) + 4096);
        if (i + kAhead < n)
            prefetch(scheduler.last_uses(), h.stencils[i + kAhead]);
        const Index u = h.base_vertices() + i;
        all[i] = { i < kTogether ? StageAndTile()
                                 : scheduler.schedule(h.stencils[i], u, TiledRaster::tile_of(places[u])),
                   i };
    }
    return all;
}

/// Sorts by key(when); those of one key stay as they were.
template<class Key>
void sort_by(std::size_t keys, Key&& key, std::vector<Scheduled>& all)
{
    std::vector<Level> start(keys + 1);
    std::vector<Scheduled> from(all.size());
    from.swap(all);
    for (const Scheduled& s : from)
        ++start[key(s.when) + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    for (const Scheduled& s : from)
        all[start[key(s.when)]++] = s;
}

/// All splits by stage, then tile, then as they were.
std::vector<Scheduled> in_planned_order(const Hierarchy& h, const std::vector<Index>& places, Index tiles)
{
    std::vector<Scheduled> all = schedule(h, places);
    sort_by(
        tiles + 1, [tiles](StageAndTile when) { return std::min(when.tile(), tiles); }, all);
    sort_by(
        StageAndTile::kLastStage + 1, [](StageAndTile when) { return when.stage(); }, all);
    return all;
}

/// Whole tiles of one stage each.
std::vector<SweepTask> tasks_of(const std::vector<Scheduled>& all)
{
    std::vector<SweepTask> tasks;
    std::size_t before = 0;  // tasks of earlier stages
    for (Level i = 0; i < Level(all.size()); ++i) {
        const bool fresh_stage = i == 0 || all[i].when.stage() != all[i - 1].when.stage();
        const bool fresh_tile = fresh_stage || all[i].when.tile() != all[i - 1].when.tile();
        if (fresh_stage)
            before = tasks.size();
        if (fresh_stage || (fresh_tile && i - tasks.back().first >= kTaskSplits))
            tasks.push_back({ i, i, before });
        tasks.back().last = i + 1;
    }
    return tasks;
}

}  // namespace

SweepPlan::SweepPlan(const Hierarchy& h, const ParallelFor& parallel)
{
    const TiledRaster grid(h);
    if (grid.count() > 4 * h.mesh_pixels() + kTile * kTile) {  // tiles would be all but empty
        *this = unplanned(h);
        return;
    }
    std::vector<Index> places(h.vertices());
    in_batches(parallel, places.size(), [&](std::size_t v) { places[v] = grid.of(h.pixels[v]); });
    const std::vector<Scheduled> all = in_planned_order(h, places, grid.tiles());
    m_levels = h.levels();
    m_places = grid.count();
    m_base.assign(places.begin(), places.begin() + h.base_vertices());
    m_tasks = tasks_of(all);
    m_order.resize(m_levels);
    m_splits.reset(new PlannedSplit[m_levels]);  // not cleared before it is filled: threads share the page faults
    in_batches(parallel, m_levels, [&](std::size_t j) {
        constexpr std::size_t kAhead = 16;
        if (j + 2 * kAhead < m_levels)
            __builtin_prefetch(&h.stencils[all[j + 2 * kAhead].split]);
        if (j + kAhead < m_levels)
            prefetch(places, h.stencils[all[j + kAhead].split]);
        const Level i = all[j].split;
        const Stencil& k = h.stencils[i];
        m_order[j] = i;
        m_splits[j] = { places[k.s],  places[k.at], places[k.bt],
                        places[k.au], places[k.bu], places[h.base_vertices() + i],
                        k.wat,        k.wbt,        k.wau,
                        k.wbu };
    });
}

SweepPlan SweepPlan::unplanned(const Hierarchy& hierarchy)
{
    SweepPlan plan;
    plan.m_unplanned = &hierarchy;
    plan.m_levels = hierarchy.levels();
    plan.m_places = hierarchy.vertices();
    plan.m_base.resize(hierarchy.base_vertices());
    std::iota(plan.m_base.begin(), plan.m_base.end(), Index(0));
    return plan;
}

void SweepPlan::set_base(const std::vector<float>& base, float factor, float* values) const
{
    for (std::size_t v = 0; v < base.size(); ++v)
        values[m_base[v]] = factor * base[v];
}

void SweepPlan::for_splits(const ParallelFor& parallel, const std::function<void(Level, Level)>& body) const
{
    // Threads take tasks in order. One whose task is of a stage that has not begun waits until others have finished
    // their tasks of the stage before. Waking threads anew for each stage would take longer than a stage.
    std::atomic<std::size_t> next { 0 }, done { 0 };
    std::atomic<bool> failed { false };  // a body has thrown: what waits for it would wait for ever
    const std::size_t workers = std::min<std::size_t>(m_tasks.size(), 64);
    if (m_unplanned != nullptr) {
        for (Level first = 0; first < m_levels; first += kTogether) {
            stop_point();
            body(first, std::min(first + kTogether, m_levels));
        }
        return;
    }
    run(parallel, workers, [&](std::size_t) {
        for (std::size_t task; (task = next.fetch_add(1, std::memory_order_relaxed)) < m_tasks.size();) {
            for (int waits = 0; done.load(std::memory_order_acquire) < m_tasks[task].after; ++waits) {
                if (failed.load(std::memory_order_relaxed))
                    return;
                if (waits > 1000)
                    std::this_thread::yield();
            }
            try {
                stop_point();
                body(m_tasks[task].first, m_tasks[task].last);
            } catch (...) {
                failed = true;
                throw;
            }
            done.fetch_add(1, std::memory_order_acq_rel);
        }
    });
}

void SweepPlan::for_ranges(const ParallelFor& parallel, const std::function<void(Level, Level)>& body) const
{
    run(parallel, batches_of(m_levels), [&](std::size_t batch) {
        const Level first = Level(batch * kBatch);
        body(first, std::min(m_levels, first + Level(kBatch)));
    });
}

void SweepPlan::for_runs(const Hierarchy& h, const ParallelFor& parallel, const CopyRun& copy) const
{
    if (m_unplanned != nullptr) {
        in_batches(parallel, h.vertices(), [&](std::size_t v) { copy(v, h.pixels[v], 1); });
        return;
    }
    constexpr std::size_t kRows = 16;
    const TiledRaster places(h);
    const Index width = Index(h.mesh_width()), height = Index(h.mesh_height());
    run(parallel, (height + kRows - 1) / kRows, [&](std::size_t task) {
        for (Index y = Index(task * kRows); y < std::min(height, Index((task + 1) * kRows)); ++y)
            for (Index x = 0; x < width; x += kTile)
                copy(places.of(x, y), std::size_t(y) * width + x, std::min(kTile, width - x));
    });
}

void SweepPlan::scatter(const Hierarchy& h, const float* values, float* samples, const ParallelFor& parallel) const
{
    if (m_unplanned != nullptr) {
        pimg::scatter(h, values, samples, parallel);
        return;
    }
    for_runs(h, parallel, [&](std::size_t place, std::size_t pixel, std::size_t count) {
        std::copy_n(values + place, count, samples + pixel);
    });
    interpolate_between(h, samples, parallel);
}

std::size_t SweepPlan::memory() const
{
    return m_base.capacity() * sizeof(Index) + m_order.capacity() * sizeof(PlannedSplit)
        + m_order.capacity() * sizeof(Level) + m_tasks.capacity() * sizeof(SweepTask);
}

}  // namespace PIMG_ABI
}  // namespace pimg
