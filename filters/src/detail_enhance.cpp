// SPDX-License-Identifier: BSD-3-Clause
// Detail enhancement (paper, section 4.1): the details of a range of splits are amplified.
#include <pimg/imagebufalgo.h>

#include <cmath>

#include "image_filter.h"
#include "sweep.h"

namespace pimg {
namespace ImageBufAlgo {

namespace {

/// A place in the sequence of splits: a share of all, or a number of splits if above 1.
Level place(const Hierarchy& hierarchy, float position)
{
    const double splits = position > 1.0f ? double(position) : double(position) * hierarchy.levels();
    return Level(std::lround(std::min(splits, double(hierarchy.levels()))));
}

/// One channel with the details of splits [from, to) amplified. What that adds is added to the picture
/// rather than synthesised with it, so that a gain of 1 changes no bit.
std::vector<float> enhanced(const ProgressiveImage::Data& data, int channel, const Bands& bands, int exponent,
                            Level from, Level to, float gain)
{
    std::vector<float> values(data.hierarchy.vertices(), 0.0f);
    const float more = gain - 1.0f;
    const Detail* details = bands.details.data();
    sweep_from(data.hierarchy, from, values.data(), [=](Level i) {
        return i < to ? Detail { more * details[i].t, more * details[i].u } : Detail { 0.0f, 0.0f };
    });
    std::vector<float> samples = to_picture(data.hierarchy, values.data(), exponent);
    const float* p = static_cast<const float*>(data.source.localpixels()) + channel;
    for (float& sample : samples) {
        sample += *p;
        p += data.source.nchannels();
    }
    return samples;
}

}  // namespace

bool detail_enhance(ImageBuf& dst, const ProgressiveImage& src, const DetailEnhanceOptions& options, ROI roi,
                    int nthreads)
{
    return run_filter(dst, options, [&] {
        if (!prepare(dst, src, roi, ResultType::floating))
            return false;
        ProgressiveImage::Data& data = *src.data();
        const ParallelFor parallel = pool_loop(nthreads);
        const Level from = place(data.hierarchy, options.from), to = place(data.hierarchy, options.to);
        std::string error;
        const ChannelBands* channels = data.channel_bands(parallel, error);
        if (channels == nullptr) {
            dst.errorfmt("{}", error);
            return false;
        }
        std::vector<std::vector<float>> results(channels->bands.size());
        run(parallel, results.size(), [&](std::size_t i) {
            results[i] = enhanced(data, data.colour.channel(int(i)), channels->bands[i], channels->exponent, from, to,
                                  options.gain);
        });
        write_channels(dst, data, roi, parallel, results);
        return true;
    });
}

bool detail_enhance(ImageBuf& dst, const ImageBuf& src, const DetailEnhanceOptions& options, ROI roi, int nthreads)
{
    ProgressiveImage progressive;
    return build_source(dst, src, nthreads, progressive) && detail_enhance(dst, progressive, options, roi, nthreads);
}

ImageBuf detail_enhance(const ImageBuf& src, const DetailEnhanceOptions& options, ROI roi, int nthreads)
{
    return returned("detail_enhance", [&](ImageBuf& dst) { return detail_enhance(dst, src, options, roi, nthreads); });
}

ImageBuf detail_enhance(const ProgressiveImage& src, const DetailEnhanceOptions& options, ROI roi, int nthreads)
{
    return returned("detail_enhance", [&](ImageBuf& dst) { return detail_enhance(dst, src, options, roi, nthreads); });
}

}  // namespace ImageBufAlgo
}  // namespace pimg
