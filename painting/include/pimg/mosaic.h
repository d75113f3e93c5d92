// SPDX-License-Identifier: BSD-3-Clause
// Mosaics: the dual pieces of one level, drawn as polygons like in the paper (section 5.2), are the tiles. Or cells that grow from
// these pieces: more even, convex where the picture lets them, with rounded corners.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/channels.h>
#include <pimg/mesh.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The tiles of one level. The vectors have one entry per pixel of the mesh's grid, row-major.
struct Tiling {
    int width = 0, height = 0;  ///< size of the mesh's grid in pixels
    std::vector<Index> tile;    ///< vertex of M_i whose tile the pixel is on
    std::vector<float> inside;  ///< distance to the tile's nearest joint in pixels; the picture's border is no joint
    std::vector<float> away_x, away_y;  ///< unit vector from the nearest joint to the pixel; 0 if there is no joint
};

/// Makes the tiles of a mesh M_i. The result does not depend on `parallel`.
PIMG_EXPORT Tiling tile(const Mesh& mesh, const ParallelFor& parallel = {});

/// Cells around the middles of the pieces of M_i, as the number of the vertex for each pixel, row-major. They are evener than the
/// pieces: each pixel belongs to a cell whose middle is near and whose colour is like its own. Each is connected. `guides` are up
/// to three channels of the mesh's size in units of one step of an 8-bit picture. A few vertices may get no pixel. The
/// result does not depend on `parallel`.
PIMG_EXPORT std::vector<Index> grow_cells(const Mesh& mesh, const ChannelsView& guides,
                                          const ParallelFor& parallel = {});

/// The tiling of a partition of width x height pixels into tiles 0 .. tiles - 1. Corners are rounded with a radius of `round`
/// times that of the largest disc in the tile, 0..1.
PIMG_EXPORT Tiling tiling_of(const std::vector<Index>& labels, int width, int height, Index tiles, float round);

/// How tiles are drawn.
struct TileOptions {
    float grout = 1.5f;      ///< width of the joints in pixels, 0..64
    float bevel = 2.0f;      ///< width of the slope around a tile in pixels, 0..64
    float relief = 0.5f;     ///< how strongly the slopes are lit, 0..1
    ParallelFor parallel;    ///< the result does not depend on it
    float variation = 0.0f;  ///< 0..1: largest random change of a tile's brightness and warmth, as a share
    float leading = 0.0f;    ///< above 0 stained glass: width in pixels of the lead, which replaces joints and slopes
    std::uint32_t seed = 1;  ///< another seed gives other random changes
};

using MosaicSettings [[deprecated("renamed: TileOptions")]] = TileOptions;

/// Draws the mosaic into `channels`, which hold the picture: one float per pixel of the tiling, row-major. Each tile gets
/// the channel's mean over it, with lit slopes at its sides. The joints between tiles, and the lead of stained glass, get grout_colours[c] in channel c.
/// `tiles` is the number of vertices of M_i.
PIMG_EXPORT void lay_mosaic(const Tiling& tiling, Index tiles, const TileOptions& options,
                            const std::vector<float>& grout_colours, const std::vector<float*>& channels);

}  // namespace PIMG_ABI
}  // namespace pimg
