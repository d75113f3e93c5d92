// SPDX-License-Identifier: BSD-3-Clause
// Pictures for the tests of the plugin, and files of them.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/fmath.h>
#include <OpenImageIO/imageio.h>

namespace pimg_test {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

struct Picture {
    ImageSpec spec;
    std::vector<std::uint8_t> pixels;  ///< native, packed
};

/// Every bit random: NaN, infinities and subnormals among the floating-point ones.
inline Picture noise(const ImageSpec& spec)
{
    Picture picture { spec, std::vector<std::uint8_t>(spec.image_bytes(true)) };
    std::uint32_t state = 12345;
    for (std::uint8_t& byte : picture.pixels) {
        state = state * 1664525u + 1013904223u;
        byte = std::uint8_t(state >> 24);
    }
    return picture;
}

/// A smooth function of the position, 0..1.
inline float slope_at(float x, float y, int channel)
{
    return 0.1f + x / 1000 + y / 2000 + 0.1f * float(channel);
}

inline Picture slope(const ImageSpec& spec)
{
    std::vector<float> values;
    for (int y = 0; y < spec.height; ++y)
        for (int x = 0; x < spec.width; ++x)
            for (int c = 0; c < spec.nchannels; ++c)
                values.push_back(slope_at(float(x), float(y), c));
    Picture picture { spec, std::vector<std::uint8_t>(spec.image_bytes()) };
    OIIO::convert_image(spec.nchannels, spec.width, spec.height, 1, values.data(), TypeDesc::FLOAT, OIIO::AutoStride,
                        OIIO::AutoStride, OIIO::AutoStride, picture.pixels.data(), spec.format, OIIO::AutoStride,
                        OIIO::AutoStride, OIIO::AutoStride);
    return picture;
}

inline void write(const Picture& picture, const std::string& name)
{
    const auto out = OIIO::ImageOutput::create(name);
    ASSERT_TRUE(out) << OIIO::geterror();
    ASSERT_TRUE(out->open(name, picture.spec)) << out->geterror();
    // Unknown: as the spec says, channel by channel.
    const TypeDesc format = picture.spec.channelformats.empty() ? picture.spec.format : TypeDesc(TypeDesc::UNKNOWN);
    ASSERT_TRUE(out->write_image(format, picture.pixels.data())) << out->geterror();
    ASSERT_TRUE(out->close()) << out->geterror();
}

inline std::unique_ptr<OIIO::ImageInput> open(const std::string& name)
{
    auto in = OIIO::ImageInput::open(name);
    EXPECT_TRUE(in) << OIIO::geterror();
    return in;
}

inline std::vector<std::uint8_t> read_native(OIIO::ImageInput& in)
{
    std::vector<std::uint8_t> pixels(in.spec().image_bytes(true));
    EXPECT_TRUE(in.read_image(0, 0, 0, in.spec().nchannels, TypeDesc::UNKNOWN, pixels.data())) << in.geterror();
    return pixels;
}

inline std::vector<unsigned char> bytes_of(const std::string& name)
{
    std::vector<unsigned char> bytes(OIIO::Filesystem::file_size(name));
    EXPECT_EQ(OIIO::Filesystem::read_bytes(name, bytes.data(), bytes.size()), bytes.size());
    return bytes;
}

/// Declares another size in the header of a file, with a valid checksum.
inline void set_size(std::vector<unsigned char>& file, std::uint32_t width, std::uint32_t height)
{
    constexpr std::size_t kHead = 8, kSize = kHead + 16 + 16, kCrc = kHead + 16 + 56;
    const auto put = [&](std::size_t at, std::uint32_t value) {
        for (std::size_t i = 0; i < 4; ++i)
            file[at + i] = std::uint8_t(value >> (8 * i));
    };
    put(kSize, width);
    put(kSize + 4, height);
    std::uint32_t crc = ~0u;
    for (std::size_t i = kHead; i < kCrc; ++i) {
        crc ^= file[i];
        for (int bit = 0; bit < 8; ++bit)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
    }
    put(kCrc, ~crc);
}

}  // namespace pimg_test
