// SPDX-License-Identifier: BSD-3-Clause
// What paint, mosaic and ink share: channels of the mesh's size and a picture's colours as the eye tells them apart.
#pragma once

#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>
#include <pimg/channels.h>
#include <pimg/stroke_file.h>

#include "source/progressive_image_data.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Channels that own their samples.
struct OwnedChannels {
    int width = 0, height = 0;
    Channels channels;

    ChannelsView view() const;
};

/// The colour channels of the picture as stored, over the mesh's pixels.
OwnedChannels stored_channels(const ProgressiveImage::Data& data);

/// Up to three channels in steps of an 8-bit picture. With a log guide the picture holds light, and the channels are
/// its logarithms, so that shadows count as much as lights: a stop is 1/6 of the 8-bit range. Otherwise they are the
/// samples as stored, scaled so that 256 is the range of an integer format or, for floats, the quantile 99.9 %.
bool eye_channels(ProgressiveImage::Data& data, const ParallelFor& parallel, OwnedChannels& picture,
                  std::string& error);

/// Darkness of every mesh pixel as a display shows the picture: 1 is black, 0 white.
std::vector<float> darkness(const ProgressiveImage::Data& data, const OwnedChannels& eye);

/// A colour: one word (black, white, grey), numbers "0.2" or "0.9,0.8,0.7" in the picture's units. False if it is none.
bool parse_colour(const std::string& text, int channels, std::vector<float>& values);

/// Reads a picture as float, its first subimage. False, with a message, if that cannot be done.
bool read_picture(const std::string& filename, OIIO::ImageBuf& picture, std::string& error);

/// Writes strokes to FILE.svg or FILE.json; nothing for an empty name.
bool write_strokes(const std::string& filename, const Strokes& strokes, const ShownColours& colours, float opacity,
                   const std::string& ground, std::string& error);

/// Checks the extension before any work is done.
bool check_strokes_name(const std::string& filename, std::string& error);

}  // namespace PIMG_ABI
}  // namespace pimg
