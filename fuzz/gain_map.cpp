// SPDX-License-Identifier: BSD-3-Clause
// Gain-map JPEG files: the segments, the index, both spellings of the metadata, and both pictures. The input is a file.
#include <cmath>
#include <cstdint>
#include <string>

#include <OpenImageIO/imageio.h>

#include <pimg/gain_map.h>

#include "taken.h"

namespace {

/// Pictures up to this many pixels are decoded, or the time goes into large ones.
constexpr std::uint64_t kPixels = 1 << 14;

/// Whether a frame header, wherever it is, promises more.
bool is_large(const std::string& file)
{
    const auto byte = [&](std::size_t i) {
        return std::uint64_t(static_cast<unsigned char>(file[i]));
    };
    for (std::size_t i = 0; i + 8 < file.size(); ++i)
        if (byte(i) == 0xFF && byte(i + 1) >= 0xC0 && byte(i + 1) <= 0xC2
            && (byte(i + 5) << 8 | byte(i + 6)) * (byte(i + 7) << 8 | byte(i + 8)) > kPixels)
            return true;
    return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    OIIO::attribute("threads", 1);
    const std::string file(reinterpret_cast<const char*>(data), size);
    if (is_large(file))
        return 0;
    const bool has_map = pimg::has_gain_map(file);
    const OIIO::ImageBuf picture = pimg::gain_map_rendition(file, size % 2 ? -1.0f : 0.5f);
    if (picture.has_error()) {
        must_be_message(picture.geterror());
        return 0;
    }
    must(has_map && picture.nchannels() == 3);
    for (OIIO::ImageBuf::ConstIterator<float> pixel(picture); !pixel.done(); ++pixel)
        for (int c = 0; c < 3; ++c)
            must(std::isfinite(pixel[c]));
    return 0;
}
