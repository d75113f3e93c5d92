// SPDX-License-Identifier: BSD-3-Clause
#include "session/colour.h"

#include <algorithm>
#include <cstdlib>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/colour.h>
#include <pimg/detail/format.h>
#include <pimg/detail/oiio_compat.h>

namespace pimgtool {

namespace {

namespace Strutil = OIIO::Strutil;

bool contains(const std::vector<std::string>& names, const std::string& name)
{
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& other) { return Strutil::iequals(name, other); });
}

bool has_configuration()
{
    const char* name = std::getenv("OCIO");
    return name != nullptr && *name != '\0';
}

}  // namespace

bool use_colour_config(const std::string& filename, std::string& error)
{
    if (!OIIO::Filesystem::is_regular(filename) && !Strutil::istarts_with(filename, "ocio://")) {
        error = pimg::format("cannot read \"{}\": no such file", filename);
        return false;
    }
    setenv("OCIO", filename.c_str(), 1);
    return pimg::check_colour_config(error);
}

bool set_context_variable(const std::string& assignment, std::string& error)
{
    const std::size_t equals = assignment.find('=');
    if (equals == 0 || equals == std::string::npos) {
        error = pimg::format("\"{}\": expected KEY=VALUE", assignment);
        return false;
    }
    setenv(assignment.substr(0, equals).c_str(), assignment.c_str() + equals + 1, 1);
    return true;
}

OIIO::ColorConfig& colour_config()
{
    static OIIO::ColorConfig config;
    config.geterror();  // OpenImageIO 2.4 reports an error if $OCIO is not set, although it goes on without
    return config;
}

pimg::Colour meaning_of(const OIIO::ImageSpec& stored)
{
    OIIO::ImageSpec rgb = stored;
    rgb.nchannels = 3;
    rgb.channelnames = { "R", "G", "B" };
    rgb.channelformats.clear();
    rgb.alpha_channel = rgb.z_channel = -1;
    pimg::Colour colour;
    std::string error;
    pimg::Colour::resolve(rgb, "", "", colour, error);
    return colour;
}

bool holds_linear_light(const OIIO::ImageSpec& stored)
{
    const pimg::Colour colour = meaning_of(stored);
    return stored.format.is_floating_point() && !colour.encoded();
}

std::string scene_linear_space()
{
    if (!has_configuration())
        return pimg::linear_rec709_without_config(colour_config());
    const char* name = colour_config().getColorSpaceNameByRole("scene_linear");
    return name != nullptr ? name : "linear";
}

std::string convertible_space(const pimg::Colour& colour)
{
    const std::string& name = colour.config_name();
    if (name == "sRGB" && !has_configuration())
        return pimg::srgb_without_config(colour_config());
    return name.empty() || (name == "linear" && !has_configuration()) ? scene_linear_space() : name;
}

std::string own_name_of_space(const std::string& name)
{
    pimg::Colour colour;
    std::string error;
    const OIIO::ImageSpec any(1, 1, 3, OIIO::TypeFloat);
    const bool has_name = pimg::Colour::resolve(any, name, "", colour, error) && !colour.config_name().empty();
    return has_name ? convertible_space(colour) : name;
}

bool is_known_space(const std::string& name, std::string& error)
{
    const std::vector<std::string> names = colour_config().getColorSpaceNames();
    if (contains(names, own_name_of_space(name)) || contains(colour_config().getRoles(), name))
        return true;
    error = pimg::format("no colour space \"{}\": expected one of {}", name, Strutil::join(names, ", "));
    return false;
}

OIIO::ColorProcessorHandle conversion(const std::string& from, const std::string& to, const ConversionOptions& options,
                                      std::string& error)
{
    OIIO::ColorProcessorHandle processor = colour_config().createColorProcessor(from, to, options.key, options.value);
    if (!processor)
        processor = colour_config().createColorProcessor(own_name_of_space(from), own_name_of_space(to), options.key,
                                                         options.value);
    if (!processor)
        error =
            pimg::format("no conversion from \"{}\" to \"{}\": expected colour spaces of {}: {}", from, to,
                         has_configuration() ? "the configuration $OCIO" : "OpenImageIO ($OCIO names no configuration)",
                         Strutil::join(colour_config().getColorSpaceNames(), ", "));
    colour_config().geterror();  // replaced by a better message
    return processor;
}

bool find_display(std::string& display, std::string& view, const std::string& from, std::string& error)
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
        error = pimg::format("no display \"{}\": expected one of {}", display, Strutil::join(displays, ", "));
        return false;
    }
    const std::vector<std::string> views = config.getViewNames(display);
    if (view == "default")
        view = pimg::default_view(config, display, from);
    if (contains(views, view))
        return true;
    error = pimg::format("no view \"{}\": expected one of {}", view, Strutil::join(views, ", "));
    return false;
}

OIIO::ColorProcessorHandle display_transform(const std::string& display, const std::string& view,
                                             const std::string& from, const DisplayOptions& options, std::string& error)
{
    OIIO::ColorConfig& config = colour_config();
    OIIO::ColorProcessorHandle processor =
        pimg::display_processor(config, { display, view, from, options.looks, options.key, options.value });
    if (processor)
        return processor;
    error = pimg::first_line(config.geterror());
    if (error.empty())  // OpenImageIO 2.4 and 3.1 may say nothing
        error = pimg::format("no transform from \"{}\" to the view \"{}\" of the display \"{}\"", from, view, display);
    return processor;
}

std::string display_space(const std::string& display, const std::string& view)
{
    const char* name = colour_config().getDisplayViewColorSpaceName(display, view);
    return name && *name != '<' ? name : "";  // not "<USE_DISPLAY_NAME>"
}

std::string space_of_file(const std::string& filename, const OIIO::ImageSpec& stored)
{
    const std::string declared = stored.get_string_attribute("oiio:ColorSpace");
    const bool is_usual = declared.empty() || Strutil::iequals(declared, "linear") || Strutil::iequals(declared, "sRGB")
        || Strutil::iequals(declared, "Rec709") || Strutil::istarts_with(declared, "lin_rec709")
        || Strutil::istarts_with(declared, "srgb_rec709");
    const bool says_more =
        stored.find_attribute("chromaticities") != nullptr || stored.find_attribute("ICCProfile") != nullptr;
    const std::string rule = is_usual && !says_more ? pimg::space_by_file_rule(filename) : "";
    return rule.empty() ? declared : rule;
}

}  // namespace pimgtool
