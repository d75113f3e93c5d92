// SPDX-License-Identifier: BSD-3-Clause
#include "source/wrap/wrap.h"

#include <algorithm>

#include <OpenImageIO/strutil.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Width of a margin as a share of the side: what is wider than this seldom reaches across a seam. More takes longer.
constexpr int kMarginsToASide = 8;
constexpr int kLeastMargin = 32;  ///< pixels; the coarsest features of small pictures

int margin_of(int size)
{
    return std::min(std::max(size / kMarginsToASide, kLeastMargin), size / 2);
}

bool is_word(const OIIO::ImageSpec& spec, const char* name, const char* word)
{
    return OIIO::Strutil::iequals(spec.get_string_attribute(name), word);
}

/// Whether the file says that it is only a part of a panorama.
bool is_part_of_panorama(const OIIO::ImageSpec& spec)
{
    const int full = spec.get_int_attribute("GPano:FullPanoWidthPixels");
    const int part = spec.get_int_attribute("GPano:CroppedAreaImageWidthPixels");
    return part > 0 && part < full;
}

}  // namespace

Fade fade_at(int at, int size, int margin)
{
    const auto share = [&](int beyond) {  // of the end whose side is `beyond` pixels away
        return (float(margin - beyond) - 0.5f) / float(2 * margin);
    };
    if (at < margin)
        return { at + size, share(at) };
    if (at >= size - margin)
        return { at - size, share(size - 1 - at) };
    return {};
}

bool is_lat_long(const OIIO::ImageSpec& spec)
{
    // OpenImageIO's name for the attribute `envmap` of OpenEXR; and what programs for panoramas write as XMP.
    return is_word(spec, "textureformat", "LatLong Environment")
        || (is_word(spec, "GPano:ProjectionType", "equirectangular") && !is_part_of_panorama(spec));
}

bool find_wrap(const OIIO::ImageSpec& spec, const std::string& asked, Wrap& wrap, std::string& error)
{
    wrap = {};
    wrap.width = spec.width;
    wrap.height = spec.height;
    const bool fills_x = spec.x == spec.full_x && spec.width == spec.full_width;
    const bool fills_y = spec.y == spec.full_y && spec.height == spec.full_height;
    wrap.x = asked == "x" || asked == "xy" || (asked.empty() && fills_x && is_lat_long(spec));
    wrap.y = asked == "xy";
    if ((wrap.x && !fills_x) || (wrap.y && !fills_y)) {
        error = "wrap=" + asked + ": expected a picture that fills its display window";
        return false;
    }
    if (spec.width > 1 && spec.height > 1) {
        wrap.margin_x = wrap.x ? margin_of(spec.width) : 0;
        wrap.margin_y = wrap.y ? margin_of(spec.height) : 0;
    }
    return true;
}

const char* name_of(const Wrap& wrap)
{
    return wrap.x ? (wrap.y ? "xy" : "x") : (wrap.y ? "y" : "none");
}

OIIO::ImageBuf padded(const OIIO::ImageBuf& picture, const Wrap& wrap)
{
    OIIO::ImageSpec spec = picture.spec();
    spec.x -= wrap.margin_x;
    spec.y -= wrap.margin_y;
    spec.width = wrap.padded_width();
    spec.height = wrap.padded_height();
    OIIO::ImageBuf all(spec);
    const std::size_t channels = std::size_t(spec.nchannels);
    const float* from = static_cast<const float*>(picture.localpixels());
    float* to = static_cast<float*>(all.localpixels());
    for (int y = -wrap.margin_y; y < wrap.height + wrap.margin_y; ++y)
        for (int x = -wrap.margin_x; x < wrap.width + wrap.margin_x; ++x, to += channels) {
            const std::size_t pixel = std::size_t(modulo(y, wrap.height)) * std::size_t(wrap.width);
            std::copy_n(from + (pixel + std::size_t(modulo(x, wrap.width))) * channels, channels, to);
        }
    return all;
}

}  // namespace PIMG_ABI
}  // namespace pimg
