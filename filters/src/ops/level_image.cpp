// SPDX-License-Identifier: BSD-3-Clause
// The mesh of one level as a picture (paper, Fig. 1).
#include "ops/level_image.h"

#include <cmath>

#include <pimg/detail/format.h>
#include <pimg/imagebufalgo.h>
#include <pimg/rasterize.h>

#include "frame/image_filter.h"
#include "frame/positive_light.h"
#include "ops/channel_sweep.h"

namespace pimg {
inline namespace PIMG_ABI {

bool make_level(ProgressiveImage::Data& data, const LevelOptions& options, bool with_channels,
                const ParallelFor& parallel, LevelPicture& picture, std::string& error)
{
    const Hierarchy& hierarchy = data.hierarchy;
    if (!ImageBufAlgo::find_level(hierarchy, options, picture.level, error))
        return false;
    const Status status = refine(hierarchy, picture.level, picture.mesh);
    error = status.error();
    if (!status || !with_channels)
        return status.ok();
    const ChannelBands* channels = data.channel_bands(parallel, error);
    if (channels == nullptr)
        return false;
    const Channels values = values_of_level(data, *channels, picture.level, parallel);
    std::vector<const float*> inputs;
    std::vector<float*> outputs;
    picture.channels.assign(values.size(), std::vector<float>(hierarchy.mesh_pixels()));
    for (std::size_t i = 0; i < values.size(); ++i) {
        inputs.push_back(values[i].data());
        outputs.push_back(picture.channels[i].data());
    }
    rasterize(picture.mesh, inputs, outputs, parallel);
    for (std::vector<float>& channel : picture.channels) {
        crop_to_picture(hierarchy, channel);
        scale_by_power(channels->exponent, channel);
    }
    bound_below(data, parallel, picture.channels);
    return true;
}

namespace ImageBufAlgo {

bool find_level(const Hierarchy& hierarchy, const LevelOptions& options, Level& level, std::string& error)
{
    if (!check_options(options, error))
        return false;
    level = hierarchy.levels();
    if (options.splits >= 0)
        level = std::min(level, Level(options.splits));
    else if (options.faces >= 0)
        level = hierarchy.level_of_faces(options.faces);
    else if (options.vertices >= 0)
        level = hierarchy.level_of_vertices(options.vertices);
    else if (options.fraction >= 0.0f)
        level = hierarchy.level_of_vertices(double(options.fraction) * hierarchy.vertices());
    else if (options.error >= 0.0f)
        level = hierarchy.level_of_error(double(options.error));
    return true;
}

bool on_hierarchy::level_image(ImageBuf& dst, const ProgressiveImage& src, const LevelOptions& options, ROI roi,
                               int nthreads)
{
    const auto make = [&](ProgressiveImage::Data& data, const ParallelFor& parallel, PictureResult& result,
                          std::string& error) {
        LevelPicture picture;
        if (!make_level(data, options, true, parallel, picture, error))
            return false;
        result.specials = picture.level == data.hierarchy.levels() ? Specials::restored : Specials::replaced;
        result.channels = std::move(picture.channels);
        return true;
    };
    return filter_picture({ dst, src, roi, nthreads }, options, ResultType::as_source, make);
}

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
