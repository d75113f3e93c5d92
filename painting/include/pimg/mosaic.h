// SPDX-License-Identifier: BSD-3-Clause
// Mosaics: the dual pieces of one level, drawn as polygons like in the paper (section 5.2), are the tiles.
#pragma once

#include <vector>

#include <pimg/mesh.h>
#include <pimg/types.h>

namespace pimg {

/// The tiles of one level. The vectors have one entry per pixel of the mesh's grid, row-major.
struct Tiling {
    int width = 0, height = 0;  ///< size of the mesh's grid in pixels
    std::vector<Index> tile;    ///< vertex of M_i whose tile the pixel is on
    std::vector<float> inside;  ///< distance to the tile's nearest joint in pixels; the picture's border is no joint
    std::vector<float> away_x, away_y;  ///< unit vector from the nearest joint to the pixel; 0 if there is no joint
};

/// Makes the tiles of a mesh M_i. The result does not depend on `parallel`.
Tiling tile(const Mesh& mesh, const ParallelFor& parallel = {});

/// How tiles are drawn.
struct TileOptions {
    float grout = 1.5f;    ///< width of the joints in pixels, 0..64
    float bevel = 2.0f;    ///< width of the slope around a tile in pixels, 0..64
    float relief = 0.5f;   ///< how strongly the slopes are lit, 0..1
    ParallelFor parallel;  ///< the result does not depend on it
};

using MosaicSettings [[deprecated("renamed: TileOptions")]] = TileOptions;

/// Draws the mosaic into `channels`, which hold the picture: one float per pixel of the tiling, row-major. Each tile gets
/// the channel's mean over it, with lit slopes at its sides. The joints between tiles get grout_colours[c] in channel c.
/// `tiles` is the number of vertices of M_i.
void lay_mosaic(const Tiling& tiling, Index tiles, const TileOptions& options, const std::vector<float>& grout_colours,
                const std::vector<float*>& channels);

}  // namespace pimg
