// SPDX-License-Identifier: BSD-3-Clause
// Feature-preserving low-pass. Either by a strength, or as in the paper (section 4.1): the details of all but the first
// splits are left out, and with them the residual, which is the finest band.
#include <pimg/detail/format.h>
#include <pimg/detail/parallel.h>
#include <pimg/imagebufalgo.h>

#include <cmath>

#include "frame/image_filter.h"
#include "frame/positive_light.h"

namespace pimg {
inline namespace PIMG_ABI {
namespace ImageBufAlgo {

namespace {

Level splits_kept(const Hierarchy& hierarchy, const FeatureLowpassOptions& options)
{
    if (options.splits >= 0)
        return std::min(Level(options.splits), hierarchy.levels());
    return Level(std::lround(double(options.fraction) * hierarchy.levels()));
}

/// One channel with the details of the first `kept` splits only.
std::vector<float> lowpass(const ProgressiveImage::Data& data, const Bands& bands, Level kept, int exponent)
{
    const Hierarchy& hierarchy = data.hierarchy;
    std::vector<float> values(hierarchy.vertices());
    sweep(hierarchy, bands, values.data(), kept, [](Level, Detail d) { return d; });
    if (is_scene_linear(data) && kept < hierarchy.levels())
        shade_vertices(hierarchy, bands, kept, values.data());
    sweep_splits(hierarchy, kept, hierarchy.levels(), values.data(), [](Level) { return Detail { 0.0f, 0.0f }; });
    return to_picture(hierarchy, values.data(), exponent, kept == hierarchy.levels() ? &bands.residual : nullptr);
}

bool by_position(ProgressiveImage::Data& data, const FeatureLowpassOptions& options, const ParallelFor& parallel,
                 Channels& results, std::string& error)
{
    if (options.log) {
        error = "log: expected without splits and fraction";
        return false;
    }
    const ChannelBands* channels = data.channel_bands(parallel, error);
    if (channels == nullptr)
        return false;
    const Level kept = splits_kept(data.hierarchy, options);
    results.resize(channels->bands.size());
    run(parallel, results.size(),
        [&](std::size_t i) { results[i] = lowpass(data, channels->bands[i], kept, channels->exponent); });
    return true;
}

void by_strength(ProgressiveImage::Data& data, const FeatureLowpassOptions& options, const ParallelFor& parallel,
                 Channels& results)
{
    const std::shared_ptr<const SmoothingData> kept = data.smoothing(options.log, parallel);
    const SmoothingData& smoothing = *kept;
    SmoothingOptions smoothing_options;
    smoothing_options.strength = find_strength(options, smoothing);
    smoothing_options.parallel = parallel;
    if (smoothing_options.strength == 0.0f) {
        results = source_channels(data);
        return;
    }
    smooth(data.hierarchy, smoothing.source, smoothing_options, results);
    to_picture(data.hierarchy, smoothing, results);
}

}  // namespace

bool on_hierarchy::feature_lowpass(ImageBuf& dst, const ProgressiveImage& src, const FeatureLowpassOptions& options,
                                   ROI roi, int nthreads)
{
    const auto make = [&](ProgressiveImage::Data& data, const ParallelFor& parallel, PictureResult& result,
                          std::string& error) {
        const bool positional = options.splits >= 0 || options.fraction >= 0.0f;
        if (!positional)
            by_strength(data, options, parallel, result.channels);
        else if (!by_position(data, options, parallel, result.channels, error))
            return false;
        bound_below(data, parallel, result.channels);
        return true;
    };
    return filter_picture({ dst, src, roi, nthreads }, options, ResultType::as_source, make);
}

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
