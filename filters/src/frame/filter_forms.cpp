// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/filter_forms.h>

#include <pimg/detail/format.h>

namespace pimg {
inline namespace PIMG_ABI {

void ImageBufAlgo::set_failed(OIIO::ImageBuf& result, const char* name)
{
    set_error(result, format("{} error", name));
}

bool ImageBufAlgo::build_source(OIIO::ImageBuf& dst, const OIIO::ImageBuf& src, int nthreads,
                                ProgressiveImage& progressive)
{
    if (progressive.build(src, {}, nthreads))
        return true;
    set_error(dst, progressive.error());
    return false;
}

}  // namespace PIMG_ABI
}  // namespace pimg
