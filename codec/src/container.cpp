// SPDX-License-Identifier: BSD-3-Clause
#include "container.h"

#include <cstring>

namespace pimg {
inline namespace PIMG_ABI {

bool is_pimg(const void* data, std::size_t size)
{
    return size >= sizeof kSignature && std::memcmp(data, kSignature, sizeof kSignature) == 0;
}

bool ChunkHead::is(const char* name) const
{
    return std::memcmp(type, name, 4) == 0;
}

void put_chunk(Bytes& file, const char* type, std::uint16_t flags, const Bytes& payload)
{
    const std::size_t start = file.size();
    put_bytes(file, type, 4);
    put_u16(file, flags);
    put_u16(file, 0);
    put_u64(file, payload.size());
    put_bytes(file, payload.data(), payload.size());
    put_u32(file, crc32(0, file.data() + start, file.size() - start));
}

bool parse_chunk_head(const std::uint8_t* bytes, ChunkHead& head)
{
    for (int k = 0; k < 4; ++k) {
        const std::uint8_t letter = bytes[k] | 32;
        if (letter < 'a' || letter > 'z')
            return false;
        head.type[k] = char(bytes[k]);
    }
    head.flags = std::uint16_t(load_u16(bytes + 4));
    head.version = std::uint16_t(load_u16(bytes + 6));
    head.length = load_u64(bytes + 8);
    return head.version == 0 || !(head.flags & kCritical);
}

namespace {

void put_window(Bytes& out, const Window& w)
{
    put_u32(out, std::uint32_t(w.x));
    put_u32(out, std::uint32_t(w.y));
    put_u32(out, w.width);
    put_u32(out, w.height);
}

Window get_window(ByteReader& in)
{
    Window w;
    w.x = std::int32_t(in.u32());
    w.y = std::int32_t(in.u32());
    w.width = in.u32();
    w.height = in.u32();
    return w;
}

/// docs/format.md, section 2.
bool is_window_ok(const Window& w)
{
    constexpr std::int32_t kFar = 1 << 30;
    constexpr std::uint32_t kSide = 1u << 20;
    return w.x >= -kFar && w.x <= kFar && w.y >= -kFar && w.y <= kFar && w.width >= 1 && w.width <= kSide
        && w.height >= 1 && w.height <= kSide;
}

}  // namespace

Status check_desc(const PictureDesc& desc, const DecodeLimits& limits)
{
    const Window& data = desc.data;
    if (!is_window_ok(data) || !is_window_ok(desc.display))
        return Status::failure("pimg: window out of range (sides 1 to 2^20, corner within 2^30)");
    const std::uint64_t pixels = std::uint64_t(data.width) * data.height;
    if (data.width > limits.side || data.height > limits.side || pixels > limits.pixels || pixels > 1ull << 31)
        return Status::failure("pimg: a picture of " + std::to_string(data.width) + " x " + std::to_string(data.height)
                               + " pixels is over the limit");
    if (desc.channels.empty() || desc.channels.size() > 1024 || desc.channels.size() > limits.channels)
        return Status::failure("pimg: " + std::to_string(desc.channels.size()) + " channels; 1 to "
                               + std::to_string(limits.channels < 1024 ? limits.channels : 1024) + " are allowed");
    for (const ChannelDesc& c : desc.channels)
        if (size_of(c.type) == 0 || c.name.size() > 255)
            return Status::failure("pimg: a channel has an unknown type or a name over 255 bytes");
    if (desc.attributes.size() > 65536)
        return Status::failure("pimg: more than 65536 attributes");
    if (pixels * desc.pixel_bytes() > limits.sample_bytes)
        return Status::failure("pimg: the samples take more bytes than the limit allows");
    return {};
}

Bytes write_head(const FileHead& head, const PictureDesc& desc)
{
    Bytes out;
    put_u16(out, head.major);
    put_u16(out, head.minor);
    put_u8(out, head.profile);
    put_u8(out, head.transform);
    put_u16(out, head.tile);
    put_window(out, desc.data);
    put_window(out, desc.display);
    put_u32(out, head.channels);
    put_u32(out, head.vertices);
    put_u64(out, head.hash);
    return out;
}

Status read_head(ByteReader in, const DecodeLimits& limits, FileHead& head, PictureDesc& desc)
{
    head.major = std::uint16_t(in.u16());
    head.minor = std::uint16_t(in.u16());
    head.profile = std::uint8_t(in.u8());
    head.transform = std::uint8_t(in.u8());
    head.tile = std::uint16_t(in.u16());
    desc.data = get_window(in);
    desc.display = get_window(in);
    head.channels = in.u32();
    head.vertices = in.u32();
    head.hash = in.u64();
    if (!in.ok())
        return Status::failure("pimg: the header is too short");
    if (head.major != kMajorVersion)
        return Status::failure("pimg: file format version " + std::to_string(head.major) + "; this reader knows "
                               + std::to_string(kMajorVersion));
    if (head.profile > 1 || head.transform > 2 || head.tile < 16 || head.tile > 1024)
        return Status::failure("pimg: the header is damaged");
    if (head.channels < 1 || head.channels > 1024 || head.channels > limits.channels)
        return Status::failure("pimg: " + std::to_string(head.channels) + " channels are over the limit");
    return {};
}

Bytes write_channels(const PictureDesc& desc)
{
    Bytes out;
    for (const ChannelDesc& c : desc.channels) {
        put_u8(out, std::uint32_t(c.type));
        put_u8(out, std::uint32_t(c.name.size()));
        put_bytes(out, c.name.data(), c.name.size());
    }
    return out;
}

Status read_channels(ByteReader in, const DecodeLimits& limits, const FileHead& head, PictureDesc& desc)
{
    for (std::uint32_t c = 0; c < head.channels; ++c) {
        const std::uint32_t type = in.u8(), length = in.u8();
        if (type > std::uint32_t(SampleType::float32))
            return Status::failure("pimg: unknown sample type " + std::to_string(type));
        desc.channels.push_back({ in.text(length), SampleType(type) });
    }
    if (!in.finished())
        return Status::failure("pimg: the list of channels is damaged");
    const Status status = check_desc(desc, limits);
    if (status && !allows(desc, Transform(head.transform)))
        return Status::failure("pimg: a colour transform of unequal channels");
    return status;
}

namespace {

/// The most bytes that packed attributes may unpack to. Text is packed to a twentieth of its size at best, and a few
/// megabytes are harmless whatever they hold. Attributes that pack better than this are stored unpacked by writers.
std::uint64_t most_unpacked(std::uint64_t packed)
{
    return (std::uint64_t(4) << 20) + 64 * packed;
}

}  // namespace

Bytes write_attributes(const PictureDesc& desc)
{
    Bytes plain, packed, out;
    put_varint(plain, desc.attributes.size());
    for (const Attribute& a : desc.attributes) {
        put_varint(plain, a.name.size());
        put_bytes(plain, a.name.data(), a.name.size());
        put_varint(plain, a.type.size());
        put_bytes(plain, a.type.data(), a.type.size());
        put_varint(plain, a.value.size());
        put_bytes(plain, a.value.data(), a.value.size());
    }
    const bool smaller = zstd_pack(plain.data(), plain.size(), 9, packed) && packed.size() < plain.size()
        && plain.size() <= most_unpacked(packed.size());
    put_u8(out, smaller ? 1 : 0);
    put_varint(out, plain.size());
    const Bytes& body = smaller ? packed : plain;
    put_bytes(out, body.data(), body.size());
    return out;
}

Status read_attributes(ByteReader in, const DecodeLimits& limits, PictureDesc& desc)
{
    const auto bad = [] {
        return Status::failure("pimg: the attributes are damaged");
    };
    const std::uint32_t method = in.u8();
    const std::uint64_t size = in.varint();
    if (size > limits.attribute_bytes)
        return Status::failure("pimg: the attributes take more bytes than the limit allows");
    if (!in.ok() || method > 1 || (method == 0 && size != in.left()))
        return bad();
    Bytes plain;
    if (method == 1) {
        if (size > most_unpacked(in.left()))
            return Status::failure("pimg: the attributes unpack to " + std::to_string(size) + " bytes, more than "
                                   + std::to_string(in.left()) + " can be believed to hold");
        plain.resize(std::size_t(size));
        if (!zstd_unpack(in.here(), in.left(), plain.data(), plain.size()))
            return bad();
        in = ByteReader(plain);
    }
    const std::uint64_t count = in.varint();
    if (count > 65536)
        return bad();
    for (std::uint64_t i = 0; i < count; ++i) {
        Attribute a;
        const std::uint64_t name = in.varint();
        a.name = in.text(name > 65535 ? ~std::size_t(0) : std::size_t(name));
        const std::uint64_t type = in.varint();
        a.type = in.text(type > 255 ? ~std::size_t(0) : std::size_t(type));
        const std::uint64_t bytes = in.varint();
        const std::uint8_t* value = in.take(bytes > in.left() ? ~std::size_t(0) : std::size_t(bytes));
        if (!in.ok())
            return bad();
        a.value.assign(value, value + bytes);
        desc.attributes.push_back(std::move(a));
    }
    return in.finished() ? Status() : bad();
}

}  // namespace PIMG_ABI
}  // namespace pimg
