// SPDX-License-Identifier: BSD-3-Clause
#include "ops/display_fit.h"

#include <algorithm>
#include <cmath>

namespace pimg {
inline namespace PIMG_ABI {

namespace {
// Chosen on nine photographs (docs/look.md), by eye beside other tone mappers and by their measures: more stops of the base
// or a higher gain of details make more of what is seen, and less keeps highlights and reversals of gradients in bounds.

/// The base is scaled so that the picture would fill this many stops; what a display has beyond that goes to the
/// details.
constexpr float kCompressedStops = 5.3f;
constexpr float kLeastS0 = 0.05f;
constexpr float kDmaxOfRange = 0.9f;  ///< largest detail as a share of the dynamic range
constexpr float kMostDetail = 4.5f;   ///< gain of the smallest details

/// White is as light as the lightest of a thousand cells, and this many stops above the lightest of twenty: where much is
/// light, such as the sky of a landscape, it keeps its colour and its clouds.
constexpr double kWhiteQuantile = 0.999, kLightQuantile = 0.95;
constexpr float kStopsAboveLight = 1.5f;
/// The shoulder reaches 1 that far above white, which leaves room for the details of what is white.
constexpr float kRoomAboveWhite = 1.5f;

/// Mean lightness (the cube root of luminance) of a scene half way between dark and light, and how it follows others.
constexpr double kMeanLightness = 0.57, kMeanOfKey = 0.15, kLeastMean = 0.4, kMostMean = 0.7;

constexpr float kBlack = 0.003f;   ///< display luminance of the darkest of the base: 2.7 L*
constexpr float kMostToe = 0.13f;  ///< beyond that the contrast at middle grey would be 1.4 times that of the base

}  // namespace

void find_compression(float range, HdrCompressOptions& options)
{
    if (options.dmax <= 0.0f)
        options.dmax = kDmaxOfRange * std::max(range, 1e-3f);
    if (options.s0 <= 0.0f)
        options.s0 = std::clamp(kCompressedStops / range_of(options), kLeastS0, 1.0f);
    if (options.detail <= 0.0f)
        options.detail = !options.fit || options.coherence <= 0.0f ? 1.0f : kMostDetail;
}

float range_of(const HdrCompressOptions& options)
{
    return options.dmax / kDmaxOfRange;
}

ToneCurve tone_curve(const HdrCompressOptions& options)
{
    const float white_stops =
        std::min(options.contrast * std::log2(options.white / options.key) + options.exposure, 100.0f);
    const float white = kMiddleGrey * std::exp2(white_stops), head = kRoomAboveWhite * white;
    const float darkest = white * std::exp2(-options.contrast * options.s0 * range_of(options));
    const float toe = std::clamp(darkest * darkest / kBlack - darkest, 0.0f, kMostToe);
    const float reaches_most = head * head / (head + toe);
    // What is no brighter than the display needs no shoulder, and is not made brighter either.
    const float most = std::min(options.peak / kSdrWhiteNits, std::max(reaches_most, 1.0f));
    return ToneCurve(toe, reaches_most, most);
}

float find_scene_key(const Overview& overview)
{
    std::vector<Weighted> lit;
    double sum = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < overview.log.size(); ++i)
        if (overview.lit[i]) {
            lit.push_back({ overview.log[i], overview.weight[i] });
            sum += double(overview.weight[i]) * double(overview.log[i]);
            weights += double(overview.weight[i]);
        }
    const float least = quantile(lit, 0.01), most = quantile(lit, 0.99);
    return most - least > 1e-3f ? std::clamp((float(sum / weights) - least) / (most - least), 0.0f, 1.0f) : 0.5f;
}

namespace {

/// Mean of the cube root of display luminance, which is lightness but for constants. `scratch` is as large as the
/// cells.
double mean_lightness(const CompressedCells& cells, const HdrCompressOptions& options, std::vector<float>& scratch)
{
    const float offset = std::log2(kMiddleGrey) - options.contrast * std::log2(options.key);
    std::transform(cells.begin(), cells.end(), scratch.begin(),
                   [&](const Weighted& cell) { return options.contrast * cell.value + offset; });
    lightness_in_place(tone_curve(options), scratch.data(), scratch.size());
    double sum = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        sum += double(cells[i].weight) * double(scratch[i]);
        weights += double(cells[i].weight);
    }
    return sum / weights;
}

}  // namespace

void find_exposure(CompressedCells cells, float scene_key, float dark, HdrCompressOptions& options)
{
    if (options.white <= 0.0f)
        options.white = std::exp2(cells.empty() ? dark
                                                : std::max(quantile(cells, kWhiteQuantile),
                                                           quantile(cells, kLightQuantile) + kStopsAboveLight));
    if (options.key > 0.0f)
        return;
    if (cells.empty()) {  // only black, or single bright pixels on it
        options.key = kMiddleGrey * std::exp2(dark);
        return;
    }
    const double wanted = std::clamp(kMeanLightness + kMeanOfKey * (double(scene_key) - 0.5), kLeastMean, kMostMean);
    // Lightness falls as the key rises.
    HdrCompressOptions trial = options;
    std::vector<float> scratch(cells.size());
    trial.exposure = 0.0f;
    trial.peak = kSdrWhiteNits;  // the same picture for every display
    const auto [least, most] = std::minmax_element(
        cells.begin(), cells.end(), [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
    float low = least->value - 16.0f, high = most->value + 16.0f;
    for (int i = 0; i < 24; ++i) {
        const float middle = 0.5f * (low + high);
        trial.key = std::exp2(middle);
        (mean_lightness(cells, trial, scratch) > wanted ? low : high) = middle;
    }
    options.key = std::exp2(0.5f * (low + high));
}

}  // namespace PIMG_ABI
}  // namespace pimg
