// SPDX-License-Identifier: BSD-3-Clause
// Feature-preserving low-pass. Either by a strength, or as in the paper (section 4.1): the details of all but the first
// splits are left out, and with them the residual, which is the finest band.
#include <pimg/detail/format.h>
#include <pimg/detail/parallel.h>
#include <pimg/imagebufalgo.h>

#include <cmath>

#include "frame/image_filter.h"
#include "frame/positive_light.h"
#include "ops/channel_sweep.h"

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
    const auto planned = data.planned_channels(parallel, error);
    if (planned == nullptr)
        return false;
    const Level kept = splits_kept(data.hierarchy, options);
    predict_finest(data, *planned, kept, values_of_level(data, *channels, kept, parallel), parallel, results);
    const bool whole = kept == data.hierarchy.levels();
    run(parallel, results.size(), [&](std::size_t c) {
        if (whole)
            add_residual(channels->bands[c], results[c].data(), [](Index, float residual) { return residual; });
        crop_to_picture(data.hierarchy, results[c]);
        scale_by_power(channels->exponent, results[c]);
    });
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
