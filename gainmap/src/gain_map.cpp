// SPDX-License-Identifier: BSD-3-Clause
// The file around both pictures: an ordinary JPEG stream with an XMP directory, the name of ISO 21496-1 and a
// Multi-Picture index among its segments, and the gain map behind it.
#include <pimg/gain_map.h>

#include <exception>
#include <utility>

#include <pimg/colour.h>
#include <pimg/detail/format.h>
#include <pimg/options.h>

#include "gain_field.h"
#include "gain_metadata.h"
#include "jpeg_stream.h"
#include "multi_picture.h"

namespace pimg {
inline namespace PIMG_ABI {

template<>
const std::vector<Option<GainMapOptions>>& option_table<GainMapOptions>()
{
    using G = GainMapOptions;
    static const std::vector<Option<G>> table = {
        { &G::scale,
          { "scale", 0, 4, "pixels", "",
            "1, 2 or 4: side of the square that a sample of the gain map stands for; 0: 2, or 1 where 2 is too "
            "coarse" } },
        { &G::channels, { "channels", 1, 3, "", "", "3 for a gain map of each colour, 1 for one of luminance" } },
        { &G::quality, { "quality", 1, 100, "percent", "", "JPEG quality of the gain map" } },
    };
    return table;
}

namespace {

constexpr std::string_view kXmpName { "http://ns.adobe.com/xap/1.0/\0", 29 };
constexpr std::string_view kIsoName { "urn:iso:std:iso:ts:21496:-1\0", 28 };

/// Linear light of the colour channels, in the primaries that the metadata say, or in Rec. 709.
bool linear_light(const OIIO::ImageBuf& picture, bool as_rec709, Light& light, Colour& colour, std::string& error)
{
    const OIIO::ImageSpec& spec = picture.spec();
    if (!Colour::resolve(spec, "", "", colour, error))
        return false;
    light.width = spec.width;
    light.height = spec.height;
    const std::size_t pixels = std::size_t(spec.width) * std::size_t(spec.height);
    std::vector<float> samples(pixels * std::size_t(spec.nchannels));
    if (!picture.get_pixels(picture.roi(), OIIO::TypeFloat, samples.data())) {
        error = picture.geterror();
        return false;
    }
    light.rgb.resize(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        for (int c = 0; c < 3; ++c)
            light.rgb[3 * i + std::size_t(c)] =
                samples[i * std::size_t(spec.nchannels) + std::size_t(colour.channel(colour.count() < 3 ? 0 : c))];
    colour.decode(light.rgb.data(), pixels);
    if (as_rec709)
        colour.to_rec709(light.rgb.data(), pixels);
    return true;
}

std::string named(std::string_view name, std::string_view content)
{
    return std::string(name).append(content);
}

/// The gain map as a JPEG stream of its own, with its metadata.
bool encode_map(const GainMap& map, int quality, std::string& stream, std::string& error)
{
    if (!encode_jpeg(map.pixels, quality, map.half_colour, stream, error))
        return false;
    const std::string segments = jpeg_segment(kApp1, named(kXmpName, xmp_gain_metadata(map.metadata)))
        + jpeg_segment(kApp2, named(kIsoName, iso_gain_metadata(map.metadata)));
    std::vector<JpegSegment> header;
    if (!jpeg_header(stream, header))
        return false;
    const bool has_jfif = !header.empty() && header[0].marker == kApp0;
    stream.insert(has_jfif ? header[0].end() : 2, segments);
    return true;
}

/// The base with our segments behind its own JFIF, Exif and profile, and the map behind it.
std::string join(const std::string& base, const std::vector<JpegSegment>& header, const std::string& map)
{
    std::string_view xmp;
    std::string first = base.substr(0, 2), rest;
    std::size_t at = 2;
    for (const JpegSegment& segment : header) {
        const bool is_xmp = segment.marker == kApp1 && segment.payload.substr(0, kXmpName.size()) == kXmpName;
        if (is_xmp)
            xmp = segment.payload.substr(kXmpName.size());
        else if (segment.marker >= kApp0 && segment.marker <= kApp2)
            first += base.substr(segment.begin, segment.end() - segment.begin);
        else
            rest += base.substr(segment.begin, segment.end() - segment.begin);
        at = segment.end();
    }
    std::string packet = named(kXmpName, xmp_with_directory(xmp, map.size()));
    if (packet.size() > kMostPayload)  // a packet of one segment has no room for both
        packet = named(kXmpName, xmp_with_directory({}, map.size()));
    first += jpeg_segment(kApp1, packet);
    first += jpeg_segment(kApp2, named(kIsoName, iso_gain_version()));
    rest.append(base, at, std::string::npos);
    const std::size_t tiff_header = first.size() + 4 + kMultiPictureName.size();
    const std::size_t first_size = tiff_header + kIndexSize + rest.size();
    const IndexedPicture second { std::uint32_t(first_size - tiff_header), std::uint32_t(map.size()) };
    first += jpeg_segment(kApp2, named(kMultiPictureName, multi_picture_index(std::uint32_t(first_size), second)));
    return first + rest + map;
}

/// The parts of a gain-map file.
struct Parts {
    std::string_view base, map;
    GainMetadata metadata;
};

/// The metadata of a JPEG stream that may be a gain map. False, without an error if it is none.
bool find_metadata(std::string_view stream, GainMetadata& metadata, std::string& error)
{
    std::vector<JpegSegment> header;
    if (!jpeg_header(stream, header))
        return false;
    if (const std::string_view iso = find_segment(header, kApp2, kIsoName); iso.size() > iso_gain_version().size())
        return parse_iso_gain_metadata(iso, metadata, error);
    const std::string_view xmp = find_segment(header, kApp1, kXmpName);
    return xmp.find("GainMapMax") != std::string_view::npos && parse_xmp_gain_metadata(xmp, metadata, error);
}

/// The pictures that the index names; without one, the stream that follows the first.
std::vector<std::string_view> further_streams(std::string_view file, const std::vector<JpegSegment>& header)
{
    std::vector<std::string_view> streams;
    const std::string_view index = find_segment(header, kApp2, kMultiPictureName);
    if (!index.empty()) {
        const std::size_t tiff_header = std::size_t(index.data() - file.data());
        for (const IndexedPicture& picture : parse_multi_picture_index(index))
            if (picture.offset != 0 && picture.offset < file.size() - tiff_header)
                streams.push_back(file.substr(tiff_header + picture.offset, picture.size));
    }
    if (const std::size_t end = jpeg_size(file); end != 0 && end < file.size())
        streams.push_back(file.substr(end));
    return streams;
}

bool find_parts(std::string_view file, Parts& parts, std::string& error)
{
    std::vector<JpegSegment> header;
    if (!jpeg_header(file, header)) {
        error = "it is not a JPEG file, or cut off";
        return false;
    }
    for (const std::string_view stream : further_streams(file, header)) {
        if (!find_metadata(stream, parts.metadata, error)) {
            if (!error.empty())
                return false;
            continue;
        }
        const std::size_t size = jpeg_size(stream);
        if (size == 0) {
            error = "its gain map is cut off";
            return false;
        }
        parts.base = file.substr(0, std::size_t(stream.data() - file.data()));
        parts.map = stream.substr(0, size);
        return true;
    }
    error = "it has no gain map";
    return false;
}

bool check(const GainMapOptions& options, std::string& error)
{
    if (!check_options(options, error))
        return false;
    if (options.scale == 3)
        error = "scale=3: expected 1, 2 or 4 pixels, or 0";
    else if (options.channels == 2)
        error = "channels=2: expected 1 or 3";
    return error.empty();
}

bool fail(OIIO::ImageBuf& picture, const std::string& error)
{
    set_error(picture, error);
    return false;
}

/// The base in the primaries in which the gains are meant.
bool base_light(const Parts& parts, const OIIO::ImageBuf& base, const OIIO::ImageBuf& map, Light& light, Colour& colour,
                std::string& error)
{
    const bool other_primaries =
        !parts.metadata.base_colour_space && map.spec().find_attribute("ICCProfile") != nullptr;
    if (!linear_light(base, other_primaries, light, colour, error))
        return false;
    if (!other_primaries)
        return true;
    if (!Colour::resolve(map.spec(), "", "", colour, error))
        return false;
    colour.from_rec709(light.rgb.data(), light.rgb.size() / 3);
    return true;
}

bool render(const Parts& parts, float headroom, OIIO::ImageBuf& result)
{
    OIIO::ImageBuf base, map;
    std::string error;
    if (!decode_jpeg(parts.base, nullptr, base, error))
        return fail(result, format("its base cannot be read: {}", error));
    if (!decode_jpeg(parts.map, &base.spec(), map, error))
        return fail(result, format("its gain map cannot be read: {}", error));
    Light light;
    Colour colour;
    if (!base_light(parts, base, map, light, colour, error))
        return fail(result, error);
    apply_gain_map(map, parts.metadata, double(headroom), light);
    OIIO::ImageSpec spec = base.spec();
    spec.nchannels = 3;
    spec.channelnames = { "R", "G", "B" };
    spec.set_format(OIIO::TypeFloat);
    spec.erase_attribute("ICCProfile");
    spec.erase_attribute("jpeg:subsampling");
    colour.declare_linear(spec);
    result.reset(spec);
    return result.set_pixels(result.roi(), OIIO::TypeFloat, light.rgb.data());
}

}  // namespace

bool add_gain_map(const std::string& base, const OIIO::ImageBuf& rendition, const GainMapOptions& options,
                  std::string& file, std::string& error)
{
    std::vector<JpegSegment> header;
    OIIO::ImageBuf pixels;
    Light sdr, hdr;
    Colour colour;
    error.clear();
    if (!check(options, error))
        return false;
    if (!jpeg_header(base, header)) {
        error = "the base is not a JPEG file";
        return false;
    }
    if (has_gain_map(base)) {
        error = "the base has a gain map already";
        return false;
    }
    if (!decode_jpeg(base, nullptr, pixels, error) || !linear_light(rendition, true, hdr, colour, error)
        || !linear_light(pixels, false, sdr, colour, error))
        return false;
    colour.from_rec709(hdr.rgb.data(), hdr.rgb.size() / 3);
    if (sdr.width != hdr.width || sdr.height != hdr.height) {
        error = format("the base has {} x {} pixels, expected the {} x {} of its HDR rendition", sdr.width, sdr.height,
                       hdr.width, hdr.height);
        return false;
    }
    std::string map;
    if (!encode_map(make_gain_map(sdr, hdr, options), options.quality, map, error))
        return false;
    file = join(base, header, map);
    return true;
}

bool has_gain_map(const std::string& file)
{
    Parts parts;
    std::string error;
    return find_parts(file, parts, error);
}

OIIO::ImageBuf gain_map_rendition(const std::string& file, float headroom)
{
    OIIO::ImageBuf result;
    Parts parts;
    std::string error;
    try {
        if (!find_parts(file, parts, error))
            fail(result, error);
        else
            render(parts, headroom, result);
    } catch (const std::exception& e) {
        fail(result, e.what());
    }
    return result;
}

}  // namespace PIMG_ABI
}  // namespace pimg
