// SPDX-License-Identifier: BSD-3-Clause
// Files of strokes, of any numbers and colours: what is written must be JSON and XML that another program reads, with as
// many strokes as there were. pimg itself does not read them.
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <pimg/stroke_file.h>

#include "taken.h"

using namespace pimg;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Taken in(data, size);
    Strokes strokes;
    strokes.width = in.number<std::uint16_t>();
    strokes.height = in.number<std::uint16_t>();
    const float opacity = in.number<float>();
    ShownColours colours(in.number<std::uint8_t>() % 2 ? 3 : in.number<std::uint8_t>() % 2);
    while (in.left() > 0 && strokes.strokes.size() < 64) {
        Stroke stroke;
        stroke.first = Index(strokes.points.size());
        stroke.count = 2 + in.number<std::uint8_t>() % 4;
        stroke.width = in.number<float>();
        stroke.vertex = in.number<Index>();
        stroke.level = in.number<Level>();
        for (Index i = 0; i < stroke.count; ++i) {
            const float x = in.number<float>();
            strokes.points.push_back({ x, in.number<float>() });
        }
        strokes.strokes.push_back(stroke);
        for (auto& channel : colours)
            channel.push_back(in.number<float>());
    }
    namespace tree = boost::property_tree;
    tree::ptree json, svg;
    std::istringstream json_text(strokes_to_json(strokes, colours, opacity));
    std::istringstream svg_text(strokes_to_svg(strokes, colours, opacity, size % 2 ? "#ffffff" : ""));
    tree::read_json(json_text, json);
    tree::read_xml(svg_text, svg);
    must(json.get_child("strokes").size() == strokes.strokes.size());
    return 0;
}
