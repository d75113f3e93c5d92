// SPDX-License-Identifier: BSD-3-Clause
// The dual pieces of a level as the tiles of a mosaic (paper, sections 4.2 and 7).
#include <pimg/imagebufalgo.h>

#include <algorithm>

#include <pimg/detail/format.h>
#include <pimg/mosaic.h>

#include "frame/image_filter.h"
#include "ops/painting/painting.h"
#include "ops/painting/wrapped_tiling.h"

namespace pimg {
namespace ImageBufAlgo {

namespace {

/// If the picture has alpha, gives each tile its mean colour with alpha divided out, so that a tile that lies half
/// outside of a cut-out figure is no darker than its neighbours.
void straighten(const ProgressiveImage::Data& data, const Tiling& tiling, Index tiles, const ParallelFor& parallel,
                const std::vector<float*>& channels)
{
    const std::vector<float> alpha = alpha_of(data);
    if (alpha.empty())
        return;
    std::vector<float> cover = without_margins(data.wrap, to_mesh_pixels(data.hierarchy, alpha.data()));
    std::vector<float*> all = channels;
    all.push_back(cover.data());
    lay_mosaic(tiling, tiles, { 0.0f, 0.0f, 0.0f, parallel }, std::vector<float>(all.size(), 0.0f), all);
    for (float* channel : channels)
        for (std::size_t i = 0; i < cover.size(); ++i)
            channel[i] = cover[i] > 0.0f ? channel[i] / cover[i] : 0.0f;
}

/// A level with so many tiles in the picture.
Level level_of(const ProgressiveImage::Data& data, int tiles)
{
    const double margins = double(data.spec.image_pixels()) / double(data.picture.image_pixels());
    return data.hierarchy.level_of_vertices(margins * tiles);
}

}  // namespace

bool on_hierarchy::mosaic(ImageBuf& dst, const ProgressiveImage& src, const MosaicOptions& options, ROI roi,
                          int nthreads)
{
    const auto make = [&](ProgressiveImage::Data& data, const ParallelFor& parallel, PictureResult& result,
                          std::string& error) {
        std::vector<float> grout;
        if (!parse_colour(options.colour, data.colour.count(), grout)) {
            error = format("colour: \"{}\": expected a colour, such as black or 0.2,0.2,0.2", options.colour);
            return false;
        }
        Mesh mesh;
        const Status status = refine(data.hierarchy, level_of(data, options.tiles), mesh);
        if (!status) {
            error = status.error();
            return false;
        }
        OwnedChannels picture = stored_channels(data);
        std::vector<float*> channels;
        for (std::vector<float>& channel : picture.channels) {
            channel = without_margins(data.wrap, std::move(channel));
            channels.push_back(channel.data());
        }
        const Tiling tiling = wrapped_tiling(data.wrap, tile(mesh, parallel), mesh.size());
        straighten(data, tiling, mesh.size(), parallel, channels);
        lay_mosaic(tiling, mesh.size(), { options.grout, options.bevel, options.relief, parallel }, grout, channels);
        for (std::vector<float>& channel : picture.channels)
            channel = with_margins(data.wrap, std::move(channel));
        result = drawn_result(data, std::move(picture.channels));
        return true;
    };
    return filter_picture({ dst, src, roi, nthreads }, options, ResultType::as_source, make);
}

}  // namespace ImageBufAlgo
}  // namespace pimg
