// SPDX-License-Identifier: BSD-3-Clause
// The binary metadata of ISO 21496-1, annex C: whole numbers with the most significant byte first, fractions as numerator
// and denominator of 32 bits each.
#include <cmath>
#include <cstdint>

#include "big_endian.h"
#include "gain_metadata.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr unsigned kManyChannels = 0x80, kBaseColourSpace = 0x40, kCommonDenominator = 0x08, kBaseIsHdr = 0x04;

/// Fractions of a millionth: finer than any 8-bit map shows, and 32 stops fit.
constexpr std::uint32_t kDenominator = 1000000;

void append_fraction(std::string& bytes, double value)
{
    append_big_endian(bytes, std::uint32_t(std::int32_t(std::lround(value * kDenominator))), 4);
    append_big_endian(bytes, kDenominator, 4);
}

/// Reads numbers one after the other; behind the end everything is 0 and fine() false.
class Reader {
public:
    explicit Reader(std::string_view bytes) : m_bytes(bytes) { }

    std::uint32_t number(std::size_t size)
    {
        std::uint32_t result = 0;
        m_fine = m_fine && m_at + size <= m_bytes.size();
        for (std::size_t i = 0; m_fine && i < size; ++i)
            result = result << 8 | static_cast<unsigned char>(m_bytes[m_at++]);
        return result;
    }
    double fraction(bool is_signed)
    {
        const std::uint32_t numerator = number(4);
        const std::uint32_t denominator = m_common != 0 ? m_common : number(4);
        m_fine = m_fine && denominator != 0;
        return m_fine ? (is_signed ? double(std::int32_t(numerator)) : double(numerator)) / double(denominator) : 0.0;
    }
    void share_denominator(std::uint32_t denominator)
    {
        m_common = denominator;
        m_fine = m_fine && denominator != 0;
    }
    bool fine() const { return m_fine; }

private:
    std::string_view m_bytes;
    std::size_t m_at = 0;
    std::uint32_t m_common = 0;
    bool m_fine = true;
};

void read_channel(Reader& reader, GainChannel& channel)
{
    channel.min = reader.fraction(true);
    channel.max = reader.fraction(true);
    channel.gamma = reader.fraction(false);
    channel.base_offset = reader.fraction(true);
    channel.alternate_offset = reader.fraction(true);
}

}  // namespace

std::string iso_gain_version()
{
    std::string bytes;
    append_big_endian(bytes, 0, 2);  // the least version a reader must know
    append_big_endian(bytes, 0, 2);  // the version of the writer
    return bytes;
}

std::string iso_gain_metadata(const GainMetadata& metadata)
{
    std::string bytes = iso_gain_version();
    append_big_endian(
        bytes, (metadata.channels > 1 ? kManyChannels : 0) | (metadata.base_colour_space ? kBaseColourSpace : 0), 1);
    append_fraction(bytes, metadata.base_headroom);
    append_fraction(bytes, metadata.alternate_headroom);
    for (int c = 0; c < metadata.channels; ++c) {
        const GainChannel& channel = metadata.channel[std::size_t(c)];
        for (const double value :
             { channel.min, channel.max, channel.gamma, channel.base_offset, channel.alternate_offset })
            append_fraction(bytes, value);
    }
    return bytes;
}

bool parse_iso_gain_metadata(std::string_view bytes, GainMetadata& metadata, std::string& error)
{
    Reader reader(bytes);
    const std::uint32_t least_version = reader.number(2);
    reader.number(2);
    const std::uint32_t flags = reader.number(1);
    if (reader.fine() && least_version != 0) {
        error = "its gain map needs a newer reader of ISO 21496-1";
        return false;
    }
    if ((flags & kBaseIsHdr) != 0) {
        error = "its base is the HDR picture and its gain map leads to SDR, expected an SDR base";
        return false;
    }
    if ((flags & kCommonDenominator) != 0)
        reader.share_denominator(reader.number(4));
    metadata.channels = (flags & kManyChannels) != 0 ? 3 : 1;
    metadata.base_colour_space = (flags & kBaseColourSpace) != 0;
    metadata.base_headroom = reader.fraction(false);
    metadata.alternate_headroom = reader.fraction(false);
    for (int c = 0; c < metadata.channels; ++c)
        read_channel(reader, metadata.channel[std::size_t(c)]);
    if (!reader.fine()) {
        error = "the metadata of its gain map are cut off or have a denominator of 0";
        return false;
    }
    if (metadata.channels == 1)
        metadata.channel[1] = metadata.channel[2] = metadata.channel[0];
    return check_gain_metadata(metadata, error);
}

}  // namespace PIMG_ABI
}  // namespace pimg
