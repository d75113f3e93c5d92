// SPDX-License-Identifier: BSD-3-Clause
// Little-endian bytes, checked reading, checksums.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

using Bytes = std::vector<std::uint8_t>;

inline void put_u8(Bytes& out, std::uint32_t v)
{
    out.push_back(std::uint8_t(v));
}
void put_u16(Bytes& out, std::uint32_t v);
void put_u32(Bytes& out, std::uint32_t v);
void put_u64(Bytes& out, std::uint64_t v);
/// A number in groups of seven bits, the lowest first; the eighth bit of a byte is set on all but the last.
void put_varint(Bytes& out, std::uint64_t v);
void put_bytes(Bytes& out, const void* data, std::size_t size);

inline std::uint32_t load_u16(const std::uint8_t* p)
{
    return std::uint32_t(p[0]) | std::uint32_t(p[1]) << 8;
}
inline std::uint32_t load_u32(const std::uint8_t* p)
{
    return load_u16(p) | load_u16(p + 2) << 16;
}
inline std::uint64_t load_u64(const std::uint8_t* p)
{
    return load_u32(p) | std::uint64_t(load_u32(p + 4)) << 32;
}

/// Reads forward through a span. Past its end everything reads as 0 and ok() turns false for good, so a
/// parser may read a whole structure and ask once.
class ByteReader {
public:
    ByteReader(const std::uint8_t* data, std::size_t size) : m_data(data), m_size(size) { }
    explicit ByteReader(const Bytes& bytes) : ByteReader(bytes.data(), bytes.size()) { }

    std::uint32_t u8();
    std::uint32_t u16();
    std::uint32_t u32();
    std::uint64_t u64();
    std::uint64_t varint();
    std::string text(std::size_t size);
    /// The next `size` bytes; nullptr when there are fewer.
    const std::uint8_t* take(std::size_t size);

    std::size_t left() const { return m_size - m_at; }
    const std::uint8_t* here() const { return m_data + m_at; }
    bool ok() const { return m_ok; }
    bool finished() const { return m_ok && m_at == m_size; }

private:
    const std::uint8_t* m_data;
    std::size_t m_size, m_at = 0;
    bool m_ok = true;
};

/// CRC-32 of zlib and PNG (polynomial edb88320); start with 0, feed pieces in order.
std::uint32_t crc32(std::uint32_t crc, const void* data, std::size_t size);

/// XXH64 with seed 0, fed in pieces.
class SampleHash {
public:
    SampleHash();
    void add(const std::uint8_t* data, std::size_t size);
    std::uint64_t value() const;

private:
    std::uint64_t m_lane[4];
    std::uint8_t m_rest[32];
    std::size_t m_in_rest = 0;
    std::uint64_t m_total = 0;
};

/// zstd, one frame with its content size. `unpack` gives exactly `size` bytes or fails.
bool zstd_pack(const void* data, std::size_t size, int level, Bytes& out);
bool zstd_unpack(const std::uint8_t* data, std::size_t packed, std::uint8_t* out, std::size_t size);

}  // namespace PIMG_ABI
}  // namespace pimg
