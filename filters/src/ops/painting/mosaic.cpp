// SPDX-License-Identifier: BSD-3-Clause
// The dual pieces of a level as the tiles of a mosaic (paper, sections 4.2 and 7).
#include <pimg/imagebufalgo.h>

#include <algorithm>

#include <pimg/detail/format.h>
#include <pimg/mosaic.h>

#include "frame/image_filter.h"
#include "ops/painting/painting.h"
#include "ops/painting/wrapped_tiling.h"
#include "source/wrap/wrapped_pieces.h"

namespace pimg {
inline namespace PIMG_ABI {
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

/// Cells on the picture without its margins. At seams the tiles of both sides meet, so labels are repeated there as far as
/// joints and slopes may reach.
Tiling cell_tiling(const ProgressiveImage::Data& data, const Mesh& mesh, const OwnedChannels& eye, float round,
                   const ParallelFor& parallel)
{
    constexpr int kReach = 128;  // pixels; joints and slopes are 64 wide at most
    std::vector<Index> labels = grow_cells(mesh, eye.view(), parallel);
    if (!data.wrap)
        return tiling_of(labels, eye.width, eye.height, mesh.size(), round);
    const Wrap& wrap = data.wrap;
    const std::vector<Index> places = piece_places(wrap, labels, mesh.size());
    const int mx = wrap.x ? std::min(kReach, wrap.width) : 0, my = wrap.y ? std::min(kReach, wrap.height) : 0;
    std::vector<Index> around;
    for (int y = -my; y < wrap.height + my; ++y)
        for (int x = -mx; x < wrap.width + mx; ++x)
            around.push_back(labels[places[std::size_t(modulo(y, wrap.height)) * std::size_t(wrap.width)
                                           + std::size_t(modulo(x, wrap.width))]]);
    const Tiling wide = tiling_of(around, wrap.width + 2 * mx, wrap.height + 2 * my, mesh.size(), round);
    Tiling tiling { wrap.width, wrap.height, {}, {}, {}, {} };
    for (int y = 0; y < wrap.height; ++y)
        for (int x = 0; x < wrap.width; ++x) {
            const std::size_t at = std::size_t(y + my) * std::size_t(wide.width) + std::size_t(x + mx);
            tiling.tile.push_back(wide.tile[at]);
            tiling.inside.push_back(wide.inside[at]);
            tiling.away_x.push_back(wide.away_x[at]);
            tiling.away_y.push_back(wide.away_y[at]);
        }
    return tiling;
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
        OwnedChannels eye;
        if (options.shape == "cells" && !eye_channels(data, parallel, eye, error))
            return false;
        const Tiling tiling = options.shape == "cells" ? cell_tiling(data, mesh, eye, options.round, parallel)
                                                       : wrapped_tiling(data.wrap, tile(mesh, parallel), mesh.size());
        straighten(data, tiling, mesh.size(), parallel, channels);
        lay_mosaic(tiling, mesh.size(),
                   { options.grout, options.bevel, options.relief, parallel, options.variation, options.leading,
                     std::uint32_t(options.seed) },
                   grout, channels);
        for (std::vector<float>& channel : picture.channels)
            channel = with_margins(data.wrap, std::move(channel));
        result = drawn_result(data, std::move(picture.channels));
        return true;
    };
    return filter_picture({ dst, src, roi, nthreads }, options, ResultType::as_source, make);
}

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
