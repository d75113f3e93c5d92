// SPDX-License-Identifier: BSD-3-Clause
#include "jpeg_stream.h"

#include <algorithm>
#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <pimg/detail/format.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr unsigned char kStart = 0xD8, kEnd = 0xD9, kScan = 0xDA, kRestart0 = 0xD0, kRestart7 = 0xD7, kTemporary = 0x01;

/// A square of 16 x 16 pixels has at least six blocks, with a bit of its own for each, and so six bits.
constexpr std::size_t kMostPixelsInByte = 16 * 16 * 8 / 6 + 1;

unsigned char byte_at(std::string_view bytes, std::size_t i)
{
    return static_cast<unsigned char>(bytes[i]);
}

bool begins_stream(std::string_view bytes)
{
    return bytes.size() >= 4 && byte_at(bytes, 0) == 0xFF && byte_at(bytes, 1) == kStart && byte_at(bytes, 2) == 0xFF;
}

/// Reads the segment whose marker is at `at`, and moves `at` behind it. False if the segment has no length or is cut
/// off.
bool read_segment(std::string_view stream, std::size_t& at, JpegSegment& segment)
{
    while (at + 1 < stream.size() && byte_at(stream, at) == 0xFF && byte_at(stream, at + 1) == 0xFF)
        ++at;  // fill bytes may precede a marker
    if (at + 4 > stream.size() || byte_at(stream, at) != 0xFF)
        return false;
    segment.marker = byte_at(stream, at + 1);
    const std::size_t length = std::size_t(byte_at(stream, at + 2)) << 8 | byte_at(stream, at + 3);
    const bool has_length = segment.marker >= 0xC0 && !(segment.marker >= kRestart0 && segment.marker <= kEnd);
    if (!has_length || length < 2 || at + 2 + length > stream.size())
        return false;
    segment.begin = at;
    segment.payload = stream.substr(at + 4, length - 2);
    at += 2 + length;
    return true;
}

/// Takes a stream apart into its ICC profile (ICC.1, annex B.4) and what is left. OpenImageIO 2.4 reads beyond the end of
/// damaged profiles, and so gets none.
void take_profile(std::string_view stream, std::string& rest, std::string& profile)
{
    constexpr std::string_view kName { "ICC_PROFILE\0", 12 };
    constexpr std::size_t kNumbers = 2;  // which part of a profile it is, and of how many
    std::vector<JpegSegment> header;
    jpeg_header(stream, header);
    std::size_t at = 0;
    for (const JpegSegment& segment : header)
        if (segment.marker == kApp2 && segment.payload.substr(0, kName.size()) == kName) {
            profile += segment.payload.substr(std::min(kName.size() + kNumbers, segment.payload.size()));
            rest += stream.substr(at, segment.begin - at);
            at = segment.end();
        }
    rest += stream.substr(at);
}

/// The next marker in coded data that is neither a stuffed byte nor a restart.
std::size_t end_of_scan(std::string_view bytes, std::size_t at)
{
    for (; at + 1 < bytes.size(); ++at) {
        const unsigned char next = byte_at(bytes, at + 1);
        if (byte_at(bytes, at) == 0xFF && next != 0 && next != 0xFF && next != kTemporary
            && !(next >= kRestart0 && next <= kRestart7))
            return at;
    }
    return bytes.size();
}

}  // namespace

bool jpeg_header(std::string_view stream, std::vector<JpegSegment>& segments)
{
    segments.clear();
    if (!begins_stream(stream))
        return false;
    std::size_t at = 2;
    JpegSegment segment;
    while (read_segment(stream, at, segment)) {
        if (segment.marker == kScan)
            return true;
        segments.push_back(segment);
    }
    return false;
}

std::size_t jpeg_size(std::string_view bytes)
{
    if (!begins_stream(bytes))
        return 0;
    std::size_t at = 2;
    while (at + 1 < bytes.size()) {
        if (byte_at(bytes, at) == 0xFF && byte_at(bytes, at + 1) == kEnd)
            return at + 2;
        JpegSegment segment;
        if (!read_segment(bytes, at, segment))
            return 0;
        if (segment.marker == kScan)
            at = end_of_scan(bytes, at);
    }
    return 0;
}

std::string_view find_segment(const std::vector<JpegSegment>& segments, unsigned char marker,
                              std::string_view signature)
{
    for (const JpegSegment& segment : segments)
        if (segment.marker == marker && segment.payload.substr(0, signature.size()) == signature)
            return segment.payload.substr(signature.size());
    return {};
}

std::string jpeg_segment(unsigned char marker, std::string_view payload)
{
    const std::size_t length = payload.size() + 2;
    std::string segment { char(0xFF), char(marker), char(length >> 8), char(length & 0xFF) };
    return segment.append(payload);
}

bool decode_jpeg(std::string_view stream, const OIIO::ImageSpec* base, OIIO::ImageBuf& pixels, std::string& error)
{
    std::string rest, profile;
    take_profile(stream, rest, profile);
    OIIO::Filesystem::IOMemReader memory(rest.data(), rest.size());
    const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open("picture.jpg", nullptr, &memory);
    if (!in) {
        error = first_line(OIIO::geterror());
        return false;
    }
    OIIO::ImageSpec spec = in->spec();
    if (base != nullptr && (spec.width > base->width || spec.height > base->height)) {
        error = format("it has {} x {} pixels, expected at most the {} x {} of the base", spec.width, spec.height,
                       base->width, base->height);
        return false;
    }
    if (spec.image_pixels() > stream.size() * kMostPixelsInByte) {
        error = format("{} bytes are too few for {} x {} pixels", stream.size(), spec.width, spec.height);
        return false;
    }
    spec.set_format(OIIO::TypeFloat);
    if (!profile.empty())
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, int(profile.size())), profile.data());
    pixels.reset(spec);
    if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.localpixels())) {
        error = first_line(in->geterror());
        return false;
    }
    return true;
}

bool encode_jpeg(const OIIO::ImageBuf& pixels, int quality, bool half_colour, std::string& stream, std::string& error)
{
    const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create("map.jpg");
    if (!out) {
        error = OIIO::geterror();
        return false;
    }
    OIIO::ImageSpec spec(pixels.spec().width, pixels.spec().height, pixels.nchannels(), OIIO::TypeUInt8);
    spec.attribute("Compression", format("jpeg:{}", quality));
    spec.attribute("jpeg:progressive", 1);  // its Huffman tables are made for the picture: a map is 9 % smaller
    spec.attribute("jpeg:subsampling", half_colour ? "4:2:0" : "4:4:4");
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const bool written = out->set_ioproxy(&memory) && out->open("map.jpg", spec)
        && out->write_image(OIIO::TypeFloat, pixels.localpixels()) && out->close();
    if (!written) {
        error = out->geterror();
        return false;
    }
    stream.assign(bytes.begin(), bytes.end());
    return true;
}

}  // namespace PIMG_ABI
}  // namespace pimg
