// SPDX-License-Identifier: BSD-3-Clause
// Colour spaces: the OpenColorIO configuration in use, and the sRGB encoding of whole-number files.
#pragma once

#include <string>

#include <OpenImageIO/color.h>
#include <pimg/colour.h>
#include <pimg/display.h>

namespace pimgtool {

/// Keys of --colorconvert and --tocolorspace.
struct ConversionOptions {
    std::string key, value;  ///< of the context
    bool unpremult = false;
};

/// Keys of --ociodisplay.
struct DisplayOptions : ConversionOptions {
    std::string from, looks;
};

/// Makes $OCIO name that file, and reads it. Before the first use of the configuration.
bool use_colour_config(const std::string& filename, std::string& error);

/// "KEY=VALUE": sets a variable of the environment, which is where contexts take theirs from.
bool set_context_variable(const std::string& assignment, std::string& error);

/// The configuration $OCIO names, else OpenImageIO's own few spaces.
OIIO::ColorConfig& colour_config();

/// What samples with such metadata are taken as, whichever channels are the picture.
pimg::Colour meaning_of(const OIIO::ImageSpec& stored);

/// Whether a picture with such metadata holds linear light as floating-point numbers, to be encoded for files of
/// whole numbers.
bool holds_linear_light(const OIIO::ImageSpec& stored);

/// The name that conversions know a picture's space by. Where there is none, its colours are to be converted to
/// scene-linear first: see Colour::to_scene_linear().
std::string convertible_space(const pimg::Colour& colour);
std::string scene_linear_space();

/// What conversions call a space that the user calls by an alias of the configuration, or as another version of OpenImageIO
/// does. The name itself if they know no other.
std::string own_name_of_space(const std::string& name);

/// False, with a line saying what there is, for names of spaces the configuration has not.
bool is_known_space(const std::string& name, std::string& error);

/// The conversion between two spaces; null, with a line saying what there is, if the configuration has none.
OIIO::ColorProcessorHandle conversion(const std::string& from, const std::string& to, const ConversionOptions& options,
                                      std::string& error);

/// Puts the configuration's names in place of "default", for a picture in the space `from`. False, with a line saying what
/// there is, for names it has not.
bool find_display(std::string& display, std::string& view, const std::string& from, std::string& error);

/// The transform for a display found so; null, with a line saying why, if there is none.
OIIO::ColorProcessorHandle display_transform(const std::string& display, const std::string& view,
                                             const std::string& from, const DisplayOptions& options,
                                             std::string& error);

/// The name of the space that transform leads to; empty if the configuration does not say.
std::string display_space(const std::string& display, const std::string& view);

/// The space of a file, for oiio:ColorSpace. A rule of the configuration decides, unless the metadata holds
/// chromaticities, an ICC profile, or the name of another space than files of the format usually have; then the
/// metadata decides.
std::string space_of_file(const std::string& filename, const OIIO::ImageSpec& stored);

using pimg::declare_space;
using pimg::srgb_encoded;

}  // namespace pimgtool
