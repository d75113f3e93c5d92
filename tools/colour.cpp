// SPDX-License-Identifier: BSD-3-Clause
#include "colour.h"

#include <algorithm>

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagebufalgo_util.h>
#include <OpenImageIO/strutil.h>

namespace pimgtool {

namespace {

using OIIO::ImageBuf;
using OIIO::ROI;
namespace Strutil = OIIO::Strutil;

bool contains(const std::vector<std::string>& names, const std::string& name)
{
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& other) { return Strutil::iequals(name, other); });
}

}  // namespace

OIIO::ColorConfig& colour_config()
{
    static OIIO::ColorConfig config;
    config.geterror();  // OpenImageIO 2.4 complains of there being no $OCIO, and falls back
    return config;
}

bool is_linear_space(const std::string& name)
{
    return Strutil::iequals(name, "linear") || Strutil::iequals(name, "scene_linear")
        || Strutil::istarts_with(name, "lin_") || colour_config().isColorSpaceLinear(name);
}

std::string configured_space(const std::string& name)
{
    const OIIO::ColorConfig& config = colour_config();
    const bool known = contains(config.getColorSpaceNames(), name) || contains(config.getRoles(), name);
    if (!known && is_linear_space(name) && config.getColorSpaceNameByRole("scene_linear"))
        return "scene_linear";
    return name;
}

OIIO::ColorProcessorHandle conversion(const std::string& from, const std::string& to, std::string& error)
{
    OIIO::ColorProcessorHandle processor = colour_config().createColorProcessor(from, to);
    if (!processor)
        error = Strutil::fmt::format("no conversion from \"{}\" to \"{}\": expected colour spaces of {}: {}", from, to,
                                     colour_config().getNumDisplays() ? "the configuration $OCIO"
                                                                      : "OpenImageIO ($OCIO names no configuration)",
                                     Strutil::join(colour_config().getColorSpaceNames(), ", "));
    colour_config().geterror();  // said better
    return processor;
}

bool find_display(std::string& display, std::string& view, std::string& error)
{
    const OIIO::ColorConfig& config = colour_config();
    const std::vector<std::string> displays = config.getDisplayNames();
    if (displays.empty()) {
        error = "no displays: expected $OCIO to name an OpenColorIO configuration";
        return false;
    }
    if (display == "default")
        display = config.getDefaultDisplayName();
    if (!contains(displays, display)) {
        error = Strutil::fmt::format("no display \"{}\": expected one of {}", display, Strutil::join(displays, ", "));
        return false;
    }
    const std::vector<std::string> views = config.getViewNames(display);
    if (view == "default")
        view = config.getDefaultViewName(display);
    if (contains(views, view))
        return true;
    error = Strutil::fmt::format("no view \"{}\": expected one of {}", view, Strutil::join(views, ", "));
    return false;
}

OIIO::ColorProcessorHandle display_transform(const std::string& display, const std::string& view,
                                             const std::string& from, std::string& error)
{
    OIIO::ColorProcessorHandle processor = colour_config().createDisplayTransform(display, view, from);
    if (!processor)
        error = colour_config().geterror();
    return processor;
}

std::string display_space(const std::string& display, const std::string& view)
{
    const char* name = colour_config().getDisplayViewColorSpaceName(display, view);
    return name && *name != '<' ? name : "";  // not "<USE_DISPLAY_NAME>"
}

ImageBuf srgb_encoded(const ImageBuf& src)
{
    ImageBuf dst = OIIO::ImageBufAlgo::copy(src, OIIO::TypeFloat);
    const int alpha = dst.spec().alpha_channel;
    const int depth = dst.spec().z_channel;
    const int colours = std::min(dst.nchannels(), 3);  // OpenImageIO's rule for colour operations
    OIIO::ImageBufAlgo::parallel_image(dst.roi(), 0, [&](ROI roi) {
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

}  // namespace pimgtool
