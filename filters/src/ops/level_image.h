// SPDX-License-Identifier: BSD-3-Clause
// What level_image() and wireframe() share.
#pragma once

#include "source/progressive_image_data.h"

namespace pimg {
inline namespace PIMG_ABI {

/// The mesh of a level and the Gouraud-shaded colour channels it shows, one raster of the picture's size each.
struct LevelPicture {
    Level level = 0;
    Mesh mesh;
    std::vector<std::vector<float>> channels;
};

/// The level the options ask for; `with_channels` false: only its mesh. Returns false, with an error, if they ask for
/// several levels or the hierarchy is damaged.
bool make_level(ProgressiveImage::Data& data, const LevelOptions& options, bool with_channels,
                const ParallelFor& parallel, LevelPicture& picture, std::string& error);

}  // namespace PIMG_ABI
}  // namespace pimg
