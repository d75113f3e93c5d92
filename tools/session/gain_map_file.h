// SPDX-License-Identifier: BSD-3-Clause
// JPEG files with a gain map: pictures for SDR and HDR displays in one.
#pragma once

#include <functional>
#include <string>

#include <OpenImageIO/imagebuf.h>

#include <pimg/gain_map.h>
#include <pimg/options.h>

#include "session/input.h"

namespace pimgtool {

/// How a file with a gain map is asked for, as keys of -o.
struct GainMapRequest : pimg::GainMapOptions {
    bool gainmap = false;
    float peak = 1000.0f;  ///< of the HDR rendition, in nits
};

/// Makes the picture of an HDR display whose brightest is `peak` nits. False with an error in the picture.
using Rendition = std::function<bool(OIIO::ImageBuf& dst, float peak)>;

bool has_jpeg_extension(const std::string& filename);

/// Turns the bytes of a JPEG file into those of one with a gain map.
bool add_rendition(const GainMapRequest& request, const Rendition& rendition, std::string& bytes, std::string& error);

/// Reads the HDR rendition of a file with a gain map, turned upright if that is asked for.
bool read_rendition(const std::string& filename, bool upright, OIIO::ImageBuf& pixels, std::string& error);

}  // namespace pimgtool

namespace pimg {

template<>
const std::vector<Option<pimgtool::GainMapRequest>>& option_table<pimgtool::GainMapRequest>();

}  // namespace pimg
