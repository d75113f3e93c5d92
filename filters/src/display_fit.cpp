// SPDX-License-Identifier: BSD-3-Clause
#include "display_fit.h"

#include <algorithm>
#include <cmath>

namespace pimg {

namespace {

/// Range a picture should have on a display, between its 0.5 % quantiles: that of a good photographic print.
constexpr float kDisplayStops = 7.0f;
constexpr float kMostContrast = 2.0f;  ///< more would show noise
constexpr double kRangeQuantile = 0.005;
constexpr double kWhiteQuantile = 0.999;
constexpr double kMeanLuminance = 0.2;  ///< the picture is as light as that on the whole

}  // namespace

Shoulder::Shoulder(float white) : m_white(std::max(white, 1.000001f))
{
    const float t = (m_white - kKnee) / (1.0f - kKnee);
    m_inverse_square = 1.0f / (t * t);
}

StopHistogram::StopHistogram(const std::vector<float>& values, float units, float offset,
                             const std::vector<float>& guide, float floor, const ParallelFor& parallel)
    : m_bins(std::size_t(2.0f * kRange * kBinsPerStop))
{
    constexpr std::size_t kTasks = 16;
    const float scale = kBinsPerStop / units, shift = (offset + kRange) * kBinsPerStop;
    const float last = float(m_bins.size() - 1);
    std::vector<std::vector<std::uint32_t>> bins(kTasks);
    run(parallel, kTasks, [&](std::size_t task) {
        bins[task].resize(m_bins.size());
        const std::size_t end = values.size() * (task + 1) / kTasks;
        for (std::size_t i = values.size() * task / kTasks; i < end; ++i)
            if (guide[i] > floor)
                ++bins[task][std::size_t(std::clamp(values[i] * scale + shift, 0.0f, last))];
    });
    for (const std::vector<std::uint32_t>& part : bins)
        for (std::size_t i = 0; i < m_bins.size(); ++i) {
            m_bins[i] += part[i];
            m_count += part[i];
        }
}

float StopHistogram::quantile(double q) const
{
    const double wanted = q * double(m_count);
    double before = 0.0;
    for (std::size_t i = 0; i < m_bins.size(); ++i) {
        if (m_bins[i] > 0 && before + m_bins[i] >= wanted)
            return (float(i) + float((wanted - before) / m_bins[i])) / kBinsPerStop - kRange;
        before += m_bins[i];
    }
    return 0.0f;
}

float shoulder_white(const HdrCompressOptions& options)
{
    const float stops = options.contrast * std::log2(options.white / options.key) + options.exposure;
    return std::max(kMiddleGrey * std::exp2(std::min(stops, 100.0f)), 1.0f);
}

namespace {

/// Mean of the cube root of display luminance, which is lightness but for constants.
double mean_lightness(const StopHistogram& histogram, const HdrCompressOptions& options)
{
    const Shoulder shoulder(shoulder_white(options));
    const float key = std::log2(options.key);
    double sum = 0.0;
    histogram.for_each([&](float stops, std::uint32_t count) {
        const float y = kMiddleGrey * std::exp2(std::min(options.contrast * (stops - key), 100.0f));
        sum += double(std::cbrt(shoulder(y))) * count;
    });
    return sum / double(histogram.count());
}

}  // namespace

void find_display_fit(const StopHistogram& histogram, HdrCompressOptions& options)
{
    if (options.contrast <= 0.0f) {
        // As much as fills the display, but never beyond the scene's own contrast.
        const float stops = histogram.quantile(1.0 - kRangeQuantile) - histogram.quantile(kRangeQuantile);
        const float most = std::min(kMostContrast, 1.0f / std::max(options.s0, 1e-3f));
        options.contrast = std::min(kDisplayStops / std::max(stops, 1e-3f), most);
    }
    if (options.white <= 0.0f)
        options.white = std::exp2(histogram.empty() ? 0.0f : histogram.quantile(kWhiteQuantile));
    if (options.key > 0.0f)
        return;
    options.key = 1.0f;
    if (histogram.empty())
        return;
    // Lightness falls as the key rises.
    HdrCompressOptions trial = options;
    trial.exposure = 0.0f;
    float low = -120.0f, high = 120.0f;
    for (int i = 0; i < 40; ++i) {
        const float middle = 0.5f * (low + high);
        trial.key = std::exp2(middle);
        (mean_lightness(histogram, trial) > std::cbrt(kMeanLuminance) ? low : high) = middle;
    }
    options.key = std::exp2(0.5f * (low + high));
}

}  // namespace pimg
