// SPDX-License-Identifier: BSD-3-Clause
#include "source/contrast_envelope.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pimg {

PlannedBands::PlannedBands(SweepPlan&& made, const Bands& bands, const ParallelFor& parallel)
    : plan(std::move(made)),
      base(bands.base),
      details(plan.in_order(bands.details, parallel))
{
}

std::vector<float> contrast_envelope(const PlannedBands& bands, float coherence, float range,
                                     const ParallelFor& parallel)
{
    const SweepPlan& plan = bands.plan;
    std::vector<float> envelope(plan.levels()), values(plan.places());
    std::vector<float> contrast(plan.places(), range);  // of the vertices, as far as they exist
    plan.set_base(bands.base, 1.0f, values.data());
    plan.for_splits(parallel, [&](Level first, Level last) {
        plan.sweep(first, last, values.data(), [&](Level i) {
            const PlannedSplit k = plan.split(i);
            const Detail d = bands.details[i];
            const auto [least, most] =
                std::minmax({ values[k.s], values[k.at], values[k.bt], values[k.au], values[k.bu] });
            const float own = std::max({ std::fabs(d.t), std::fabs(d.u), most - least });
            const float s = contrast[k.s];
            const float t = s + k.wat * (contrast[k.at] - s) + k.wbt * (contrast[k.bt] - s);
            const float u = s + k.wau * (contrast[k.au] - s) + k.wbu * (contrast[k.bu] - s);
            envelope[i] = own + coherence * (0.5f * (t + u) - own);
            contrast[k.s] = contrast[k.u] = envelope[i];
            return d;
        });
    });
    return envelope;
}

void compress(const PlannedBands& bands, const DetailGain& gain, const std::vector<float>* envelope,
              const ParallelFor& parallel, float* values)
{
    bands.plan.set_base(bands.base, gain.s0, values);
    bands.plan.for_splits(parallel, [&](Level first, Level last) {
        constexpr Level kBatch = 512;  // of compressed details, between the vectors and the sweep
        Detail compressed[kBatch];
        for (Level begin = first, end; begin < last; begin = end) {
            end = std::min(begin + kBatch, last);
            gain.apply(&bands.details[begin], envelope ? &(*envelope)[begin] : nullptr, end - begin, compressed);
            bands.plan.sweep(begin, end, values, [&](Level i) { return compressed[i - begin]; });
        }
    });
}

void compress_residual(const Hierarchy& hierarchy, const Bands& bands, const DetailGain& gain, float coherence,
                       const std::vector<float>& picture, std::vector<float>& compressed)
{
    if (bands.residual.empty())
        return;
    // At the vertices the residual is rounding only.
    constexpr std::size_t kBatch = 256;
    const std::vector<PixelStencil>& between = hierarchy.between;
    for (std::size_t first = 0; first < between.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, between.size() - first);
        float gains[kBatch];
        for (std::size_t i = 0; i < count; ++i) {
            const PixelStencil& k = between[first + i];
            const auto [least, most] = std::minmax({ picture[k.a], picture[k.b], picture[k.c] });
            const float own = std::fabs(bands.residual[k.pixel]);
            gains[i] = coherence > 0.0f ? std::max(own, most - least) : own;
        }
        gain.apply(gains, count);
        for (std::size_t i = 0; i < count; ++i)
            compressed[between[first + i].pixel] += gains[i] * bands.residual[between[first + i].pixel];
    }
}

}  // namespace pimg
