// SPDX-License-Identifier: BSD-3-Clause
// Encodes linear light for displays and 8-bit files.
#pragma once

#include <cstddef>
#include <string>

#include <OpenImageIO/imagebuf.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Encodes a linear picture in sRGB. Its colours, those of `layer` (Colour::count()), are first converted to Rec. 709 from
/// the primaries that its metadata name (Colour::resolve()), or to Display P3, with its ICC profile, if it was made for a
/// display of that gamut (declare_gamut()). The result is float; alpha and other channels are copied.
/// nthreads: 0 = OpenImageIO's "threads" attribute. On failure the result has an error.
PIMG_EXPORT OIIO::ImageBuf srgb_encoded(const OIIO::ImageBuf& src, int nthreads = 0, const std::string& layer = {});

/// Applies the sRGB curve to `count` numbers in place. Below 0 the curve is a straight line, and above 1 it continues.
PIMG_EXPORT void srgb_in_place(float* values, std::size_t count);

/// Linear light of a number that the sRGB curve encodes: the inverse of srgb_in_place().
PIMG_EXPORT double srgb_decoded(double encoded);

/// Says for displays of which gamut a picture is made: rec709 or p3; "" for a picture that is not made for displays.
PIMG_EXPORT void declare_gamut(OIIO::ImageSpec& spec, const std::string& gamut);

/// Sets the metadata that name the colour space of the pixels. "" stands for a space without a name.
PIMG_EXPORT void declare_space(OIIO::ImageSpec& spec, const std::string& space);

}  // namespace PIMG_ABI
}  // namespace pimg
