// SPDX-License-Identifier: BSD-3-Clause
// The six symbols OpenImageIO looks for in pimg.imageio.so. Nothing may happen here but creation: OpenImageIO calls the
// creators while it makes its list of formats.
#include <pimg/version.h>

#include "pimg_pvt.h"

OIIO_PLUGIN_EXPORTS_BEGIN

OIIO_EXPORT int pimg_imageio_version = OIIO_PLUGIN_VERSION;
OIIO_EXPORT const char* pimg_imageio_library_version()
{
    return "pimg " PIMG_VERSION_STRING;
}

OIIO_EXPORT OIIO::ImageInput* pimg_input_imageio_create()
{
    return pimg::io::make_input().release();
}
OIIO_EXPORT const char* pimg_input_extensions[] = { "pimg", nullptr };

OIIO_EXPORT OIIO::ImageOutput* pimg_output_imageio_create()
{
    return pimg::io::make_output(nullptr).release();
}
OIIO_EXPORT const char* pimg_output_extensions[] = { "pimg", nullptr };

OIIO_PLUGIN_EXPORTS_END
