// SPDX-License-Identifier: BSD-3-Clause
// Whole numbers with the most significant byte first, as JPEG, TIFF's "MM" order and ISO 21496-1 have them.
#pragma once

#include <cstdint>
#include <string>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Appends the lowest `size` bytes of a number, 1 to 4.
inline void append_big_endian(std::string& bytes, std::uint32_t number, int size)
{
    for (int shift = 8 * (size - 1); shift >= 0; shift -= 8)
        bytes.push_back(char(number >> shift & 0xFF));
}

}  // namespace PIMG_ABI
}  // namespace pimg
