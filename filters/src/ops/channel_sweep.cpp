// SPDX-License-Identifier: BSD-3-Clause
#include "ops/channel_sweep.h"

#include <algorithm>

#include <pimg/detail/lanes.h>
#include <pimg/detail/parallel.h>

#include "frame/positive_light.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// One pass over the splits in which the values of C channels lie side by side.
template<int C>
class ChannelSweep {
public:
    ChannelSweep(ProgressiveImage::Data& data, const PlannedChannels& planned)
        : m_hierarchy(data.hierarchy),
          m_planned(planned),
          m_plan(*planned.plan),
          m_scratch(data, m_plan.places() * kLanes<C>),
          m_values((*m_scratch).data())
    {
    }

    /// value(c, v) is that of base vertex v.
    template<class Value>
    void set_base(Value&& value)
    {
        for (Index v = 0; v < m_hierarchy.base_vertices(); ++v)
            set_lanes<C>(lanes_of<C>([&](int c) { return value(std::size_t(c), v); }), m_plan.base_place(v), m_values);
    }

    void add_details(const std::vector<float>& gains, const ParallelFor& parallel)
    {
        const Detail* details[C];
        std::copy_n(m_planned.details.begin(), C, details);
        m_plan.for_splits(parallel, [&](Level first, Level last) {
            m_plan.visit_splits(first, last, [&](Level i, const PlannedSplit& k) {
                constexpr Level kAhead = 24, kDetailsAhead = 128;
                if (i + kAhead < last)
                    __builtin_prefetch(&gains[m_plan.level_of(i + kAhead)]);
                for (const Detail* of_channel : details)
                    __builtin_prefetch(of_channel + i + kDetailsAhead);
                const Lanes<C> gain = in_all_lanes<C>(gains[m_plan.level_of(i)]);
                const auto [t, u] = predicted(k);
                set_lanes<C>(t + gain * lanes_of<C>([&](int c) { return details[c][i].t; }), k.s, m_values);
                set_lanes<C>(u + gain * lanes_of<C>([&](int c) { return details[c][i].u; }), k.u, m_values);
            });
        });
    }

    /// Vertices of `level` get the values they have there as soon as they exist: the splits before it change nothing else.
    void predict_from(Level level, const Channels& values, const ParallelFor& parallel)
    {
        const Index made = m_hierarchy.base_vertices();
        m_plan.for_splits(parallel, [&](Level first, Level last) {
            m_plan.visit_splits(first, last, [&](Level i, const PlannedSplit& k) {
                const Level split = m_plan.level_of(i);
                if (split < level) {
                    set_lanes<C>(lanes_of<C>([&](int c) { return values[std::size_t(c)][made + split]; }), k.u,
                                 m_values);
                    return;
                }
                const auto [t, u] = predicted(k);
                set_lanes<C>(t, k.s, m_values);
                set_lanes<C>(u, k.u, m_values);
            });
        });
    }

    void scatter(const ParallelFor& parallel, Channels& results) const
    {
        float* samples[C];
        for (std::size_t c = 0; c < C; ++c) {
            results[c].resize(m_hierarchy.mesh_pixels());
            samples[c] = results[c].data();
        }
        m_plan.scatter_channels<C>(m_hierarchy, m_values, samples, parallel);
    }

private:
    struct Pair {
        Lanes<C> t, u;
    };

    Pair predicted(const PlannedSplit& k) const
    {
        const Lanes<C> s = lanes_at<C>(m_values, k.s);
        const auto between = [&](Index a, Index b, float wa, float wb) {
            return interpolate_lanes<C>(s, lanes_at<C>(m_values, a), lanes_at<C>(m_values, b), wa, wb);
        };
        return { between(k.at, k.bt, k.wat, k.wbt), between(k.au, k.bu, k.wau, k.wbu) };
    }

    const Hierarchy& m_hierarchy;
    const PlannedChannels& m_planned;
    const SweepPlan& m_plan;
    Scratch m_scratch;
    float* m_values;
};

/// Calls body(number) with the number of channels, 1 to 3, as a constant.
template<class Body>
void with_channels(std::size_t channels, Body&& body)
{
    if (channels == 3)
        body(std::integral_constant<int, 3>());
    else if (channels == 2)
        body(std::integral_constant<int, 2>());
    else
        body(std::integral_constant<int, 1>());
}

}  // namespace

void sweep_details(ProgressiveImage::Data& data, const PlannedChannels& planned, const std::vector<float>& gains,
                   const ParallelFor& parallel, Channels& results)
{
    results.resize(planned.details.size());
    with_channels(results.size(), [&](auto channels) {
        ChannelSweep<channels> sweep(data, planned);
        sweep.set_base([](std::size_t, Index) { return 0.0f; });
        sweep.add_details(gains, parallel);
        sweep.scatter(parallel, results);
    });
}

Channels values_of_level(const ProgressiveImage::Data& data, const ChannelBands& channels, Level level,
                         const ParallelFor& parallel)
{
    Channels values(channels.bands.size());
    run(parallel, values.size(),
        [&](std::size_t c) { values[c] = values_at(data.hierarchy, channels.bands[c], level); });
    if (is_scene_linear(data) && level < data.hierarchy.levels())
        shade_vertices(data, channels.exponent, level, parallel, values);
    return values;
}

void predict_finest(ProgressiveImage::Data& data, const PlannedChannels& planned, Level level, const Channels& values,
                    const ParallelFor& parallel, Channels& results)
{
    results.resize(values.size());
    with_channels(results.size(), [&](auto channels) {
        ChannelSweep<channels> sweep(data, planned);
        sweep.set_base([&](std::size_t c, Index v) { return values[c][v]; });
        sweep.predict_from(level, values, parallel);
        sweep.scatter(parallel, results);
    });
}

}  // namespace PIMG_ABI
}  // namespace pimg
