// SPDX-License-Identifier: BSD-3-Clause
// The index of a Multi-Picture Format file (CIPA DC-007): an APP2 segment of the first picture, which says where the
// others are. Offsets count from the TIFF header inside the segment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What the payload of the segment begins with, before the TIFF header.
constexpr std::string_view kMultiPictureName { "MPF\0", 4 };

/// A picture of the index: bytes from the TIFF header, and how many. The first picture has offset 0.
struct IndexedPicture {
    std::uint32_t offset = 0, size = 0;
};

/// The index of two pictures from its TIFF header on, always kIndexSize bytes.
std::string multi_picture_index(std::uint32_t first_size, const IndexedPicture& second);
constexpr std::size_t kIndexSize = 82;

/// Empty if the bytes are no such index.
std::vector<IndexedPicture> parse_multi_picture_index(std::string_view bytes);

}  // namespace PIMG_ABI
}  // namespace pimg
