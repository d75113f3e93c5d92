// SPDX-License-Identifier: BSD-3-Clause
// Detail enhancement. Either amplifies what the low-pass of a given strength removes, or, as in the paper (section
// 4.1), the details of a range of splits.
#include <pimg/detail/parallel.h>
#include <pimg/imagebufalgo.h>

#include <algorithm>
#include <cmath>

#include <pimg/detail/format.h>

#include "base/curve_text.h"
#include "frame/image_filter.h"
#include "frame/positive_light.h"
#include "ops/channel_sweep.h"
#include "source/samples/above_noise.h"

namespace pimg {
inline namespace PIMG_ABI {
namespace ImageBufAlgo {

namespace {

/// A place in the sequence of splits: a share of all, or a number of splits if above 1.
Level place(const Hierarchy& hierarchy, double position)
{
    const double splits = position > 1.0 ? position : position * hierarchy.levels();
    return Level(std::lround(std::min(splits, double(hierarchy.levels()))));
}

/// A point of a curve of gains: from this split on, the gain changes linearly to that of the next point.
struct GainPoint {
    Level split;
    float gain;
};
using Curve = std::vector<GainPoint>;

bool parse_gains(const Hierarchy& hierarchy, const std::string& text, Curve& curve, std::string& error)
{
    std::vector<CurvePoint> points;
    bool fine = parse_curve(text, points);
    double before = 0.0;
    for (const CurvePoint& point : points) {
        fine = fine && point.position >= before && point.position <= 1e9 && point.value >= 0.0 && point.value <= 100.0;
        before = point.position;
    }
    if (!fine) {
        error = format("curve=\"{}\": expected position:gain,... with positions that do not fall and gains of 0 to 100",
                       text);
        return false;
    }
    for (const CurvePoint& point : points)
        curve.push_back({ place(hierarchy, point.position), float(point.value) });
    return true;
}

/// What the curve adds to a gain of 1, for every split and, as the last entry, for the residual. The curve is linear
/// between its points and constant outside. Of several points at one place the last counts from there on.
std::vector<float> gains_less_one(const Curve& curve, Level levels)
{
    std::vector<float> more(levels + 1, curve.front().gain - 1.0f);
    for (std::size_t k = 0; k < curve.size(); ++k) {
        const GainPoint from = curve[k];
        const GainPoint to = k + 1 < curve.size() ? curve[k + 1] : GainPoint { levels + 1, from.gain };
        const double slope =
            (double(to.gain) - double(from.gain)) / std::max(double(to.split) - double(from.split), 1.0);
        for (Level i = from.split; i < to.split; ++i)
            more[i] = float(double(from.gain) - 1.0 + slope * double(i - from.split));
    }
    return more;
}

/// A curve that is `gain` between two places and 1 elsewhere.
Curve step_curve(Level from, Level to, float gain, Level levels)
{
    if (from > to)
        return { { 0, 1.0f } };
    Curve curve { { 0, 1.0f }, { from, 1.0f }, { from, gain }, { to, gain } };
    if (to < levels)
        curve.push_back({ to, 1.0f });
    return curve;
}

/// Adds the light of the source to what is added to one channel, if that is not the result already. What is left is at
/// least a quarter of the light of the source at every pixel of a scene, however much its details are amplified.
void add_source(const ProgressiveImage::Data& data, int channel, int exponent, const ParallelFor& parallel,
                std::vector<float>& samples, bool is_result)
{
    const float* source = static_cast<const float*>(data.source.localpixels()) + channel;
    const std::size_t stride = std::size_t(data.source.nchannels());
    const bool shades = is_scene_linear(data);
    in_batches(parallel, samples.size(), [&](std::size_t i) {
        const float light = source[i * stride];
        float sample = exponent != 0 ? std::ldexp(samples[i], exponent) : samples[i];
        if (!is_result)
            sample += light;
        samples[i] = shades && light > 0.0f ? shaded(sample, light) : sample;
    });
}

/// The picture with its details amplified. What that adds is added to the picture rather than synthesised with it, so that
/// a gain of 1 changes no bit.
void enhance_by(ProgressiveImage::Data& data, const PlannedChannels& planned, const ChannelBands& channels,
                const std::vector<float>& more, const ParallelFor& parallel, Channels& results)
{
    sweep_details(data, planned, more, parallel, results);
    for (std::size_t c = 0; c < results.size(); ++c) {
        const std::vector<float>& residual = channels.bands[c].residual;
        if (more.back() != 0.0f && !residual.empty())
            in_batches(parallel, residual.size(), [&](std::size_t i) { results[c][i] += more.back() * residual[i]; });
        crop_to_picture(data.hierarchy, results[c]);
        add_source(data, data.colour.channel(int(c)), channels.exponent, parallel, results[c], false);
    }
}

/// Leaves the details of splits that are no more than noise as they are, where they would be amplified.
bool calm(ProgressiveImage::Data& data, float denoise, const ParallelFor& parallel, std::vector<float>& more,
          std::string& error)
{
    if (denoise == 0.0f || std::none_of(more.begin(), more.end(), [](float m) { return m > 0.0f; }))
        return true;
    const auto visibility = data.visibility(denoise, parallel, error);
    if (visibility == nullptr)
        return false;
    for (std::size_t i = 0; i < visibility->size(); ++i)
        if (more[i] > 0.0f)
            more[i] *= (*visibility)[i];
    return true;
}

bool by_position(ProgressiveImage::Data& data, const DetailEnhanceOptions& options, const ParallelFor& parallel,
                 Channels& results, std::string& error)
{
    const Level levels = data.hierarchy.levels();
    Curve curve;
    if (options.curve.empty())
        curve = step_curve(place(data.hierarchy, double(options.from)), place(data.hierarchy, double(options.to)),
                           options.gain, levels);
    else if (!parse_gains(data.hierarchy, options.curve, curve, error))
        return false;
    const ChannelBands* channels = data.channel_bands(parallel, error);
    const auto planned = channels != nullptr ? data.planned_channels(parallel, error) : nullptr;
    if (planned == nullptr)
        return false;
    std::vector<float> more = gains_less_one(curve, levels);
    if (!calm(data, options.denoise, parallel, more, error))
        return false;
    enhance_by(data, *planned, *channels, more, parallel, results);
    return true;
}

/// The standard deviation of the noise of every pixel, in the units of `smoothing`.
std::vector<float> noise_of_pixels(const SmoothingData& smoothing, const LogLuminance& luminance, const Colour& colour,
                                   const NoiseModel& noise, const ParallelFor& parallel)
{
    constexpr float kLn2 = 0.6931472f;
    constexpr float kSlope = 1.0f / 2.2f;  ///< relative change of an encoded sample for that of its light, about
    const NoiseTable table(noise);
    const Channels& samples = smoothing.source.samples;
    std::vector<float> deviations(luminance.guide.samples.size());
    in_batches(parallel, deviations.size(), [&](std::size_t i) {
        const float stops = table.at(luminance.guide.samples[i]) / kUnitsPerStop;
        float squares = 0.0f;
        for (const std::vector<float>& channel : samples)
            squares += channel[i] * channel[i];
        const float sample = std::sqrt(squares / float(samples.size()));
        deviations[i] = smoothing.log ? stops : stops * kLn2 * sample * (colour.encoded() ? kSlope : 1.0f);
    });
    return deviations;
}

/// Takes back what was added to noise.
bool calm_pixels(ProgressiveImage::Data& data, const DetailEnhanceOptions& options, const SmoothingData& smoothing,
                 const ParallelFor& parallel, Channels& results, std::string& error)
{
    if (options.gain <= 1.0f || options.denoise == 0.0f || data.hierarchy.mesh_pixels() != data.spec.image_pixels())
        return true;
    const LogBands* log = data.log_bands(parallel, error);
    if (log == nullptr)
        return false;
    const NoiseModel noise = data.noise(parallel).times(options.denoise);
    if (noise.none())
        return true;
    const Channels& samples = smoothing.source.samples;
    for (std::size_t c = 0; c < results.size(); ++c)  // now the texture that is amplified
        in_batches(parallel, results[c].size(),
                   [&](std::size_t i) { results[c][i] = (results[c][i] - samples[c][i]) / (options.gain - 1.0f); });
    const std::vector<float> share =
        share_above_noise(results, noise_of_pixels(smoothing, log->luminance, data.colour, noise, parallel),
                          data.hierarchy.mesh_width(), data.hierarchy.mesh_height(), parallel);
    for (std::size_t c = 0; c < results.size(); ++c)
        in_batches(parallel, results[c].size(), [&](std::size_t i) {
            results[c][i] = samples[c][i] + (options.gain - 1.0f) * share[i] * results[c][i];
        });
    return true;
}

bool by_strength(ProgressiveImage::Data& data, const DetailEnhanceOptions& options, const ParallelFor& parallel,
                 Channels& results, std::string& error)
{
    const DetailEnhanceOptions defaults;
    if (options.from != defaults.from || options.to != defaults.to || !options.curve.empty()) {
        error = "from, to and curve: expected without strength, noise and log";
        return false;
    }
    const std::shared_ptr<const SmoothingData> kept = data.smoothing(options.log, parallel);
    const SmoothingData& smoothing = *kept;
    SmoothingOptions smoothing_options;
    smoothing_options.parallel = parallel;
    smoothing_options.strength = find_strength(options, smoothing);
    if (smoothing_options.strength == 0.0f || options.gain == 1.0f) {
        results = source_channels(data);
        return true;
    }
    enhance(data.hierarchy, smoothing.source, smoothing_options, options.gain, results);
    if (!calm_pixels(data, options, smoothing, parallel, results, error))
        return false;
    to_picture(data.hierarchy, smoothing, results);
    for (std::size_t c = 0; c < results.size(); ++c)
        add_source(data, data.colour.channel(int(c)), 0, parallel, results[c], true);
    return true;
}

}  // namespace

bool on_hierarchy::detail_enhance(ImageBuf& dst, const ProgressiveImage& src, const DetailEnhanceOptions& options,
                                  ROI roi, int nthreads)
{
    const auto make = [&](ProgressiveImage::Data& data, const ParallelFor& parallel, PictureResult& result,
                          std::string& error) {
        const bool by_contrast = options.strength >= 0.0f || options.noise >= 0.0f || options.log;
        if (!(by_contrast ? by_strength : by_position)(data, options, parallel, result.channels, error))
            return false;
        bound_below(data, parallel, result.channels);
        return true;
    };
    return filter_picture({ dst, src, roi, nthreads }, options, ResultType::floating, make);
}

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
