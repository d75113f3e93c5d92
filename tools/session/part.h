// SPDX-License-Identifier: BSD-3-Clause
// What is written of a picture: the pixels, channels and types that a format can hold.
#pragma once

#include <string>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

#include "session/output.h"

namespace pimgtool {

/// A picture as it is written. It does not move: `source` may point at its own members.
struct Part {
    Part() = default;
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

    const OIIO::ImageBuf* source = nullptr;  ///< the pixels: the given ones, or one of the following
    OIIO::ImageBuf kept, cropped, numbers, associated, encoded;
    OIIO::ImageSpec spec;     ///< the header of the file
    bool is_encoded = false;  ///< as sRGB, for display
};

/// Makes what is written of a picture to a file called `filename` by the writer `out`. `scratch` is the name of a file
/// that is written and removed meanwhile: some properties of a writer are only found by writing a small picture. False,
/// with a line in the report, if the format cannot hold the picture.
bool make_part(const OutputPicture& picture, const std::string& filename, OIIO::ImageOutput& out,
               const std::string& scratch, Part& part, const OutputReport& report);

/// Copies from the header `first` to `part` the attributes that all parts of an OpenEXR file must have in common.
void share_attributes(const OIIO::ImageSpec& first, OIIO::ImageSpec& part);

/// Adds to a line of warnings.
void add_warning(std::string& warning, const std::string& more);

}  // namespace pimgtool
