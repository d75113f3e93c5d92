// SPDX-License-Identifier: BSD-3-Clause
#include "ops/display_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "source/overview.h"

namespace pimg {

namespace {

/// The base is scaled so that the picture would fill this many stops; what a display has beyond that goes to the
/// details.
constexpr float kCompressedStops = 4.6f;
constexpr float kLeastS0 = 0.05f;
constexpr float kDmaxOfRange = 0.5f;   ///< largest detail as a share of the dynamic range
constexpr float kMostContrast = 1.4f;  ///< of what is compressed: 6.4 stops, about those of a good photographic print
constexpr double kWhiteQuantile = 0.999;
constexpr double kMeanLuminance = 0.2;  ///< the picture is as light as that on the whole

}  // namespace

void find_compression(float range, HdrCompressOptions& options)
{
    if (options.dmax <= 0.0f)
        options.dmax = kDmaxOfRange * std::max(range, 1e-3f);
    if (options.s0 <= 0.0f)
        options.s0 = std::clamp(kCompressedStops / range_of(options), kLeastS0, 1.0f);
    if (options.contrast <= 0.0f)  // never beyond the scene's own
        options.contrast = std::min(kMostContrast, 1.0f / std::max(options.s0, 1e-3f));
}

float range_of(const HdrCompressOptions& options)
{
    return options.dmax / kDmaxOfRange;
}

float shoulder_white(const HdrCompressOptions& options)
{
    const float stops = options.contrast * std::log2(options.white / options.key) + options.exposure;
    return std::max(kMiddleGrey * std::exp2(std::min(stops, 100.0f)), 1.0f);
}

namespace {

/// Mean of the cube root of display luminance, which is lightness but for constants. `scratch` is as large as the
/// overview.
double mean_lightness(const std::vector<float>& overview, const HdrCompressOptions& options,
                      std::vector<float>& scratch)
{
    const float offset = std::log2(kMiddleGrey) - options.contrast * std::log2(options.key);
    std::transform(overview.begin(), overview.end(), scratch.begin(),
                   [&](float stops) { return options.contrast * stops + offset; });
    lightness_in_place(Shoulder(shoulder_white(options)), scratch.data(), scratch.size());
    return std::accumulate(scratch.begin(), scratch.end(), 0.0) / double(scratch.size());
}

}  // namespace

void find_exposure(std::vector<float> overview, float dark, HdrCompressOptions& options)
{
    std::sort(overview.begin(), overview.end());
    if (options.white <= 0.0f)
        options.white = std::exp2(overview.empty() ? dark : quantile(overview, kWhiteQuantile));
    if (options.key > 0.0f)
        return;
    if (overview.empty()) {  // only black, or single bright pixels on it
        options.key = kMiddleGrey * std::exp2(dark);
        return;
    }
    // Lightness falls as the key rises.
    HdrCompressOptions trial = options;
    std::vector<float> scratch(overview.size());
    trial.exposure = 0.0f;
    float low = overview.front() - 16.0f, high = overview.back() + 16.0f;
    for (int i = 0; i < 24; ++i) {
        const float middle = 0.5f * (low + high);
        trial.key = std::exp2(middle);
        (mean_lightness(overview, trial, scratch) > std::cbrt(kMeanLuminance) ? low : high) = middle;
    }
    options.key = std::exp2(0.5f * (low + high));
}

}  // namespace pimg
