// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/display.h>

#include <algorithm>

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagebufalgo_util.h>

namespace pimg {

using OIIO::ImageBuf;
using OIIO::ROI;

ImageBuf srgb_encoded(const ImageBuf& src, int nthreads)
{
    ImageBuf dst = OIIO::ImageBufAlgo::copy(src, OIIO::TypeFloat, {}, nthreads);
    const int alpha = dst.spec().alpha_channel;
    const int depth = dst.spec().z_channel;
    const int colours = std::min(dst.nchannels(), 3);  // OpenImageIO's rule for colour operations
    OIIO::ImageBufAlgo::parallel_image(dst.roi(), nthreads, [&](ROI roi) {
        for (ImageBuf::Iterator<float> p(dst, roi); !p.done(); ++p) {
            // Colours are stored multiplied by alpha; the curve belongs on the colours themselves.
            const float a = alpha >= 0 ? float(p[alpha]) : 1.0f;
            const float scale = a > 0.0f ? a : 1.0f;
            for (int c = 0; c < colours; ++c)
                if (c != alpha && c != depth)
                    p[c] = scale * OIIO::linear_to_sRGB(p[c] / scale);
        }
    });
    declare_space(dst.specmod(), "sRGB");
    return dst;
}

void declare_space(OIIO::ImageSpec& spec, const std::string& space)
{
    for (const char* stale : { "oiio:Gamma", "Exif:ColorSpace", "ICCProfile", "tiff:ColorSpace", "chromaticities" })
        spec.erase_attribute(stale);
    if (space.empty())
        spec.erase_attribute("oiio:ColorSpace");
    else
        spec.attribute("oiio:ColorSpace", space);
}

}  // namespace pimg
