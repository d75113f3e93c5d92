// SPDX-License-Identifier: BSD-3-Clause
// A mosaic: the dual pieces of a level, as the paper draws them (section 5.2), laid as tiles.
#pragma once

#include <vector>

#include <pimg/mesh.h>
#include <pimg/types.h>

namespace pimg {

/// The tiles of a level: for every pixel, row-major over the mesh's grid, the vertex of M_i whose tile it is on, how
/// far inside that tile it is, and the way to its nearest side.
struct Tiling {
    int width = 0, height = 0;
    std::vector<Index> tile;
    std::vector<float> inside;          ///< pixels; next to 0 at a joint; the picture's own border is no joint
    std::vector<float> away_x, away_y;  ///< unit vector from the nearest joint inwards; 0 if there is none
};

Tiling tile(const Mesh& mesh, const ParallelFor& parallel = {});

struct MosaicSettings {
    float grout = 1.5f;   ///< width of the joints in pixels, 0..64
    float bevel = 2.0f;   ///< width of the slope around a tile in pixels, 0..64
    float relief = 0.5f;  ///< how strongly the slopes are lit, 0..1
    ParallelFor parallel;
};

/// Replaces each channel by its mean over every tile, bevelled and jointed. `grout_colors` has one value per channel.
void lay_mosaic(const Tiling& tiling, Index tiles, const MosaicSettings& settings,
                const std::vector<float>& grout_colors, const std::vector<float*>& channels);

}  // namespace pimg
