// SPDX-License-Identifier: BSD-3-Clause
// Feature-preserving low-pass (paper, section 4.1): the details of all but the first splits are left out, and the
// residual, the finest band, unless nothing is.
#include <pimg/imagebufalgo.h>

#include <cmath>

#include "image_filter.h"

namespace pimg {
namespace ImageBufAlgo {

namespace {

constexpr float kDefaultFraction = 0.1f;

Level splits_kept(const Hierarchy& hierarchy, const FeatureLowpassOptions& options)
{
    if (options.splits >= 0)
        return std::min(Level(options.splits), hierarchy.levels());
    const float fraction = options.fraction >= 0.0f ? options.fraction : kDefaultFraction;
    return Level(std::lround(double(fraction) * hierarchy.levels()));
}

/// One channel with the details of the first `kept` splits only.
std::vector<float> lowpass(const Hierarchy& hierarchy, const Bands& bands, Level kept, int exponent)
{
    std::vector<float> values(hierarchy.vertices());
    sweep(hierarchy, bands, values.data(), hierarchy.levels(), [kept](Level i, Detail d) {
        return i < kept ? d : Detail { 0.0f, 0.0f };
    });
    return to_picture(hierarchy, values.data(), exponent, kept == hierarchy.levels() ? &bands.residual : nullptr);
}

}  // namespace

bool feature_lowpass(ImageBuf& dst, const ProgressiveImage& src, const FeatureLowpassOptions& options, ROI roi,
                     int nthreads)
{
    return run_filter(dst, options, [&] {
        if (!prepare(dst, src, roi, ResultType::as_source))
            return false;
        ProgressiveImage::Data& data = *src.data();
        const ParallelFor parallel = pool_loop(nthreads);
        const Level kept = splits_kept(data.hierarchy, options);
        std::string error;
        const ChannelBands* channels = data.channel_bands(parallel, error);
        if (channels == nullptr) {
            dst.errorfmt("{}", error);
            return false;
        }
        std::vector<std::vector<float>> results(channels->bands.size());
        run(parallel, results.size(),
            [&](std::size_t i) { results[i] = lowpass(data.hierarchy, channels->bands[i], kept, channels->exponent); });
        write_channels(dst, data, roi, parallel, results);
        return true;
    });
}

bool feature_lowpass(ImageBuf& dst, const ImageBuf& src, const FeatureLowpassOptions& options, ROI roi, int nthreads)
{
    ProgressiveImage progressive;
    return build_source(dst, src, nthreads, progressive) && feature_lowpass(dst, progressive, options, roi, nthreads);
}

ImageBuf feature_lowpass(const ImageBuf& src, const FeatureLowpassOptions& options, ROI roi, int nthreads)
{
    return returned("feature_lowpass",
                    [&](ImageBuf& dst) { return feature_lowpass(dst, src, options, roi, nthreads); });
}

ImageBuf feature_lowpass(const ProgressiveImage& src, const FeatureLowpassOptions& options, ROI roi, int nthreads)
{
    return returned("feature_lowpass",
                    [&](ImageBuf& dst) { return feature_lowpass(dst, src, options, roi, nthreads); });
}

}  // namespace ImageBufAlgo
}  // namespace pimg
