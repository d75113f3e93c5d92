// SPDX-License-Identifier: BSD-3-Clause
#include "raster/samples.h"

#include <algorithm>
#include <cstring>

namespace pimg {
inline namespace PIMG_ABI {

std::size_t size_of(SampleType type)
{
    switch (type) {
    case SampleType::uint8:
        return 1;
    case SampleType::uint16:
    case SampleType::half:
        return 2;
    case SampleType::uint32:
    case SampleType::float32:
        return 4;
    }
    return 0;
}

std::size_t PictureDesc::pixel_bytes() const
{
    return offset_of(channels.size());
}

std::size_t PictureDesc::offset_of(std::size_t c) const
{
    std::size_t offset = 0;
    for (std::size_t i = 0; i < c; ++i)
        offset += size_of(channels[i].type);
    return offset;
}

namespace {

template<class ChannelType, class Pointer>
std::vector<ChannelType> interleaved_channels(const PictureDesc& desc, Pointer pixels)
{
    std::vector<ChannelType> channels;
    const std::ptrdiff_t pixel = std::ptrdiff_t(desc.pixel_bytes());
    for (std::size_t c = 0; c < desc.channels.size(); ++c)
        channels.push_back({ pixels + desc.offset_of(c), pixel, pixel * std::ptrdiff_t(desc.data.width) });
    return channels;
}

}  // namespace

std::vector<ConstStridedChannel> interleaved(const PictureDesc& desc, const void* pixels)
{
    return interleaved_channels<ConstStridedChannel>(desc, static_cast<const std::uint8_t*>(pixels));
}

std::vector<StridedChannel> interleaved(const PictureDesc& desc, void* pixels)
{
    return interleaved_channels<StridedChannel>(desc, static_cast<std::uint8_t*>(pixels));
}

bool allows(const PictureDesc& desc, Transform transform)
{
    if (transform == Transform::none)
        return true;
    const auto& c = desc.channels;
    return c.size() >= 3 && c[0].type == c[1].type && c[0].type == c[2].type && size_of(c[0].type) <= 2;
}

std::int32_t to_integer(SampleType type, std::uint32_t bits)
{
    switch (type) {
    case SampleType::uint8:
    case SampleType::uint16:
        return std::int32_t(bits);
    case SampleType::uint32:
        return std::int32_t(bits ^ 0x80000000u);
    case SampleType::half:
        return std::int16_t(bits & 0x8000u ? bits ^ 0x7fffu : bits);
    case SampleType::float32:
        return std::int32_t(bits & 0x80000000u ? bits ^ 0x7fffffffu : bits);
    }
    return 0;
}

std::uint32_t to_bits(SampleType type, std::int32_t integer)
{
    const std::uint32_t bits = std::uint32_t(integer);
    switch (type) {
    case SampleType::uint8:
        return bits & 0xffu;
    case SampleType::uint16:
        return bits & 0xffffu;
    case SampleType::uint32:
        return bits ^ 0x80000000u;
    case SampleType::half:
        return (bits & 0x8000u ? bits ^ 0x7fffu : bits) & 0xffffu;
    case SampleType::float32:
        return bits & 0x80000000u ? bits ^ 0x7fffffffu : bits;
    }
    return 0;
}

int mesh_shift(SampleType type)
{
    return size_of(type) == 4 ? 16 : 0;
}

namespace {

template<class T>
void gather_channel(SampleType type, const ConstStridedChannel& channel, std::uint32_t x0, std::uint32_t y0,
                    std::uint32_t width, std::uint32_t height, std::int32_t* to)
{
    for (std::uint32_t y = 0; y < height; ++y) {
        const auto* from = static_cast<const std::uint8_t*>(channel.data) + std::ptrdiff_t(y0 + y) * channel.y_stride
            + std::ptrdiff_t(x0) * channel.x_stride;
        for (std::uint32_t x = 0; x < width; ++x, from += channel.x_stride) {
            T bits;
            std::memcpy(&bits, from, sizeof bits);
            *to++ = to_integer(type, bits);
        }
    }
}

template<SampleType Stored, class T>
void scatter_channel(const std::int32_t* from, std::uint32_t width, std::uint32_t height, const StridedChannel& channel,
                     std::uint32_t x0, std::uint32_t y0)
{
    for (std::uint32_t y = 0; y < height; ++y) {
        auto* to = static_cast<std::uint8_t*>(channel.data) + std::ptrdiff_t(y0 + y) * channel.y_stride
            + std::ptrdiff_t(x0) * channel.x_stride;
        for (std::uint32_t x = 0; x < width; ++x, to += channel.x_stride) {
            const T bits = T(to_bits(Stored, *from++));
            std::memcpy(to, &bits, sizeof bits);
        }
    }
}

/// Values a type's integers can have.
void range_of(SampleType type, std::int32_t& low, std::int32_t& high)
{
    switch (type) {
    case SampleType::uint8:
        low = 0, high = 255;
        break;
    case SampleType::uint16:
        low = 0, high = 65535;
        break;
    // Only finite numbers: the mesh layer is an approximation, which need not show infinities and NaN.
    case SampleType::half:
        low = -1 - 0x7bff, high = 0x7bff;
        break;
    case SampleType::float32:
        low = -1 - 0x7f7fffff, high = 0x7f7fffff;
        break;
    case SampleType::uint32:
        low = INT32_MIN, high = INT32_MAX;
        break;
    }
}

}  // namespace

Integers gather(const PictureDesc& desc, const std::vector<ConstStridedChannel>& channels, std::uint32_t x,
                std::uint32_t y, std::uint32_t width, std::uint32_t height)
{
    Integers result;
    result.width = width;
    result.height = height;
    result.channels.resize(channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const SampleType type = desc.channels[c].type;
        result.channels[c].resize(std::size_t(width) * height);
        std::int32_t* to = result.channels[c].data();
        switch (size_of(type)) {
        case 1:
            gather_channel<std::uint8_t>(type, channels[c], x, y, width, height, to);
            break;
        case 2:
            gather_channel<std::uint16_t>(type, channels[c], x, y, width, height, to);
            break;
        default:
            gather_channel<std::uint32_t>(type, channels[c], x, y, width, height, to);
        }
    }
    return result;
}

void scatter(SampleType type, std::vector<std::int32_t>& integers, std::uint32_t width, std::uint32_t height,
             bool clamp, const StridedChannel& channel, std::uint32_t x, std::uint32_t y)
{
    if (clamp) {
        std::int32_t low = 0, high = 0;
        range_of(type, low, high);
        for (std::int32_t& v : integers)
            v = std::clamp(v, low, high);
    }
    using S = SampleType;
    const std::int32_t* from = integers.data();
    switch (type) {
    case S::uint8:
        scatter_channel<S::uint8, std::uint8_t>(from, width, height, channel, x, y);
        break;
    case S::uint16:
        scatter_channel<S::uint16, std::uint16_t>(from, width, height, channel, x, y);
        break;
    case S::half:
        scatter_channel<S::half, std::uint16_t>(from, width, height, channel, x, y);
        break;
    case S::uint32:
        scatter_channel<S::uint32, std::uint32_t>(from, width, height, channel, x, y);
        break;
    case S::float32:
        scatter_channel<S::float32, std::uint32_t>(from, width, height, channel, x, y);
        break;
    }
}

namespace {

std::int32_t add(std::int32_t a, std::int32_t b)
{
    return std::int32_t(std::uint32_t(a) + std::uint32_t(b));
}
std::int32_t subtract(std::int32_t a, std::int32_t b)
{
    return std::int32_t(std::uint32_t(a) - std::uint32_t(b));
}

}  // namespace

void forward(Transform transform, std::vector<std::vector<std::int32_t>>& channels)
{
    if (transform == Transform::none)
        return;
    std::int32_t *a = channels[0].data(), *b = channels[1].data(), *c = channels[2].data();
    const std::size_t n = channels[0].size();
    for (std::size_t i = 0; i < n; ++i) {
        const std::int32_t red = a[i], green = b[i], blue = c[i];
        if (transform == Transform::ycocg) {
            c[i] = subtract(red, blue);
            const std::int32_t t = add(blue, c[i] >> 1);
            b[i] = subtract(green, t);
            a[i] = add(t, b[i] >> 1);
        } else {
            a[i] = green;
            b[i] = subtract(blue, green);
            c[i] = subtract(red, green);
        }
    }
}

void inverse(Transform transform, std::vector<std::vector<std::int32_t>>& channels)
{
    if (transform == Transform::none)
        return;
    std::int32_t *a = channels[0].data(), *b = channels[1].data(), *c = channels[2].data();
    const std::size_t n = channels[0].size();
    for (std::size_t i = 0; i < n; ++i) {
        const std::int32_t first = a[i], second = b[i], third = c[i];
        if (transform == Transform::ycocg) {
            const std::int32_t t = subtract(first, second >> 1);
            b[i] = add(second, t);
            c[i] = subtract(t, third >> 1);
            a[i] = add(c[i], third);
        } else {
            b[i] = first;
            c[i] = add(second, first);
            a[i] = add(third, first);
        }
    }
}

namespace {

/// Whether rows are packed pixels in the byte order of the hash.
bool is_packed(const PictureDesc& desc, const std::vector<ConstStridedChannel>& channels)
{
    const std::uint16_t probe = 1;
    std::uint8_t low = 0;
    std::memcpy(&low, &probe, 1);
    bool packed = low == 1;
    for (std::size_t c = 0; c < channels.size(); ++c)
        packed = packed && channels[c].x_stride == std::ptrdiff_t(desc.pixel_bytes())
            && channels[c].y_stride == channels[0].y_stride
            && static_cast<const std::uint8_t*>(channels[c].data)
                == static_cast<const std::uint8_t*>(channels[0].data) + desc.offset_of(c);
    return packed;
}

}  // namespace

std::uint64_t hash_samples(const PictureDesc& desc, const std::vector<ConstStridedChannel>& channels)
{
    SampleHash hash;
    const std::size_t pixel = desc.pixel_bytes();
    if (is_packed(desc, channels)) {
        for (std::uint32_t y = 0; y < desc.data.height; ++y)
            hash.add(static_cast<const std::uint8_t*>(channels[0].data) + std::ptrdiff_t(y) * channels[0].y_stride,
                     pixel * desc.data.width);
        return hash.value();
    }
    Bytes row(pixel * desc.data.width);
    for (std::uint32_t y = 0; y < desc.data.height; ++y) {
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const std::size_t bytes = size_of(desc.channels[c].type);
            const auto* from =
                static_cast<const std::uint8_t*>(channels[c].data) + std::ptrdiff_t(y) * channels[c].y_stride;
            std::uint8_t* to = row.data() + desc.offset_of(c);
            for (std::uint32_t x = 0; x < desc.data.width; ++x, to += pixel, from += channels[c].x_stride) {
                std::uint32_t bits = 0;
                if (bytes == 1)
                    bits = *from;
                else if (bytes == 2) {
                    std::uint16_t v;
                    std::memcpy(&v, from, 2);
                    bits = v;
                } else
                    std::memcpy(&bits, from, 4);
                for (std::size_t k = 0; k < bytes; ++k)
                    to[k] = std::uint8_t(bits >> (8 * k));
            }
        }
        hash.add(row.data(), row.size());
    }
    return hash.value();
}

}  // namespace PIMG_ABI
}  // namespace pimg
