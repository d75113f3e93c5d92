// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/drawing_file.h>

#include <algorithm>
#include <cmath>

#include "number_text.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kDecimals = 3;  ///< a thousandth of a millimetre

/// From pixels to millimetres on the paper.
struct Placing {
    double scale, left, top;

    double x(float pixels) const { return left + scale * (double(pixels) + 0.5); }
    double y(float pixels) const { return top + scale * (double(pixels) + 0.5); }
};

void append_place(std::string& svg, double x, double y)
{
    append_number(svg, x, kDecimals);
    svg += ' ';
    append_number(svg, y, kDecimals);
}

/// Unit vector to the left of a line at its k-th point.
Vec2 normal_at(const InkPoint* p, Index k, Index count)
{
    const InkPoint &a = p[k > 0 ? k - 1 : 0], &b = p[k + 1 < count ? k + 1 : count - 1];
    const float dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
    return length > 0.0f ? Vec2 { dy / length, -dx / length } : Vec2 { 0.0f, -1.0f };
}

/// A half circle from where the path is to (x, y).
void append_cap(std::string& svg, double radius, double x, double y)
{
    svg += 'A';
    append_place(svg, radius, radius);
    svg += " 0 0 1 ";
    append_place(svg, x, y);
}

/// The outline of a line: along one of its sides and back along the other.
void append_outline(std::string& svg, const InkPoint* p, Index count, const Placing& placing)
{
    const auto side = [&](Index k, float sign, double& x, double& y) {
        const Vec2 n = normal_at(p, k, count);
        const float off = 0.5f * sign * p[k].width;
        x = placing.x(p[k].x + off * n.x);
        y = placing.y(p[k].y + off * n.y);
    };
    double x = 0.0, y = 0.0, back_x = 0.0, back_y = 0.0;
    svg += "<path d=\"M";
    for (Index k = 0; k < count; ++k) {
        side(k, 1.0f, x, y);
        svg += k == 0 ? "" : k == 1 ? "L" : " ";
        append_place(svg, x, y);
    }
    side(count - 1, -1.0f, back_x, back_y);
    append_cap(svg, placing.scale * 0.5 * double(p[count - 1].width), back_x, back_y);
    svg += 'L';
    for (Index k = count - 1; k-- > 0;) {
        side(k, -1.0f, x, y);
        svg += k + 2 == count ? "" : " ";
        append_place(svg, x, y);
    }
    side(0, 1.0f, back_x, back_y);
    append_cap(svg, placing.scale * 0.5 * double(p[0].width), back_x, back_y);
    svg += "Z\"/>\n";
}

void append_dot(std::string& svg, const InkPoint& p, const Placing& placing)
{
    svg += "<circle cx=\"";
    append_number(svg, placing.x(p.x), kDecimals);
    svg += "\" cy=\"";
    append_number(svg, placing.y(p.y), kDecimals);
    svg += "\" r=\"";
    append_number(svg, placing.scale * 0.5 * double(p.width), kDecimals);
    svg += "\"/>\n";
}

void append_middle(std::string& svg, const InkPoint* p, Index count, const Placing& placing)
{
    svg += "<path d=\"M";
    for (Index k = 0; k < count; ++k) {
        svg += k == 0 ? "" : k == 1 ? "L" : " ";
        append_place(svg, placing.x(p[k].x), placing.y(p[k].y));
    }
    svg += count == 1 ? "h0\"/>\n" : "\"/>\n";
}

/// A sheet with a group for each ink. attributes(ink) says how its lines are drawn, append(line) writes one.
template<class Attributes, class Append>
std::string sheet(const Drawing& drawing, const Paper& paper, const std::string& behind, Attributes&& attributes,
                  Append&& append)
{
    std::string size;
    append_number(size, paper.width, kDecimals);
    size += "mm\" height=\"";
    append_number(size, paper.height, kDecimals);
    std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" "
                      "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\""
        + size + "mm\" viewBox=\"0 0 ";
    append_place(svg, paper.width, paper.height);
    svg += "\">\n" + behind;
    for (std::size_t ink = drawing.inks.size(); ink-- > 0;) {
        const std::string number = std::to_string(ink + 1);
        svg += "<g inkscape:groupmode=\"layer\" id=\"ink-";
        svg += number;
        svg += "\" inkscape:label=\"";
        svg += number;
        svg += "-ink\" ";
        svg += attributes(hexadecimal(drawing.inks[ink]));
        svg += ">\n";
        for (const InkLine& line : drawing.lines)
            if (line.ink == ink)
                append(svg, line);
        svg += "</g>\n";
    }
    return svg + "</svg>\n";
}

Placing placing_of(const Drawing& drawing, Paper& paper)
{
    const double scale = millimetres_per_pixel(drawing, paper);
    return { scale, 0.5 * (paper.width - scale * drawing.width), 0.5 * (paper.height - scale * drawing.height) };
}

}  // namespace

double millimetres_per_pixel(const Drawing& drawing, Paper& paper)
{
    const double w = std::max(1, drawing.width), h = std::max(1, drawing.height);
    const double upright = std::min(paper.width / w, paper.height / h);
    const double turned = std::min(paper.height / w, paper.width / h);
    if (turned > upright)
        std::swap(paper.width, paper.height);
    return std::max(upright, turned);
}

std::string drawing_to_svg(const Drawing& drawing, Paper paper)
{
    const Placing placing = placing_of(drawing, paper);
    return sheet(
        drawing, paper, "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        [](const std::string& colour) { return "fill=\"" + colour + "\""; },
        [&](std::string& svg, const InkLine& line) {
            if (line.count == 1)
                append_dot(svg, *drawing.begin(line), placing);
            else
                append_outline(svg, drawing.begin(line), line.count, placing);
        });
}

std::string drawing_to_plot(const Drawing& drawing, Paper paper, float pen)
{
    const Placing placing = placing_of(drawing, paper);
    std::string width;
    append_number(width, placing.scale * double(pen), kDecimals);
    return sheet(
        drawing, paper, "",
        [&](const std::string& colour) {
            return "fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke=\"" + colour
                + "\" stroke-width=\"" + width + "\"";
        },
        [&](std::string& svg, const InkLine& line) { append_middle(svg, drawing.begin(line), line.count, placing); });
}

std::string drawing_to_json(const Drawing& drawing)
{
    std::string json = "{\"width\": " + std::to_string(drawing.width)
        + ", \"height\": " + std::to_string(drawing.height) + ", \"inks\": [";
    for (std::size_t ink = 0; ink < drawing.inks.size(); ++ink) {
        json += ink ? ", [" : "[";
        for (std::size_t c = 0; c < 3; ++c)
            json += (c ? ", " : "") + std::to_string(byte_of(drawing.inks[ink][c]));
        json += ']';
    }
    json += "], \"lines\": [";
    for (std::size_t i = 0; i < drawing.lines.size(); ++i) {
        const InkLine& line = drawing.lines[i];
        json += (i ? ",\n{\"ink\": " : "\n{\"ink\": ") + std::to_string(line.ink) + ", \"points\": [";
        for (Index k = 0; k < line.count; ++k) {
            const InkPoint& p = drawing.begin(line)[k];
            json += k ? ", [" : "[";
            for (const float value : { p.x, p.y, p.width }) {
                append_number(json, double(value), kDecimals);
                json += ", ";
            }
            json.resize(json.size() - 2);
            json += ']';
        }
        json += "]}";
    }
    return json + "\n]}\n";
}

}  // namespace PIMG_ABI
}  // namespace pimg
