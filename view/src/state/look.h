// SPDX-License-Identifier: BSD-3-Clause
// How a picture is looked at; nothing here changes the result. There is a table like those of the filters, from which
// the panel, --view and the help are made.
#pragma once

#include <string>

#include <pimg/options.h>

namespace pimgview {

struct LookOptions {
    float zoom = 0.0f;               ///< screen pixels to a pixel of the picture; 0: the whole picture
    float x = 0.5f, y = 0.5f;        ///< the place in the middle of the view, as shares of width and height
    std::string show = "result";     ///< result, source, split or difference
    float split = 0.5f;              ///< where the line between source and result is, as a share of the view's width
    float boost = 1.0f;              ///< factor on differences, which are shown around grey
    float exposure = 0.0f;           ///< in stops
    float gamma = 1.0f;              ///< exponent 1 / gamma on what is displayed
    std::string display, transform;  ///< of the configuration $OCIO; empty: sRGB, as pimgtool writes files
    bool clipped = false;            ///< false colours
    bool histogram = false, waveform = false;
    int mesh = 0;        ///< vertices of the mesh that is drawn; 0: none
    bool piece = false;  ///< the dual piece under the pointer
    bool panels = true;
    bool light = false;  ///< dark letters on light panels
};

bool operator==(const LookOptions& a, const LookOptions& b);

}  // namespace pimgview

namespace pimg {

template<>
const std::vector<Option<pimgview::LookOptions>>& option_table<pimgview::LookOptions>();

}  // namespace pimg
