// SPDX-License-Identifier: BSD-3-Clause
// Pictures of any kind as float, in memory of their own.
#pragma once

#include <OpenImageIO/imagebuf.h>

namespace pimg {

/// Copies a picture as float. OpenImageIO 2.4's own copy takes pixels that have gaps between them as if they had none.
bool copy_as_float(OIIO::ImageBuf& dst, const OIIO::ImageBuf& src);

}  // namespace pimg
