// SPDX-License-Identifier: BSD-3-Clause
#include "state/look.h"

namespace pimgview {

bool operator==(const LookOptions& a, const LookOptions& b)
{
    return pimg::same_options(a, b);
}

}  // namespace pimgview

namespace pimg {

template<>
const std::vector<Option<pimgview::LookOptions>>& option_table<pimgview::LookOptions>()
{
    using T = pimgview::LookOptions;
    static const std::vector<Option<T>> table = {
        { &T::zoom, { "zoom", 0, 64, "", "", "screen pixels to a pixel of the picture; 0: all of it" } },
        { &T::x, { "x", 0, 1, "", "", "share of the picture's width that is in the middle" } },
        { &T::y, { "y", 0, 1, "", "", "share of the picture's height that is in the middle" } },
        { &T::show, { "show", 0, 0, "", "result|source|split|difference", "which picture is shown" } },
        { &T::split, { "split", 0, 1, "", "", "share of the view left of the split line, where the source is" } },
        { &T::boost, { "boost", 1, 64, "", "", "factor on differences, so that small ones are seen; grey is none" } },
        { &T::exposure, { "exposure", -16, 16, "stops", "", "brightness of what is shown" } },
        { &T::gamma, { "gamma", 0.2, 5, "", "", "above 1 lifts the shadows of what is shown" } },
        { &T::display, { "display", 0, 0, "", "", "a display of $OCIO; empty: sRGB, as pimgtool writes files" } },
        { &T::transform, { "transform", 0, 0, "", "", "a view of that display; empty: its first" } },
        { &T::clipped,
          { "clipped", 0, 0, "", "", "false colours: red above white, blue below black, magenta out of gamut" } },
        { &T::histogram, { "histogram", 0, 0, "", "", "luminance of source and result in stops" } },
        { &T::waveform, { "waveform", 0, 0, "", "", "codes of the result, column by column" } },
        { &T::mesh, { "mesh", 0, 2147483647, "vertices", "", "draws the mesh with that many vertices; 0: none" } },
        { &T::piece, { "piece", 0, 0, "", "", "shows the dual piece under the pointer and its splits" } },
        { &T::panels, { "panels", 0, 0, "", "", "shows the panels beside the picture" } },
        { &T::light, { "light", 0, 0, "", "", "dark letters on light panels" } },
    };
    return table;
}

}  // namespace pimg
