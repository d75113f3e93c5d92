// SPDX-License-Identifier: BSD-3-Clause
// The segments of a JPEG stream (ITU-T T.81, annex B): found, and put in. Pixels are OpenImageIO's business.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

constexpr unsigned char kApp0 = 0xE0, kApp1 = 0xE1, kApp2 = 0xE2;

/// A segment of the header: `payload` is what follows its length.
struct JpegSegment {
    unsigned char marker = 0;
    std::size_t begin = 0;  ///< of its marker, from the beginning of the stream
    std::string_view payload;

    std::size_t end() const { return begin + 4 + payload.size(); }
};

/// The segments before the first scan. False if the bytes do not begin as a JPEG stream, or end before a scan.
bool jpeg_header(std::string_view stream, std::vector<JpegSegment>& segments);

/// Size of the stream that the bytes begin with, its end marker included; 0 if there is no end.
std::size_t jpeg_size(std::string_view bytes);

/// The payload of the first segment with that marker that begins with `signature`, without it; empty if there is none.
std::string_view find_segment(const std::vector<JpegSegment>& segments, unsigned char marker,
                              std::string_view signature);

/// The most bytes that a segment holds (T.81, B.1.1.4: a length of 16 bits, itself included).
constexpr std::size_t kMostPayload = 65533;

/// A segment as bytes, of at most kMostPayload bytes.
std::string jpeg_segment(unsigned char marker, std::string_view payload);

/// Pixels from a JPEG stream, as float, 0..1, with its metadata. False, with a line saying why, if it cannot be read, has
/// more pixels than its bytes can hold, or is larger than `base`, where that is given. Memory is taken after that.
bool decode_jpeg(std::string_view stream, const OIIO::ImageSpec* base, OIIO::ImageBuf& pixels, std::string& error);

/// A JPEG stream from pixels of 1 or 3 channels, 0..1; `half_colour` halves the resolution of colour both ways.
bool encode_jpeg(const OIIO::ImageBuf& pixels, int quality, bool half_colour, std::string& stream, std::string& error);

}  // namespace PIMG_ABI
}  // namespace pimg
