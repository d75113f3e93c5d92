// SPDX-License-Identifier: BSD-3-Clause
// From linear light to what displays and 8-bit files hold.
#pragma once

#include <cstddef>
#include <string>

#include <OpenImageIO/imagebuf.h>

namespace pimg {

/// The colour channels of a linear picture with the sRGB curve on them, as float; alpha and other channels as they are.
OIIO::ImageBuf srgb_encoded(const OIIO::ImageBuf& src, int nthreads = 0);

/// The sRGB curve on `count` numbers in place; straight on below 0 and above 1.
void srgb_in_place(float* values, std::size_t count);

/// Makes metadata say which space the pixels are in now, "" for none that has a name.
void declare_space(OIIO::ImageSpec& spec, const std::string& space);

}  // namespace pimg
