// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a gain map, and their two spellings in files: the binary one of ISO 21496-1, and the XMP one of Adobe
// and Android (name space http://ns.adobe.com/hdr-gain-map/1.0/).
#pragma once

#include <array>
#include <string>
#include <string_view>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// With v a sample of the map, 0..1, and W the weight of the display, 0..1, a channel becomes
///     (base + base_offset) * 2^(W (min + (max - min) v^(1 / gamma))) - alternate_offset.
struct GainChannel {
    double min = 0.0, max = 0.0;  ///< stops
    double gamma = 1.0;
    double base_offset = 1.0 / 64.0, alternate_offset = 1.0 / 64.0;  ///< display-linear light
};

struct GainMetadata {
    bool base_colour_space =
        true;  ///< the sum is done in the primaries of the base, else in those of the map's profile
    double base_headroom = 0.0,
           alternate_headroom = 0.0;  ///< stops above SDR white: W is 0 at the first, 1 at the second
    int channels = 1;                 ///< 1: the first one's numbers hold for all
    std::array<GainChannel, 3> channel;
};

/// False, with a line saying which number, where a decoder could not use them.
bool check_gain_metadata(const GainMetadata& metadata, std::string& error);

/// What follows the name "urn:iso:std:iso:ts:21496:-1" in the APP2 segment of the gain map.
std::string iso_gain_metadata(const GainMetadata& metadata);
/// What follows it in the base: the version alone.
std::string iso_gain_version();
bool parse_iso_gain_metadata(std::string_view bytes, GainMetadata& metadata, std::string& error);

/// The XMP packet of the gain map. The numbers of the first channel hold for all.
std::string xmp_gain_metadata(const GainMetadata& metadata);
bool parse_xmp_gain_metadata(std::string_view packet, GainMetadata& metadata, std::string& error);

/// The XMP packet of the base: `packet`, which may be empty, and a directory of both pictures.
std::string xmp_with_directory(std::string_view packet, std::size_t gain_map_size);

}  // namespace PIMG_ABI
}  // namespace pimg
