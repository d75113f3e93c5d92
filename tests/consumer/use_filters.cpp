// SPDX-License-Identifier: BSD-3-Clause
// A filter on an ImageBuf, as in the README.
#include <pimg/imagebufalgo.h>
#include <pimg/version.h>

#include <cstdio>

#include <OpenImageIO/imagebufalgo.h>

int main()
{
    OIIO::ImageBuf src(OIIO::ImageSpec(32, 24, 3, OIIO::TypeDesc::FLOAT));
    OIIO::ImageBufAlgo::checker(src, 8, 8, 1, { 0.01f, 0.01f, 0.01f }, { 900.0f, 700.0f, 500.0f });

    pimg::HdrCompressOptions options;
    options.s0 = 0.1f;
    const OIIO::ImageBuf dst = pimg::ImageBufAlgo::hdr_compress(src, options);
    if (dst.has_error()) {
        std::fprintf(stderr, "%s\n", dst.geterror().c_str());
        return 1;
    }
    std::puts(PIMG_VERSION_STRING);
    return dst.spec().width == 32 && dst.nchannels() == 3 ? 0 : 1;
}
