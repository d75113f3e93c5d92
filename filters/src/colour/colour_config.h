// SPDX-License-Identifier: BSD-3-Clause
// The OpenColorIO configuration that colour spaces are looked up in.
#pragma once

#include <string>

#include <OpenColorIO/OpenColorIO.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// That of the ColourConfigScope on this thread, else that of $OCIO; null without either. Configurations are read once.
/// Throws what OpenColorIO throws if it cannot be read.
OCIO_NAMESPACE::ConstConfigRcPtr current_colour_config();

/// Its name, that of a file or "ocio://..." for one that comes with OpenColorIO; empty if there is none.
std::string name_of_colour_config();

/// Who named it, for messages: "$OCIO", or the name itself.
std::string source_of_colour_config();

}  // namespace PIMG_ABI
}  // namespace pimg
