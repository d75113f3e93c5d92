// SPDX-License-Identifier: BSD-3-Clause
// Pictures of any kind as float, in memory of their own.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Copies a picture as float. OpenImageIO's own copy (2.4) misreads pictures in memory that have gaps between their
/// pixels.
bool copy_as_float(OIIO::ImageBuf& dst, const OIIO::ImageBuf& src);

}  // namespace PIMG_ABI
}  // namespace pimg
