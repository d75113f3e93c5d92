// SPDX-License-Identifier: BSD-3-Clause
// The edges of a level's mesh.
#include <pimg/imagebufalgo.h>

#include <algorithm>
#include <numeric>

#include <pimg/detail/format.h>
#include <pimg/rasterize.h>

#include "frame/image_filter.h"
#include "ops/level_image.h"

namespace pimg {
inline namespace PIMG_ABI {
namespace ImageBufAlgo {

namespace {

/// Draws lines over one channel: black where the channel is brighter than its mean, elsewhere as bright as its
/// brightest sample.
void draw_over(const std::vector<float>& coverage, std::vector<float>& channel)
{
    const double sum = std::accumulate(channel.begin(), channel.end(), 0.0);
    const float mean = float(sum / double(channel.size()));
    const float white = std::min(*std::max_element(channel.begin(), channel.end()), 1.0f);
    for (std::size_t i = 0; i < channel.size(); ++i) {
        const float ink = channel[i] > mean ? 0.0f : white;
        channel[i] += coverage[i] * (ink - channel[i]);
    }
}

}  // namespace

bool on_hierarchy::wireframe(ImageBuf& dst, const ProgressiveImage& src, const WireframeOptions& options, ROI roi,
                             int nthreads)
{
    const auto make = [&](ProgressiveImage::Data& data, const ParallelFor& parallel, PictureResult& result,
                          std::string& error) {
        LevelPicture picture;
        if (!make_level(data, options, options.overlay, parallel, picture, error))
            return false;
        std::vector<float> coverage = pimg::wireframe(picture.mesh, options.line);
        if (options.overlay) {
            crop_to_picture(data.hierarchy, coverage);
            const std::vector<float> alpha = alpha_of(data);
            for (std::size_t i = 0; i < alpha.size(); ++i)
                coverage[i] *= alpha[i];
            for (std::vector<float>& channel : picture.channels) {
                draw_over(coverage, channel);
                // The triangles of a level reach over the edge of a cut-out figure.
                for (std::size_t i = 0; i < alpha.size(); ++i)
                    channel[i] = alpha[i] > 0.0f ? channel[i] : 0.0f;
            }
            result = { std::move(picture.channels), Specials::replaced };
        } else {
            for (float& c : coverage)
                c = 1.0f - c;
            result = drawn_result(data, Channels(std::size_t(data.colour.count()), coverage));
        }
        return true;
    };
    return filter_picture({ dst, src, roi, nthreads }, options, ResultType::as_source, make);
}

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
