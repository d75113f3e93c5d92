// SPDX-License-Identifier: BSD-3-Clause
// Detail enhancement. Either amplifies what the low-pass of a given strength removes, or, as in the paper (section
// 4.1), the details of a range of splits.
#include <pimg/detail/parallel.h>
#include <pimg/imagebufalgo.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

#include "frame/image_filter.h"
#include "frame/positive_light.h"

namespace pimg {
namespace ImageBufAlgo {

namespace {

/// A place in the sequence of splits: a share of all, or a number of splits if above 1.
Level place(const Hierarchy& hierarchy, double position)
{
    const double splits = position > 1.0 ? position : position * hierarchy.levels();
    return Level(std::lround(std::min(splits, double(hierarchy.levels()))));
}

/// A point of a curve: from this split on, the gain changes linearly to that of the next point.
struct CurvePoint {
    Level split;
    float gain;
};
using Curve = std::vector<CurvePoint>;

bool parse_numbers(std::string_view text, double& position, double& gain)
{
    const std::size_t colon = text.find(':');
    if (colon == text.npos)
        return false;
    const auto number = [](std::string_view word, double& value) {
        const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
        return status == std::errc() && end == word.data() + word.size();
    };
    return number(text.substr(0, colon), position) && number(text.substr(colon + 1), gain) && position >= 0.0
        && position <= 1e9 && gain >= 0.0 && gain <= 100.0;
}

bool parse_curve(const Hierarchy& hierarchy, const std::string& text, Curve& curve, std::string& error)
{
    double before = 0.0;
    for (const std::string& word : OIIO::Strutil::splits(text, ",")) {
        double position = 0.0, gain = 0.0;
        if (!parse_numbers(word, position, gain) || position < before) {
            error = format(
                "curve=\"{}\": expected position:gain,... with positions that do not fall and gains of 0 to 100", text);
            return false;
        }
        curve.push_back({ place(hierarchy, before = position), float(gain) });
    }
    return true;
}

/// What the curve adds to a gain of 1, for every split and, as the last entry, for the residual. The curve is linear
/// between its points and constant outside. Of several points at one place the last counts from there on.
std::vector<float> gains_less_one(const Curve& curve, Level levels)
{
    std::vector<float> more(levels + 1, curve.front().gain - 1.0f);
    for (std::size_t k = 0; k < curve.size(); ++k) {
        const CurvePoint from = curve[k];
        const CurvePoint to = k + 1 < curve.size() ? curve[k + 1] : CurvePoint { levels + 1, from.gain };
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

/// One channel with its details amplified. Only what the gains add is synthesised, and then added to the picture, so
/// that a gain of 1 changes no bit.
std::vector<float> enhanced(const ProgressiveImage::Data& data, int channel, const Bands& bands, int exponent,
                            const std::vector<float>& more)
{
    std::vector<float> values(data.hierarchy.vertices(), 0.0f);
    const Detail* details = bands.details.data();
    const auto first = std::find_if(more.begin(), more.end() - 1, [](float m) { return m != 0.0f; });
    sweep_splits(data.hierarchy, Level(first - more.begin()), data.hierarchy.levels(), values.data(), [&](Level i) {
        return Detail { more[i] * details[i].t, more[i] * details[i].u };
    });
    const std::vector<float>* residual = more.back() != 0.0f ? &bands.residual : nullptr;
    std::vector<float> samples = to_picture(data.hierarchy, values.data(), exponent, residual, more.back());
    const float* p = static_cast<const float*>(data.source.localpixels()) + channel;
    for (float& sample : samples) {
        sample += *p;
        p += data.source.nchannels();
    }
    return samples;
}

bool by_position(ProgressiveImage::Data& data, const DetailEnhanceOptions& options, const ParallelFor& parallel,
                 Channels& results, std::string& error)
{
    const Level levels = data.hierarchy.levels();
    Curve curve;
    if (options.curve.empty())
        curve = step_curve(place(data.hierarchy, double(options.from)), place(data.hierarchy, double(options.to)),
                           options.gain, levels);
    else if (!parse_curve(data.hierarchy, options.curve, curve, error))
        return false;
    const std::vector<float> more = gains_less_one(curve, levels);
    const ChannelBands* channels = data.channel_bands(parallel, error);
    if (channels == nullptr)
        return false;
    results.resize(channels->bands.size());
    run(parallel, results.size(), [&](std::size_t i) {
        results[i] = enhanced(data, data.colour.channel(int(i)), channels->bands[i], channels->exponent, more);
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
    const SmoothingData& smoothing = data.smoothing(options.log);
    SmoothingOptions smoothing_options;
    smoothing_options.parallel = parallel;
    smoothing_options.strength = find_strength(options, smoothing);
    if (smoothing_options.strength == 0.0f || options.gain == 1.0f) {
        results = source_channels(data);
        return true;
    }
    enhance(data.hierarchy, smoothing.source, smoothing_options, options.gain, results);
    to_picture(data.hierarchy, smoothing, results);
    return true;
}

/// Keeps at least a quarter of the light of the source at every pixel, however much its details are amplified.
void shade(const ProgressiveImage::Data& data, Channels& results)
{
    for (std::size_t c = 0; c < results.size(); ++c) {
        const float* p = static_cast<const float*>(data.source.localpixels()) + data.colour.channel(int(c));
        for (float& sample : results[c]) {
            if (*p > 0.0f)
                sample = shaded(sample, *p);
            p += data.source.nchannels();
        }
    }
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
        if (is_scene_linear(data))
            shade(data, result.channels);
        bound_below(data, parallel, result.channels);
        return true;
    };
    return filter_picture({ dst, src, roi, nthreads }, options, ResultType::floating, make);
}

}  // namespace ImageBufAlgo
}  // namespace pimg
