// SPDX-License-Identifier: BSD-3-Clause
// Adaptive binary range coder, for what is small: the mesh layer and the tables of the symbol coder. Carries are
// resolved by holding back the last byte below 255 (Martin 1979; the arrangement is that of LZMA).
#pragma once

#include <cstddef>
#include <cstdint>

#include "entropy/bytes.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Estimate of the probability of a 0, in 1/32768. Learns fast at first.
struct AdaptiveBit {
    std::uint16_t zero = 1 << 14;
    std::uint16_t seen = 0;

    void learn(bool bit)
    {
        const int shift = seen < 4 ? 3 : seen < 16 ? 4 : 5;
        if (bit)
            zero = std::uint16_t(zero - (zero >> shift));
        else
            zero = std::uint16_t(zero + ((32768 - zero) >> shift));
        seen = std::uint16_t(seen < 16 ? seen + 1 : seen);
    }
};

class BinaryWriter {
public:
    void bit(AdaptiveBit& model, bool value);
    /// `count` bits (0 .. 32) of equal probability, highest first.
    void direct(std::uint32_t value, int count);
    /// Ends the stream; returns its bytes.
    Bytes finish();

private:
    void shift_low();

    std::uint64_t m_low = 0;
    std::uint32_t m_range = 0xffffffffu;
    std::uint32_t m_cache = 0;
    std::uint64_t m_pending = 1;
    Bytes m_out;
};

/// Past the end of its bytes it reads zeros. overrun() tells whether that happened; callers check it from time to time.
class BinaryReader {
public:
    BinaryReader(const std::uint8_t* data, std::size_t size);
    bool bit(AdaptiveBit& model)
    {
        const std::uint32_t bound = (m_range >> 15) * model.zero;
        const bool value = m_code >= bound;
        if (value) {
            m_code -= bound;
            m_range -= bound;
        } else
            m_range = bound;
        model.learn(value);
        fill();
        return value;
    }
    std::uint32_t direct(int count);
    bool overrun() const { return m_over > 4; }

private:
    void fill()
    {
        while (m_range < 1u << 24) {
            m_range <<= 8;
            m_code = m_code << 8 | next();
        }
    }
    std::uint32_t next() { return m_at < m_size ? m_data[m_at++] : (++m_over, 0u); }

    const std::uint8_t* m_data;
    std::size_t m_size, m_at = 0, m_over = 0;
    std::uint32_t m_range = 0xffffffffu, m_code = 0;
};

/// Adaptive code of numbers 0 .. 2^32 - 1: their length in bits, then the two bits under the leading one, then the
/// rest as direct bits.
class NumberModel {
public:
    void write(BinaryWriter& out, std::uint32_t value);
    std::uint32_t read(BinaryReader& in);

private:
    AdaptiveBit m_length[64];
    AdaptiveBit m_high[33][4];
};

/// The same for signed numbers: 0, -1, 1, -2, 2 ...
inline std::uint32_t fold(std::int32_t v)
{
    return std::uint32_t(v) << 1 ^ std::uint32_t(v >> 31);
}
inline std::int32_t unfold(std::uint32_t v)
{
    return std::int32_t(v >> 1 ^ (0u - (v & 1)));
}

/// Bits needed to write v: 0 for 0.
inline int bit_length(std::uint32_t v)
{
    return v == 0 ? 0 : 32 - __builtin_clz(v);
}

}  // namespace PIMG_ABI
}  // namespace pimg
