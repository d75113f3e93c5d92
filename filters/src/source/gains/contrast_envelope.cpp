// SPDX-License-Identifier: BSD-3-Clause
#include "source/gains/contrast_envelope.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <pimg/colour.h>

namespace pimg {
inline namespace PIMG_ABI {

PlannedBands::PlannedBands(std::shared_ptr<const SweepPlan> made, const Bands& bands, const ParallelFor& parallel)
    : shared(std::move(made)),
      plan(*shared),
      base(bands.base),
      ordered(plan.is_planned() ? plan.in_order(bands.details, parallel) : std::vector<Detail>()),
      details(plan.is_planned() ? ordered.data() : bands.details.data())
{
}

namespace {

/// In standard deviations of the noise: contrasts up to kNoise are noise, and those from kClearlyMore on are not.
/// Measured on pictures of noise alone, half of the splits have a contrast below 3, nine in ten below 4.9, and 99 in
/// 100 below 9.8. That hardly changes from the finest level to levels whose vertices stand for kPeaks pixels, because a
/// height field keeps the peaks of its noise. From there on it falls, to half at some hundred pixels.
constexpr float kNoise = 3.7f, kClearlyMore = 8.0f, kPeaks = 16.0f;

/// The share of the noise of a pixel that is in vertices that stand for so many pixels.
float noise_share(float pixels)
{
    return std::min(std::sqrt(std::sqrt(kPeaks / pixels)), 1.0f);
}

float visibility(float contrast, float noise)
{
    const float share = std::clamp((contrast - kNoise * noise) / ((kClearlyMore - kNoise) * noise), 0.0f, 1.0f);
    return share * share * (3.0f - 2.0f * share);
}

/// Fills in contrasts and, of the pixels of the splits if there are any, visibilities.
void measure(const PlannedBands& bands, const EnvelopeOptions& options, const std::vector<float>& pixels,
             const ParallelFor& parallel, Envelope& envelope)
{
    const SweepPlan& plan = bands.plan;
    const NoiseTable noise(options.noise);
    envelope.contrast.resize(plan.levels());
    envelope.visibility.resize(pixels.size());
    std::vector<float> values(plan.places());
    std::vector<float> contrast(plan.places(), options.range);  // of the vertices that exist so far
    plan.set_base(bands.base, 1.0f, values.data());
    plan.for_splits(parallel, [&](Level first, Level last) {
        plan.sweep(first, last, values.data(), [&](Level i) {
            const PlannedSplit k = plan.split(i);
            const Detail d = bands.details[i];
            // Vertices without weight are those of one of several faces that would do.
            const auto used = [&](Index v, float weight) {
                return values[weight != 0.0f ? v : k.s];
            };
            const auto [least, most] = std::minmax(
                { values[k.s], used(k.at, k.wat), used(k.bt, k.wbt), used(k.au, k.wau), used(k.bu, k.wbu) });
            const float own = std::max({ std::fabs(d.t), std::fabs(d.u), most - least });
            const float s = contrast[k.s];
            const float t = s + k.wat * (contrast[k.at] - s) + k.wbt * (contrast[k.bt] - s);
            const float u = s + k.wau * (contrast[k.au] - s) + k.wbu * (contrast[k.bu] - s);
            const float e = own + options.coherence * (0.5f * (t + u) - own);
            envelope.contrast[i] = contrast[k.s] = contrast[k.u] = e;
            if (!pixels.empty())
                envelope.visibility[i] = visibility(own, noise_share(pixels[i]) * noise.at(values[k.s]));
            return d;
        });
    });
}

}  // namespace

Envelope contrast_envelope(const PlannedBands& bands, const EnvelopeOptions& options, const ParallelFor& parallel)
{
    Envelope envelope;
    const bool has_contrasts = options.coherence > 0.0f, has_noise = has_contrasts && !options.noise.none();
    std::vector<float> pixels;
    if (has_noise)
        pixels = pixels_of_splits(bands.plan);
    if (options.diagonal > 0.0f)
        envelope.size = feature_sizes(bands.plan, bands.base, bands.details, options.diagonal, options.range, parallel);
    if (has_contrasts)
        measure(bands, options, pixels, parallel, envelope);
    return envelope;
}

void compress(const PlannedBands& bands, const DetailGain& gain, const SizeGains& sizes, const Envelope& envelope,
              const ParallelFor& parallel, float* values)
{
    const auto from = [](const std::vector<float>& numbers, Level i) {
        return numbers.empty() ? nullptr : numbers.data() + i;
    };
    bands.plan.set_base(bands.base, gain.s0, values);
    bands.plan.for_splits(parallel, [&](Level first, Level last) {
        constexpr Level kBatch = 512;  // details that are compressed together, before the sweep takes them
        Detail compressed[kBatch];
        float factors[kBatch];
        for (Level begin = first, end; begin < last; begin = end) {
            end = std::min(begin + kBatch, last);
            SplitTraits traits { from(envelope.contrast, begin), from(envelope.visibility, begin), nullptr };
            if (!envelope.size.empty()) {
                for (Level i = begin; i < end; ++i)
                    factors[i - begin] = sizes.of(envelope.size[i]);
                exp2_in_place(factors, end - begin);
                traits.factor = factors;
            }
            gain.apply(&bands.details[begin], traits, end - begin, compressed);
            bands.plan.sweep(begin, end, values, [&](Level i) { return compressed[i - begin]; });
        }
    });
}

void compress_residual(const Hierarchy& hierarchy, const Bands& bands, const DetailGain& gain, float coherence,
                       const std::vector<float>& picture, std::vector<float>& compressed)
{
    if (bands.residual.empty())
        return;
    // At pixels that are vertices the residual is only rounding.
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

}  // namespace PIMG_ABI
}  // namespace pimg
