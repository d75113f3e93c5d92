// SPDX-License-Identifier: BSD-3-Clause
// Colour spaces: the OpenColorIO configuration in use, and the sRGB encoding of whole-number files.
#pragma once

#include <string>

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebuf.h>

namespace pimgtool {

/// The configuration $OCIO names, else OpenImageIO's own few spaces.
OIIO::ColorConfig& colour_config();

/// True for names of linear-light spaces, whatever the configuration.
bool is_linear_space(const std::string& name);

/// The name the configuration has for a picture's space. Files say "Linear" without knowing the configuration: where
/// it has no such name, its scene-linear role is meant.
std::string configured_space(const std::string& name);

/// The conversion between two spaces; null, with a line saying what there is, if the configuration has none.
OIIO::ColorProcessorHandle conversion(const std::string& from, const std::string& to, std::string& error);

/// Puts the configuration's names in place of "default". False, with a line saying what there is, for names it has not.
bool find_display(std::string& display, std::string& view, std::string& error);

/// The transform for a display found so; null, with a line saying why, if there is none.
OIIO::ColorProcessorHandle display_transform(const std::string& display, const std::string& view,
                                             const std::string& from, std::string& error);

/// The name of the space that transform leads to; empty if the configuration does not say.
std::string display_space(const std::string& display, const std::string& view);

/// The colour channels of a linear picture with the sRGB curve on them; alpha and other channels as they are.
OIIO::ImageBuf srgb_encoded(const OIIO::ImageBuf& src);

/// Makes metadata say which space the pixels are in now, "" for none that has a name.
void declare_space(OIIO::ImageSpec& spec, const std::string& space);

}  // namespace pimgtool
