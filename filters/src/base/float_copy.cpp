// SPDX-License-Identifier: BSD-3-Clause
#include "base/float_copy.h"

namespace pimg {
inline namespace PIMG_ABI {

bool copy_as_float(OIIO::ImageBuf& dst, const OIIO::ImageBuf& src)
{
    const bool packed = src.pixel_stride() == OIIO::stride_t(src.spec().pixel_bytes());
    if (src.localpixels() == nullptr || packed)
        return dst.copy(src, OIIO::TypeDesc::FLOAT);
    OIIO::ImageSpec spec = src.spec();
    spec.set_format(OIIO::TypeDesc::FLOAT);
    dst.reset(spec);
    return src.get_pixels(src.roi(), OIIO::TypeDesc::FLOAT, dst.localpixels());
}

}  // namespace PIMG_ABI
}  // namespace pimg
