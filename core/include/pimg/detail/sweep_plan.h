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

#include <pimg/bands.h>

namespace pimg {

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

class SweepPlan {
public:
    /// Takes as long as ten plain sweeps and keeps 44 bytes a split. Pictures a few pixels wide or high are left as
    /// they are.
    explicit SweepPlan(const Hierarchy& hierarchy, const ParallelFor& parallel = {});

    /// Sweeps in the hierarchy's own order, without the time and memory that making a plan takes: right when there are
    /// only one or two sweeps. The hierarchy must outlive the result.
    static SweepPlan unplanned(const Hierarchy& hierarchy);

    Level levels() const { return m_levels; }
    PlannedSplit split(Level i) const;

    /// Length of a sweep's values; not every place is a vertex's.
    std::size_t places() const { return m_places; }

    /// Details in the order of the plan.
    std::vector<Detail> in_order(const std::vector<Detail>& details, const ParallelFor& parallel = {}) const;

    /// Puts the values of the base vertices in place, times `factor`.
    void set_base(const std::vector<float>& base, float factor, float* values) const;

    /// Calls body(first, last) for ranges that together are all splits, each after those it depends on, and several
    /// at once if `parallel` has threads for them. When a body throws, the other threads stop soon, and the exception
    /// is thrown again.
    void for_splits(const ParallelFor& parallel, const std::function<void(Level first, Level last)>& body) const;

    /// Sweeps such a range; detail_of(i) returns the detail of the plan's split i.
    template<class DetailOf>
    void sweep(Level first, Level last, float* values, DetailOf&& detail_of) const;

    /// From places to mesh pixels (row-major), with those between vertices interpolated. `hierarchy` is the plan's.
    void scatter(const Hierarchy& hierarchy, const float* values, float* samples,
                 const ParallelFor& parallel = {}) const;

    std::size_t memory() const;

private:
    SweepPlan() = default;

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

template<class DetailOf>
void SweepPlan::sweep(Level first, Level last, float* values, DetailOf&& detail_of) const
{
    if (m_unplanned != nullptr) {
        sweep_splits(*m_unplanned, first, last, values, detail_of);
        return;
    }
    constexpr std::ptrdiff_t kAhead = 2048;  // bytes: past the end of a page, where the processor's own guesses stop
    for (Level i = first; i < last; ++i) {
        const PlannedSplit& k = m_splits[i];
        __builtin_prefetch(reinterpret_cast<const char*>(&k) + kAhead);
        const SplitPair predicted = predict(k, values);
        const Detail d = detail_of(i);
        values[k.u] = predicted.u + d.u;
        values[k.s] = predicted.t + d.t;
    }
}

}  // namespace pimg
