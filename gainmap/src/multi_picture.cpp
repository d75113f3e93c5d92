// SPDX-License-Identifier: BSD-3-Clause
#include "multi_picture.h"

#include "big_endian.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// TIFF 6.0: types of entries. CIPA DC-007, table 3: tags.
constexpr std::uint16_t kLong = 4, kUndefined = 7;
constexpr std::uint16_t kVersionTag = 0xB000, kCountTag = 0xB001, kEntriesTag = 0xB002;
constexpr std::uint32_t kPrimaryPicture = 0x030000;  ///< "Baseline MP Primary Image"
constexpr std::size_t kEntrySize = 16, kHeaderSize = 8, kTagSize = 12;
constexpr std::uint32_t kMostPictures = 64;  ///< entries of an index at most: a file with more is no gain-map file

void append_tag(std::string& bytes, std::uint16_t tag, std::uint16_t type, std::uint32_t count)
{
    append_big_endian(bytes, tag, 2);
    append_big_endian(bytes, type, 2);
    append_big_endian(bytes, count, 4);
}

void append_entry(std::string& bytes, std::uint32_t attributes, const IndexedPicture& picture)
{
    append_big_endian(bytes, attributes, 4);
    append_big_endian(bytes, picture.size, 4);
    append_big_endian(bytes, picture.offset, 4);
    append_big_endian(bytes, 0, 4);  // no dependent pictures
}

/// Numbers of a TIFF structure in either order of bytes; 0 behind the end.
class Tiff {
public:
    explicit Tiff(std::string_view bytes) : m_bytes(bytes), m_little(bytes.substr(0, 2) == "II") { }

    bool is_tiff() const { return (m_little || m_bytes.substr(0, 2) == "MM") && number(2, 2) == 42; }
    std::uint32_t number(std::size_t at, std::size_t size) const
    {
        std::uint32_t result = 0;
        if (at > m_bytes.size() || m_bytes.size() - at < size)
            return 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t place = m_little ? at + size - 1 - i : at + i;
            result = result << 8 | static_cast<unsigned char>(m_bytes[place]);
        }
        return result;
    }

private:
    std::string_view m_bytes;
    bool m_little;
};

}  // namespace

std::string multi_picture_index(std::uint32_t first_size, const IndexedPicture& second)
{
    constexpr std::uint32_t kTags = 3;
    constexpr std::uint32_t kEntriesAt = kHeaderSize + 2 + kTags * kTagSize + 4;
    static_assert(kIndexSize == kEntriesAt + 2 * kEntrySize, "the index has one size");
    std::string bytes("MM\0*", 4);
    append_big_endian(bytes, kHeaderSize, 4);
    append_big_endian(bytes, kTags, 2);
    append_tag(bytes, kVersionTag, kUndefined, 4);
    bytes += "0100";
    append_tag(bytes, kCountTag, kLong, 1);
    append_big_endian(bytes, 2, 4);
    append_tag(bytes, kEntriesTag, kUndefined, 2 * kEntrySize);
    append_big_endian(bytes, kEntriesAt, 4);
    append_big_endian(bytes, 0, 4);  // no further directory
    append_entry(bytes, kPrimaryPicture, { 0, first_size });
    append_entry(bytes, 0, second);
    return bytes;
}

std::vector<IndexedPicture> parse_multi_picture_index(std::string_view bytes)
{
    const Tiff tiff(bytes);
    if (!tiff.is_tiff())
        return {};
    const std::size_t directory = tiff.number(4, 4);
    const std::uint32_t tags = tiff.number(directory, 2);
    std::vector<IndexedPicture> pictures;
    for (std::size_t t = 0; t < tags && directory + 2 + t * kTagSize < bytes.size(); ++t) {
        const std::size_t tag = directory + 2 + t * kTagSize;
        if (tiff.number(tag, 2) != kEntriesTag)
            continue;
        const std::uint32_t count = tiff.number(tag + 4, 4) / kEntrySize;
        const std::size_t entries = tiff.number(tag + 8, 4);
        for (std::size_t i = 0; i < count && i < kMostPictures; ++i)
            pictures.push_back(
                { tiff.number(entries + i * kEntrySize + 8, 4), tiff.number(entries + i * kEntrySize + 4, 4) });
    }
    return pictures;
}

}  // namespace PIMG_ABI
}  // namespace pimg
