// SPDX-License-Identifier: BSD-3-Clause
// An order of the splits made for sweeping: the same arithmetic as sweep(), near in memory and for many threads.
//
// The values of a sweep are stored tile by tile, a tile being a square of pixels, and splits are done tile by tile. A
// split that needs a value made in another tile waits for the next stage; so the tiles of one stage do not depend on
// each other. The first splits, whose faces are larger than tiles, are a stage of their own.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include <hwy/cache_control.h>

#include <pimg/bands.h>
#include <pimg/detail/lanes.h>

namespace pimg {
inline namespace PIMG_ABI {

/// A split by the places of its vertices' values.
struct PlannedSplit {
    Index s, at, bt, au, bu, u;
    float wat, wbt, wau, wbu;
};

/// The splits [first, last), which depend on no other task but the first `after`.
struct SweepTask {
    Level first, last;
    std::size_t after;
};

class PIMG_EXPORT_DETAIL SweepPlan {
public:
    /// Takes as long as ten plain sweeps and keeps 44 bytes a split. Pictures a few pixels wide or high are left as
    /// they are.
    explicit SweepPlan(const Hierarchy& hierarchy, const ParallelFor& parallel = {});

    /// Sweeps in the hierarchy's own order, without the time and memory that making a plan takes: right when there are
    /// only one or two sweeps. The hierarchy must outlive the result.
    static SweepPlan unplanned(const Hierarchy& hierarchy);
    bool is_planned() const { return m_unplanned == nullptr; }

    Level levels() const { return m_levels; }
    PlannedSplit split(Level i) const;
    Level level_of(Level i) const { return m_unplanned != nullptr ? i : m_order[i]; }  ///< its number in the hierarchy
    Index base_place(Index v) const { return m_base[v]; }                              ///< of a base vertex

    /// Length of a sweep's values; not every place is a vertex's.
    std::size_t places() const { return m_places; }

    /// What there is one of for each split, such as details, in the order of the plan.
    template<class T>
    std::vector<T> in_order(const std::vector<T>& of_splits, const ParallelFor& parallel = {}) const;

    /// Puts the values of the base vertices in place, times `factor`.
    void set_base(const std::vector<float>& base, float factor, float* values) const;

    /// Calls body(first, last) for ranges that together are all splits, each after those it depends on, and several
    /// at once if `parallel` has threads for them. When a body throws, the other threads stop soon, and the exception
    /// is thrown again.
    void for_splits(const ParallelFor& parallel, const std::function<void(Level first, Level last)>& body) const;

    /// Calls visit(i, split) for every split of such a range; split is a PlannedSplit.
    template<class Visit>
    void visit_splits(Level first, Level last, Visit&& visit) const;

    /// Sweeps such a range; detail_of(i) returns the detail of the plan's split i.
    template<class DetailOf>
    void sweep(Level first, Level last, float* values, DetailOf&& detail_of) const;

    /// From places to mesh pixels (row-major), with those between vertices interpolated. `hierarchy` is the plan's.
    void scatter(const Hierarchy& hierarchy, const float* values, float* samples,
                 const ParallelFor& parallel = {}) const;

    /// The same for values of C channels in Lanes; channel c goes to samples[c].
    template<int C>
    void scatter_channels(const Hierarchy& hierarchy, const float* values, float* const* samples,
                          const ParallelFor& parallel = {}) const;

    std::size_t memory() const;

private:
    SweepPlan() = default;

    /// Calls copy(place, pixel, count) for runs of pixels in a row whose places follow each other.
    using CopyRun = std::function<void(std::size_t place, std::size_t pixel, std::size_t count)>;
    void for_runs(const Hierarchy& hierarchy, const ParallelFor& parallel, const CopyRun& copy) const;

    /// Calls body(first, last) for ranges that together are all splits, in no order.
    void for_ranges(const ParallelFor& parallel, const std::function<void(Level first, Level last)>& body) const;

    Level m_levels = 0;
    std::size_t m_places = 0;
    const Hierarchy* m_unplanned = nullptr;  ///< whose order is used as it is; null: that of m_splits
    std::vector<Index> m_base;               ///< places of the base vertices
    std::vector<Level> m_order;              ///< number of each split in the hierarchy
    std::unique_ptr<PlannedSplit[]> m_splits;
    std::vector<SweepTask> m_tasks;
};

inline PlannedSplit SweepPlan::split(Level i) const
{
    if (m_unplanned == nullptr)
        return m_splits[i];
    const Stencil& k = m_unplanned->stencils[i];
    return { k.s, k.at, k.bt, k.au, k.bu, m_unplanned->base_vertices() + i, k.wat, k.wbt, k.wau, k.wbu };
}

template<class T>
std::vector<T> SweepPlan::in_order(const std::vector<T>& of_splits, const ParallelFor& parallel) const
{
    if (m_unplanned != nullptr)
        return of_splits;
    std::vector<T> ordered(of_splits.size());
    for_ranges(parallel, [&](Level first, Level last) {
        constexpr Level kAhead = 24;
        for (Level j = first; j < last; ++j) {
            if (j + kAhead < m_levels)
                hwy::Prefetch(&of_splits[m_order[j + kAhead]]);
            ordered[j] = of_splits[m_order[j]];
        }
    });
    return ordered;
}

template<class Visit>
void SweepPlan::visit_splits(Level first, Level last, Visit&& visit) const
{
    if (m_unplanned != nullptr) {
        for (Level i = first; i < last; ++i)
            visit(i, split(i));
        return;
    }
    constexpr std::ptrdiff_t kAhead = 2048;  // bytes: past the end of a page, where the processor's own guesses stop
    for (Level i = first; i < last; ++i) {
        const PlannedSplit& k = m_splits[i];
        hwy::Prefetch(reinterpret_cast<const char*>(&k) + kAhead);
        visit(i, k);
    }
}

template<class DetailOf>
void SweepPlan::sweep(Level first, Level last, float* values, DetailOf&& detail_of) const
{
    if (m_unplanned != nullptr) {
        sweep_splits(*m_unplanned, first, last, values, detail_of);
        return;
    }
    visit_splits(first, last, [&](Level i, const PlannedSplit& k) {
        const SplitPair predicted = predict(k, values);
        const Detail d = detail_of(i);
        values[k.u] = predicted.u + d.u;
        values[k.s] = predicted.t + d.t;
    });
}

template<int C>
void SweepPlan::scatter_channels(const Hierarchy& hierarchy, const float* values, float* const* samples,
                                 const ParallelFor& parallel) const
{
    for_runs(hierarchy, parallel, [&](std::size_t place, std::size_t pixel, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i)
            for (int c = 0; c < C; ++c)
                samples[c][pixel + i] = values[(place + i) * std::size_t(kLanes<C>) + std::size_t(c)];
    });
    for (int c = 0; c < C; ++c)
        interpolate_between(hierarchy, samples[c], parallel);
}

}  // namespace PIMG_ABI
}  // namespace pimg
