// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/display.h>

#include <algorithm>
#include <vector>

#include <pimg/detail/format.h>
#include <pimg/detail/parallel.h>
#include <pimg/threads.h>

#include "base/float_copy.h"

namespace pimg {

using OIIO::ImageBuf;

namespace {

/// A row of pixels. Colours are stored multiplied by alpha; the curve belongs on the colours themselves.
void encode_row(const OIIO::ImageSpec& spec, float* row)
{
    const int colours = std::min(spec.nchannels, 3);  // OpenImageIO's rule for colour operations
    if (spec.nchannels == colours && spec.alpha_channel < 0 && spec.z_channel < 0) {
        srgb_in_place(row, std::size_t(spec.width) * std::size_t(colours));
        return;
    }
    std::vector<float> values(std::size_t(spec.width));
    const auto scale = [&](int x) {
        const float a = spec.alpha_channel >= 0 ? row[x * spec.nchannels + spec.alpha_channel] : 1.0f;
        return a > 0.0f ? a : 1.0f;
    };
    for (int c = 0; c < colours; ++c) {
        if (c == spec.alpha_channel || c == spec.z_channel)
            continue;
        for (int x = 0; x < spec.width; ++x)
            values[std::size_t(x)] = row[x * spec.nchannels + c] / scale(x);
        srgb_in_place(values.data(), values.size());
        for (int x = 0; x < spec.width; ++x)
            row[x * spec.nchannels + c] = values[std::size_t(x)] * scale(x);
    }
}

}  // namespace

ImageBuf srgb_encoded(const ImageBuf& src, int nthreads)
{
    ImageBuf dst;
    const bool copied = copy_as_float(dst, src);
    if (!copied && !dst.has_error())
        set_error(dst, src.has_error() ? src.geterror(false) : "the picture has no pixels");
    const OIIO::ImageSpec& spec = dst.spec();
    if (copied && dst.localpixels() != nullptr)
        for_rows(pool_loop(nthreads), 0, spec.height * std::max(spec.depth, 1), [&](int row) {
            encode_row(spec,
                       static_cast<float*>(dst.localpixels())
                           + std::size_t(row) * std::size_t(spec.width) * std::size_t(spec.nchannels));
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
