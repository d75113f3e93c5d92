// SPDX-License-Identifier: BSD-3-Clause
#include "session/gain_map_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

namespace pimg {

template<>
const std::vector<Option<pimgtool::GainMapRequest>>& option_table<pimgtool::GainMapRequest>()
{
    using T = pimgtool::GainMapRequest;
    static const std::vector<Option<T>> table = {
        { &T::gainmap,
          { "gainmap", 0, 0, "", "", "JPEG: the result of --hdr-compress, with a gain map for HDR displays" } },
        { &T::peak, { "peak", 203, 10000, "nits", "", "with gainmap: brightest of the HDR rendition" } },
        { &T::scale,
          { "scale", 1, 4, "pixels", "", "with gainmap: side of the square that a sample of the map is for" } },
        { &T::channels, { "channels", 1, 3, "", "", "with gainmap: 3 for gains of each colour, 1 for one of all" } },
    };
    return table;
}

}  // namespace pimg

namespace pimgtool {

bool has_jpeg_extension(const std::string& filename)
{
    const std::string extension = OIIO::Strutil::lower(OIIO::Filesystem::extension(filename, false));
    return extension == "jpg" || extension == "jpeg";
}

bool add_rendition(const GainMapRequest& request, const Rendition& rendition, std::string& bytes, std::string& error)
{
    OIIO::ImageBuf hdr;
    if (!rendition(hdr, request.peak)) {
        error = hdr.geterror();
        return false;
    }
    std::string file;
    if (!pimg::add_gain_map(bytes, hdr, request, file, error))
        return false;
    bytes = std::move(file);
    return true;
}

bool read_rendition(const std::string& filename, bool upright, OIIO::ImageBuf& pixels, std::string& error)
{
    std::string bytes;
    if (!OIIO::Filesystem::read_text_file(filename, bytes)) {
        error = pimg::format("cannot read \"{}\"", filename);
        return false;
    }
    pixels = pimg::gain_map_rendition(bytes);
    if (!pixels.has_error() && upright && pixels.orientation() > 1)
        turn_upright(pixels);
    if (!pixels.has_error())
        return true;
    error = pimg::format("\"{}\": {}", filename, pixels.geterror());
    return false;
}

}  // namespace pimgtool
