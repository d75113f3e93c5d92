// SPDX-License-Identifier: BSD-3-Clause
// What level_image() and wireframe() share.
#pragma once

#include "source/progressive_image_data.h"

namespace pimg {

/// The mesh of a level and the Gouraud-shaded colour channels it shows, one raster of the picture's size each.
struct LevelPicture {
    Mesh mesh;
    std::vector<std::vector<float>> channels;
};

/// `with_channels` false: only the mesh. Returns false, with an error, only on a damaged hierarchy.
bool make_level(ProgressiveImage::Data& data, Level level, bool with_channels, const ParallelFor& parallel,
                LevelPicture& picture, std::string& error);

}  // namespace pimg
