// SPDX-License-Identifier: BSD-3-Clause
// From linear light to what displays and 8-bit files hold.
#pragma once

#include <cstddef>
#include <string>

#include <OpenImageIO/imagebuf.h>

namespace pimg {

/// A linear picture for displays, as float: its colours converted to Rec. 709 from the primaries its metadata say, see
/// Colour::resolve(), and encoded sRGB. Alpha and other channels stay as they are. On failure the result has an error.
OIIO::ImageBuf srgb_encoded(const OIIO::ImageBuf& src, int nthreads = 0);

/// Applies the sRGB curve to `count` numbers in place. Below 0 it is a straight line; above 1 the curve goes on.
void srgb_in_place(float* values, std::size_t count);

/// Makes metadata say which space the pixels are in now, "" for none that has a name.
void declare_space(OIIO::ImageSpec& spec, const std::string& space);

}  // namespace pimg
