// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/stroke_file.h>

#include "number_text.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// The colour of one stroke.
std::array<float, 3> colour_of(const ShownColours& colours, std::size_t stroke)
{
    std::array<float, 3> colour {};
    for (std::size_t c = 0; c < 3 && !colours.empty(); ++c)
        colour[c] = colours[c < colours.size() ? c : 0][stroke];
    return colour;
}

}  // namespace

std::string strokes_to_svg(const Strokes& strokes, const ShownColours& colours, float opacity,
                           const std::string& ground)
{
    const std::string w = std::to_string(strokes.width), h = std::to_string(strokes.height);
    std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h
        + "\" viewBox=\"0 0 " + w + " " + h + "\">\n";
    if (!ground.empty())
        svg += "<rect width=\"" + w + "\" height=\"" + h + "\" fill=\"" + ground + "\"/>\n";
    svg += "<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\"";
    if (opacity < 1.0f) {
        svg += " stroke-opacity=\"";
        append_number(svg, opacity);
        svg += '"';
    }
    svg += ">\n";
    for (std::size_t i = 0; i < strokes.strokes.size(); ++i) {
        const Stroke& s = strokes.strokes[i];
        svg += "<path stroke=\"" + hexadecimal(colour_of(colours, i)) + "\" stroke-width=\"";
        append_number(svg, s.width);
        svg += "\" d=\"M";
        for (Index k = 0; k < s.count; ++k) {
            svg += k == 0 ? "" : k == 1 ? "L" : " ";
            append_number(svg, strokes.begin(s)[k].x + 0.5f);
            svg += ' ';
            append_number(svg, strokes.begin(s)[k].y + 0.5f);
        }
        svg += "\"/>\n";
    }
    return svg + "</g>\n</svg>\n";
}

std::string strokes_to_json(const Strokes& strokes, const ShownColours& colours, float opacity)
{
    std::string json = "{\"width\": " + std::to_string(strokes.width)
        + ", \"height\": " + std::to_string(strokes.height) + ", \"opacity\": ";
    append_number(json, opacity);
    json += ", \"strokes\": [";
    for (std::size_t i = 0; i < strokes.strokes.size(); ++i) {
        const Stroke& s = strokes.strokes[i];
        json += i ? ",\n{\"points\": [" : "\n{\"points\": [";
        for (Index k = 0; k < s.count; ++k) {
            json += k ? ", [" : "[";
            append_number(json, strokes.begin(s)[k].x);
            json += ", ";
            append_number(json, strokes.begin(s)[k].y);
            json += ']';
        }
        json += "], \"width\": ";
        append_number(json, s.width);
        json += ", \"color\": [";
        for (std::size_t c = 0; c < 3; ++c)
            json += (c ? ", " : "") + std::to_string(byte_of(colour_of(colours, i)[c]));
        json += "], \"level\": " + std::to_string(s.level)
            + ", \"vertex\": " + (s.vertex == kGhost ? "-1" : std::to_string(s.vertex)) + "}";
    }
    return json + "\n]}\n";
}

}  // namespace PIMG_ABI
}  // namespace pimg
