// SPDX-License-Identifier: BSD-3-Clause
#include "entropy/binary_coder.h"

namespace pimg {
inline namespace PIMG_ABI {

void BinaryWriter::bit(AdaptiveBit& model, bool value)
{
    const std::uint32_t bound = (m_range >> 15) * model.zero;
    if (value) {
        m_low += bound;
        m_range -= bound;
    } else
        m_range = bound;
    model.learn(value);
    while (m_range < 1u << 24) {
        m_range <<= 8;
        shift_low();
    }
}

void BinaryWriter::direct(std::uint32_t value, int count)
{
    for (int k = count - 1; k >= 0; --k) {
        m_range >>= 1;
        if (value >> k & 1)
            m_low += m_range;
        while (m_range < 1u << 24) {
            m_range <<= 8;
            shift_low();
        }
    }
}

void BinaryWriter::shift_low()
{
    if (m_low < 0xff000000u || m_low >> 32 != 0) {
        const std::uint32_t carry = std::uint32_t(m_low >> 32);
        for (; m_pending > 0; --m_pending) {
            put_u8(m_out, m_cache + carry);
            m_cache = 0xff;
        }
        m_cache = std::uint32_t(m_low >> 24) & 255;
    }
    ++m_pending;
    m_low = (m_low & 0x00ffffffu) << 8;
}

Bytes BinaryWriter::finish()
{
    for (int k = 0; k < 5; ++k)
        shift_low();
    // The first byte is always 0. Past the end a reader sees zeros, so up to four zeros at the end need not be written.
    m_out.erase(m_out.begin());
    for (int k = 0; k < 4 && !m_out.empty() && m_out.back() == 0; ++k)
        m_out.pop_back();
    return std::move(m_out);
}

BinaryReader::BinaryReader(const std::uint8_t* data, std::size_t size) : m_data(data), m_size(size)
{
    for (int k = 0; k < 4; ++k)
        m_code = m_code << 8 | next();
}

std::uint32_t BinaryReader::direct(int count)
{
    std::uint32_t value = 0;
    for (int k = 0; k < count; ++k) {
        m_range >>= 1;
        const bool one = m_code >= m_range;
        if (one)
            m_code -= m_range;
        value = value << 1 | std::uint32_t(one);
        fill();
    }
    return value;
}

void NumberModel::write(BinaryWriter& out, std::uint32_t value)
{
    const int length = bit_length(value);
    std::uint32_t node = 1;
    for (int k = 5; k >= 0; --k) {
        const bool b = length >> k & 1;
        out.bit(m_length[node], b);
        node = node << 1 | std::uint32_t(b);
    }
    const int high = length > 2 ? 2 : length > 1 ? 1 : 0;
    node = 1;
    for (int k = 1; k <= high; ++k) {
        const bool b = value >> (length - 1 - k) & 1;
        out.bit(m_high[length][node], b);
        node = node << 1 | std::uint32_t(b);
    }
    if (length > 3)
        out.direct(value & ((1u << (length - 3)) - 1), length - 3);
}

std::uint32_t NumberModel::read(BinaryReader& in)
{
    std::uint32_t node = 1;
    for (int k = 0; k < 6; ++k)
        node = node << 1 | std::uint32_t(in.bit(m_length[node]));
    const int length = int(node & 63) < 32 ? int(node & 63) : 32;
    if (length == 0)
        return 0;
    const int high = length > 2 ? 2 : length > 1 ? 1 : 0;
    std::uint32_t value = 1;
    for (int k = 1; k <= high; ++k)
        value = value << 1 | std::uint32_t(in.bit(m_high[length][value]));
    if (length > 3)
        value = value << (length - 3) | in.direct(length - 3);
    return value;
}

}  // namespace PIMG_ABI
}  // namespace pimg
