// SPDX-License-Identifier: BSD-3-Clause
#include "session/gain_map_file.h"

#include <algorithm>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
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
        { &T::peak, { "peak", kSdrWhiteNits, 4000, "nits", "", "with gainmap: brightest of the HDR rendition" } },
        { &T::scale,
          { "scale", 0, 4, "pixels", "", "with gainmap: side of a sample of the map, 1, 2 or 4; 0: found" } },
        { &T::channels, { "channels", 1, 3, "", "", "with gainmap: 3, gains of each colour, or 1, one of all" } },
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
    // JPEG shows the display window, from 0 on; see write_parts().
    const OIIO::ROI full = hdr.roi_full();
    const OIIO::ROI window(std::max(full.xbegin, 0), full.xend, std::max(full.ybegin, 0), full.yend, 0, 1, 0,
                           hdr.nchannels());
    if (hdr.roi() != window)
        hdr = OIIO::ImageBufAlgo::cut(hdr, window);
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
