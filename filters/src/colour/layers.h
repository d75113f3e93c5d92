// SPDX-License-Identifier: BSD-3-Clause
// Which of a file's channels are the picture.
#pragma once

#include <array>
#include <string>

#include <OpenImageIO/imageio.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The picture among the channels.
struct PictureChannels {
    std::array<int, 3> channels { 0, 0, 0 };
    int count = 0;
    int alpha = -1;  ///< of these colours, or -1
};

/// Finds the channels of `layer`: the name before the last dot, or what it ends in ("Combined" for
/// "ViewLayer.Combined"), or a single channel's. For "": R, G and B without a layer; else those of the layer rgba, Color,
/// beauty, Combined or C; else of the only layer that has all three; else, where no layer has, the first three channels
/// without a layer or of the only layer that are neither alpha nor depth. Capitals do not matter. False, with a line that
/// lists the layers, if there is no such layer, or several may be meant.
bool find_picture(const OIIO::ImageSpec& spec, const std::string& layer, PictureChannels& picture, std::string& error);

/// Whether a channel's name (crypto, depth, normal, position, motion, UV, IDs) or type (32-bit integers) says that it
/// holds data, not light.
bool holds_data(const OIIO::ImageSpec& spec, int channel);

/// Whether a channel is red, green or blue of a layer of light: one that has all three, holds no data, and is no property of
/// surfaces either, such as albedo, the Col passes of Blender, occlusion or a mask.
bool holds_light(const OIIO::ImageSpec& spec, int channel);

}  // namespace PIMG_ABI
}  // namespace pimg
