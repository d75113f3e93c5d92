// SPDX-License-Identifier: BSD-3-Clause
// The OpenColorIO configuration of a host that has one for each project.
#pragma once

#include <string>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// While it lives, Colour::resolve() and check_colour_config() on this thread use this configuration in place of that of
/// $OCIO. It is a file or, where OpenColorIO knows them, a built-in one such as ocio://default; empty: that of $OCIO.
class PIMG_EXPORT_DETAIL ColourConfigScope {
public:
    explicit ColourConfigScope(std::string config);
    ColourConfigScope(const ColourConfigScope&) = delete;
    ColourConfigScope& operator=(const ColourConfigScope&) = delete;
    ~ColourConfigScope();

private:
    std::string m_before;
};

}  // namespace PIMG_ABI
}  // namespace pimg
