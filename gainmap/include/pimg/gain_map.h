// SPDX-License-Identifier: BSD-3-Clause
// Gain-map JPEG files: one file that shows an SDR picture on an SDR display and an HDR picture on an HDR display.
//
// The file is an ordinary JPEG picture, the base, followed by a second, smaller JPEG picture, the gain map. At each pixel
// the gain map holds how many stops brighter the HDR rendition is than the base. Readers that know nothing of gain maps
// show the base. The format is described by ISO 21496-1 (the metadata), CIPA DC-007 (the Multi-Picture Format, the index
// of both pictures) and Android's Ultra HDR image format 1.1 (the XMP packet that older readers look for).
//
// Pictures are display-linear: light in proportion, 1 is the white of an SDR picture, kSdrWhiteNits.
#pragma once

#include <string>

#include <OpenImageIO/imagebuf.h>
#include <pimg/options.h>

namespace pimg {
inline namespace PIMG_ABI {

/// How a gain map is made; its option_table has ranges and help.
struct GainMapOptions {
    int scale = 0;     ///< side of the square of pixels that one sample of the map stands for: 1, 2 or 4; 0 finds it,
                       ///< 1 where the rendition of a map with 2 would be 0.08 stops off at the 95th percentile, else 2
    int channels = 3;  ///< 3: red, green and blue have maps of their own; 1: one map of luminance
    int quality = 87;  ///< JPEG quality of the map, 1 .. 100
};

template<>
PIMG_EXPORT const std::vector<Option<GainMapOptions>>& option_table<GainMapOptions>();

/// Makes the gain-map file of a base and its HDR rendition.
///   base       an ordinary JPEG file, whole: its pixels stay as they are, byte for byte
///   rendition  the HDR picture, display-linear, as large as the base; its metadata say in which primaries it is, see
///              Colour::resolve(). Samples below 0 count as 0; alpha is ignored.
/// False, with `error` saying why, if the base is no JPEG file, has a gain map already, or differs in size.
PIMG_EXPORT bool add_gain_map(const std::string& base, const OIIO::ImageBuf& rendition, const GainMapOptions& options,
                              std::string& file, std::string& error);

/// Whether the bytes are those of a JPEG file with a gain map.
PIMG_EXPORT bool has_gain_map(const std::string& file);

/// The HDR rendition of a gain-map file: display-linear RGB as float, in the primaries of the base, with its metadata.
///   headroom   how much brighter than SDR white the display can be, in stops; 0 gives the base, and a headroom as large
///              as the file's own, or below 0, the whole rendition
/// The result has an error, a line that names what was expected, if the bytes are no JPEG file, have no gain map, are cut
/// off, or hold numbers that make no sense.
PIMG_EXPORT OIIO::ImageBuf gain_map_rendition(const std::string& file, float headroom = -1.0f);

}  // namespace PIMG_ABI
}  // namespace pimg
