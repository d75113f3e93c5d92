// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/stroke_file.h>

#include <charconv>
#include <cmath>

namespace pimg {

namespace {

/// With two decimals and a point, whatever the locale.
void add(std::string& text, float value)
{
    char buffer[32];
    const long hundredths = std::lround(double(value) * 100.0);
    const auto end =
        std::to_chars(buffer, buffer + sizeof(buffer), hundredths / 100 == 0 && hundredths < 0 ? 0L : hundredths / 100)
            .ptr;
    if (hundredths < 0 && hundredths / 100 == 0)
        text += '-';
    text.append(buffer, end);
    const long rest = std::labs(hundredths % 100);
    if (rest == 0)
        return;
    text += '.';
    text += char('0' + rest / 10);
    if (rest % 10)
        text += char('0' + rest % 10);
}

int byte_of(const ShownColours& colours, std::size_t channel, std::size_t stroke)
{
    if (colours.empty())
        return 0;
    const float v = colours[channel < colours.size() ? channel : 0][stroke];
    return v > 0.0f ? int(std::lround(255.0f * (v < 1.0f ? v : 1.0f))) : 0;
}

std::string hexadecimal(const ShownColours& colours, std::size_t stroke)
{
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string text = "#";
    for (std::size_t c = 0; c < 3; ++c) {
        const int v = byte_of(colours, c, stroke);
        text += kDigits[v >> 4];
        text += kDigits[v & 15];
    }
    return text;
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
        add(svg, opacity);
        svg += '"';
    }
    svg += ">\n";
    for (std::size_t i = 0; i < strokes.strokes.size(); ++i) {
        const Stroke& s = strokes.strokes[i];
        svg += "<path stroke=\"" + hexadecimal(colours, i) + "\" stroke-width=\"";
        add(svg, s.width);
        svg += "\" d=\"M";
        for (Index k = 0; k < s.count; ++k) {
            svg += k == 0 ? "" : k == 1 ? "L" : " ";
            add(svg, strokes.begin(s)[k].x + 0.5f);
            svg += ' ';
            add(svg, strokes.begin(s)[k].y + 0.5f);
        }
        svg += "\"/>\n";
    }
    return svg + "</g>\n</svg>\n";
}

std::string strokes_to_json(const Strokes& strokes, const ShownColours& colours, float opacity)
{
    std::string json = "{\"width\": " + std::to_string(strokes.width)
        + ", \"height\": " + std::to_string(strokes.height) + ", \"opacity\": ";
    add(json, opacity);
    json += ", \"strokes\": [";
    for (std::size_t i = 0; i < strokes.strokes.size(); ++i) {
        const Stroke& s = strokes.strokes[i];
        json += i ? ",\n{\"points\": [" : "\n{\"points\": [";
        for (Index k = 0; k < s.count; ++k) {
            json += k ? ", [" : "[";
            add(json, strokes.begin(s)[k].x);
            json += ", ";
            add(json, strokes.begin(s)[k].y);
            json += ']';
        }
        json += "], \"width\": ";
        add(json, s.width);
        json += ", \"color\": [";
        for (std::size_t c = 0; c < 3; ++c)
            json += (c ? ", " : "") + std::to_string(byte_of(colours, c, i));
        json += "], \"level\": " + std::to_string(s.level)
            + ", \"vertex\": " + (s.vertex == kGhost ? "-1" : std::to_string(s.vertex)) + "}";
    }
    return json + "\n]}\n";
}

}  // namespace pimg
