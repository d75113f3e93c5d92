// SPDX-License-Identifier: BSD-3-Clause
#include "entropy/bytes.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <zstd.h>

namespace pimg {
inline namespace PIMG_ABI {

void put_u16(Bytes& out, std::uint32_t v)
{
    put_u8(out, v & 255);
    put_u8(out, v >> 8 & 255);
}

void put_u32(Bytes& out, std::uint32_t v)
{
    put_u16(out, v & 65535);
    put_u16(out, v >> 16);
}

void put_u64(Bytes& out, std::uint64_t v)
{
    put_u32(out, std::uint32_t(v));
    put_u32(out, std::uint32_t(v >> 32));
}

void put_varint(Bytes& out, std::uint64_t v)
{
    for (; v >= 128; v >>= 7)
        put_u8(out, std::uint32_t(v & 127) | 128);
    put_u8(out, std::uint32_t(v));
}

void put_bytes(Bytes& out, const void* data, std::size_t size)
{
    const auto* p = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), p, p + size);
}

const std::uint8_t* ByteReader::take(std::size_t size)
{
    if (!m_ok || size > left()) {
        m_ok = false;
        return nullptr;
    }
    const std::uint8_t* p = m_data + m_at;
    m_at += size;
    return p;
}

std::uint32_t ByteReader::u8()
{
    const std::uint8_t* p = take(1);
    return p ? *p : 0;
}

std::uint32_t ByteReader::u16()
{
    const std::uint8_t* p = take(2);
    return p ? load_u16(p) : 0;
}

std::uint32_t ByteReader::u32()
{
    const std::uint8_t* p = take(4);
    return p ? load_u32(p) : 0;
}

std::uint64_t ByteReader::u64()
{
    const std::uint8_t* p = take(8);
    return p ? load_u64(p) : 0;
}

std::uint64_t ByteReader::varint()
{
    std::uint64_t v = 0;
    for (int shift = 0; shift < 63; shift += 7) {
        const std::uint32_t byte = u8();
        v |= std::uint64_t(byte & 127) << shift;
        if (byte < 128)
            return v;
    }
    m_ok = false;
    return 0;
}

std::string ByteReader::text(std::size_t size)
{
    const std::uint8_t* p = take(size);
    return p ? std::string(reinterpret_cast<const char*>(p), size) : std::string();
}

namespace {

/// Eight tables: table k advances a byte that is k bytes away from the end of a group of eight.
using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

CrcTables make_crc_tables()
{
    CrcTables tables {};
    for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t c = i;
        for (int k = 0; k < 8; ++k)
            c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
        tables[0][i] = c;
    }
    for (std::size_t k = 1; k < 8; ++k)
        for (std::size_t i = 0; i < 256; ++i)
            tables[k][i] = tables[0][tables[k - 1][i] & 255] ^ (tables[k - 1][i] >> 8);
    return tables;
}

}  // namespace

std::uint32_t crc32(std::uint32_t crc, const void* data, std::size_t size)
{
    static const CrcTables t = make_crc_tables();
    const auto* p = static_cast<const std::uint8_t*>(data);
    crc = ~crc;
    for (; size >= 8; size -= 8, p += 8) {
        const std::uint32_t a = load_u32(p) ^ crc, b = load_u32(p + 4);
        crc = t[7][a & 255] ^ t[6][a >> 8 & 255] ^ t[5][a >> 16 & 255] ^ t[4][a >> 24] ^ t[3][b & 255]
            ^ t[2][b >> 8 & 255] ^ t[1][b >> 16 & 255] ^ t[0][b >> 24];
    }
    for (; size > 0; --size, ++p)
        crc = t[0][(crc ^ *p) & 255] ^ (crc >> 8);
    return ~crc;
}

namespace {

/// The five primes of XXH64, in the order of its specification.
constexpr std::uint64_t kPrime[5] = { 0x9e3779b185ebca87u, 0xc2b2ae3d27d4eb4fu, 0x165667b19e3779f9u,
                                      0x85ebca77c2b2ae63u, 0x27d4eb2f165667c5u };

std::uint64_t rotate(std::uint64_t v, int bits)
{
    return v << bits | v >> (64 - bits);
}

std::uint64_t hash_round(std::uint64_t lane, std::uint64_t input)
{
    return rotate(lane + input * kPrime[1], 31) * kPrime[0];
}

}  // namespace

SampleHash::SampleHash() : m_lane { kPrime[0] + kPrime[1], kPrime[1], 0, 0 - kPrime[0] }, m_rest {} { }

void SampleHash::add(const std::uint8_t* data, std::size_t size)
{
    m_total += size;
    while (size > 0) {
        if (m_in_rest == 0 && size >= 32) {
            for (; size >= 32; size -= 32, data += 32)
                for (std::size_t k = 0; k < 4; ++k)
                    m_lane[k] = hash_round(m_lane[k], load_u64(data + 8 * k));
            continue;
        }
        const std::size_t n = std::min(size, 32 - m_in_rest);
        std::memcpy(m_rest + m_in_rest, data, n);
        m_in_rest += n;
        data += n;
        size -= n;
        if (m_in_rest == 32) {
            for (std::size_t k = 0; k < 4; ++k)
                m_lane[k] = hash_round(m_lane[k], load_u64(m_rest + 8 * k));
            m_in_rest = 0;
        }
    }
}

std::uint64_t SampleHash::value() const
{
    std::uint64_t h = kPrime[4];
    if (m_total >= 32) {
        h = rotate(m_lane[0], 1) + rotate(m_lane[1], 7) + rotate(m_lane[2], 12) + rotate(m_lane[3], 18);
        for (std::uint64_t lane : m_lane)
            h = (h ^ hash_round(0, lane)) * kPrime[0] + kPrime[3];
    }
    h += m_total;
    std::size_t i = 0;
    for (; i + 8 <= m_in_rest; i += 8)
        h = rotate(h ^ hash_round(0, load_u64(m_rest + i)), 27) * kPrime[0] + kPrime[3];
    for (; i + 4 <= m_in_rest; i += 4)
        h = rotate(h ^ load_u32(m_rest + i) * kPrime[0], 23) * kPrime[1] + kPrime[2];
    for (; i < m_in_rest; ++i)
        h = rotate(h ^ m_rest[i] * kPrime[4], 11) * kPrime[0];
    h = (h ^ h >> 33) * kPrime[1];
    h = (h ^ h >> 29) * kPrime[2];
    return h ^ h >> 32;
}

bool zstd_pack(const void* data, std::size_t size, int level, Bytes& out)
{
    out.resize(ZSTD_compressBound(size));
    const std::size_t n = ZSTD_compress(out.data(), out.size(), data, size, level);
    if (ZSTD_isError(n))
        return false;
    out.resize(n);
    return true;
}

bool zstd_unpack(const std::uint8_t* data, std::size_t packed, std::uint8_t* out, std::size_t size)
{
    if (packed == 0 || ZSTD_getFrameContentSize(data, packed) != size
        || ZSTD_findFrameCompressedSize(data, packed) != packed)
        return false;
    return ZSTD_decompress(out, size, data, packed) == size;
}

}  // namespace PIMG_ABI
}  // namespace pimg
