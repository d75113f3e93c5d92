// SPDX-License-Identifier: BSD-3-Clause
// Small pictures of every sample type for the codec's tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <pimg/codec.h>

namespace pimg_test {

struct Picture {
    pimg::PictureDesc desc;
    std::vector<std::uint8_t> pixels;  ///< packed

    std::vector<pimg::ConstStridedChannel> planes() const
    {
        return pimg::interleaved(desc, (const void*)pixels.data());
    }
};

inline std::uint32_t noise(std::uint32_t& state)
{
    state = state * 1664525u + 1013904223u;
    return state >> 8;
}

/// Without its fraction; of negative numbers, the lower bits, which only integers have on every machine.
inline std::uint32_t whole(double number)
{
    return std::uint32_t(std::int64_t(number));
}

/// A slope with an edge and a little noise; channel c of any type, `types` one each.
inline Picture make_picture(std::uint32_t width, std::uint32_t height, const std::vector<pimg::SampleType>& types,
                            std::uint32_t seed = 1)
{
    Picture p;
    p.desc.data = { -3, 5, width, height };
    p.desc.display = { 0, 0, width + 7, height + 1 };
    for (std::size_t c = 0; c < types.size(); ++c)
        p.desc.channels.push_back({ c < 4 ? std::string(1, "RGBA"[c]) : "extra." + std::to_string(c), types[c] });
    p.pixels.resize(p.desc.pixel_bytes() * p.desc.pixels());
    std::uint8_t* to = p.pixels.data();
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < types.size(); ++c) {
                const double level = 20 + 100.0 * x / width + 40 * std::sin(0.2 * y + double(c))
                    + (x + 2 * y > width ? 60 : 0) + double(noise(seed) % 7);
                std::uint32_t bits = 0;
                switch (types[c]) {
                case pimg::SampleType::uint8:
                    bits = whole(level);
                    break;
                case pimg::SampleType::uint16:
                    bits = whole(level * 200);
                    break;
                case pimg::SampleType::uint32:
                    bits = whole(level * 1e7);
                    break;
                case pimg::SampleType::half:
                    bits = 0x2c00u + whole(level * 20);
                    break;
                case pimg::SampleType::float32: {
                    const float f = float(level) / 255.0f;
                    std::memcpy(&bits, &f, 4);
                    break;
                }
                }
                const std::size_t n = pimg::size_of(types[c]);
                for (std::size_t k = 0; k < n; ++k)
                    *to++ = std::uint8_t(bits >> (8 * k));
            }
    return p;
}

/// The kinds of pictures every reader must master; small enough to damage at every byte.
inline std::vector<Picture> conformance_pictures()
{
    using T = pimg::SampleType;
    std::vector<Picture> all;
    all.push_back(make_picture(1, 1, { T::uint8 }));
    all.push_back(make_picture(33, 1, { T::uint16, T::uint8 }));
    all.push_back(make_picture(40, 28, { T::uint8, T::uint8, T::uint8 }));
    all.push_back(make_picture(24, 37, { T::half, T::half, T::half, T::half }));
    all.push_back(make_picture(21, 19, { T::float32, T::uint32 }));
    Picture& named = all[2];
    named.desc.attributes = { { "Make", "string", { 'a', 'b', 0, 'c' } },
                              { "empty", "", {} },
                              { "Make", "int[3]", Picture().pixels } };
    return all;
}

}  // namespace pimg_test
