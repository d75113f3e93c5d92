// SPDX-License-Identifier: BSD-3-Clause
// The engine: building, analysing, sweeping. Items are vertices or splits.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>
#include <map>

#include <pimg/bands.h>
#include <pimg/detail/sweep_plan.h>
#include <pimg/simplify.h>

#include "pictures.h"

namespace {

struct Built {
    pimg::Hierarchy hierarchy;
    std::vector<pimg::Bands> bands;
    pimg::SimplifyStats stats;
};

pimg::Status simplify(int size, Built& built)
{
    const pimg::Guide guide { size, size, { { bench::guide(size).data() } } };
    return pimg::simplify(guide, {}, built.hierarchy, built.bands, &built.stats);
}

const Built& built(int size)
{
    static std::map<int, Built> all;
    Built& b = all[size];
    if (b.hierarchy.empty())
        simplify(size, b);
    return b;
}

void build(benchmark::State& state)
{
    const int size = int(state.range(0));
    bench::guide(size);
    Built b;
    for (auto _ : state) {
        b.hierarchy = {};
        b.bands.clear();
        const pimg::Status status = simplify(size, b);
        if (!status) {
            state.SkipWithError(status.error().c_str());
            return;
        }
    }
    const double pixels = double(size) * size;
    state.SetItemsProcessed(state.iterations() * std::int64_t(size) * size);
    state.counters["bytes_per_pixel"] = double(b.stats.peak_bytes) / pixels;
    state.counters["stored_per_pixel"] = double(b.hierarchy.memory()) / pixels;
}
BENCHMARK(build)->Arg(512)->Arg(1024)->Arg(2048)->Arg(4096)->Unit(benchmark::kMillisecond);

void analyse(benchmark::State& state)
{
    const int size = int(state.range(0));
    const Built& b = built(size);
    std::vector<pimg::Bands> bands;
    for (auto _ : state) {
        const pimg::Status status = pimg::analyse(b.hierarchy, { bench::guide(size).data() }, bands);
        if (!status) {
            state.SkipWithError(status.error().c_str());
            return;
        }
    }
    state.SetItemsProcessed(state.iterations() * b.hierarchy.levels());
}
BENCHMARK(analyse)->Arg(512)->Arg(2048)->Unit(benchmark::kMillisecond);

/// A gain that depends on the detail, as hdr_compress has.
pimg::Detail halved(pimg::Detail d)
{
    const float gain = std::fabs(d.t) + std::fabs(d.u) > 8.0f ? 0.5f : 0.9f;
    return { gain * d.t, gain * d.u };
}

void sweep(benchmark::State& state)
{
    const Built& b = built(int(state.range(0)));
    std::vector<float> values(b.hierarchy.vertices());
    for (auto _ : state) {
        pimg::sweep(b.hierarchy, b.bands[0], values.data(), b.hierarchy.levels(),
                    [](pimg::Level, pimg::Detail d) { return halved(d); });
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * b.hierarchy.levels());
}
BENCHMARK(sweep)->Arg(512)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond);

/// The same by a plan, one thread.
void planned_sweep(benchmark::State& state)
{
    const Built& b = built(int(state.range(0)));
    const pimg::SweepPlan plan(b.hierarchy);
    const std::vector<pimg::Detail> details = plan.in_order(b.bands[0].details);
    std::vector<float> values(plan.places());
    for (auto _ : state) {
        plan.set_base(b.bands[0].base, 1.0f, values.data());
        plan.for_splits({}, [&](pimg::Level first, pimg::Level last) {
            plan.sweep(first, last, values.data(), [&](pimg::Level i) { return halved(details[i]); });
        });
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * b.hierarchy.levels());
}
BENCHMARK(planned_sweep)->Arg(512)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond);

void make_plan(benchmark::State& state)
{
    const Built& b = built(int(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(pimg::SweepPlan(b.hierarchy));
    state.SetItemsProcessed(state.iterations() * b.hierarchy.levels());
}
BENCHMARK(make_plan)->Arg(1024)->Unit(benchmark::kMillisecond);

/// What a retune reads and writes, copied: planned split, detail, contrast, values by place and by pixel, guide, RGB in
/// and out. Items are pixels.
void copy(benchmark::State& state)
{
    const std::size_t pixels = std::size_t(state.range(0) * state.range(0));
    const std::size_t bytes = sizeof(pimg::PlannedSplit) + sizeof(pimg::Detail) + 10 * sizeof(float);
    std::vector<char> from(pixels * bytes / 2, 1), to(from.size());
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), from.size());
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(pixels));
}
BENCHMARK(copy)->Arg(512)->Arg(1024)->Unit(benchmark::kMillisecond);

}  // namespace
