// SPDX-License-Identifier: BSD-3-Clause
#include "docs.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include <OpenImageIO/strutil.h>

namespace pimg {
namespace python {

namespace {

using OIIO::Strutil::fmt::format;

std::string to_text(const py::handle& value)
{
    if (py::isinstance<py::bool_>(value))
        return value.cast<bool>() ? "1" : "0";
    if (py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value)) {
        std::string joined;
        for (const py::handle item : value)
            joined += (joined.empty() ? "" : ",") + to_text(item);
        return joined;
    }
    if (py::hasattr(value, "__fspath__"))
        return py::str(value.attr("__fspath__")());
    const std::string text = py::str(value);
    return text == "True" ? "1" : text == "False" ? "0" : text;  // NumPy's are no bool
}

/// Words of Python's own, such as `from`, end in an underscore.
std::string python_name(const OptionInfo& option)
{
    const bool reserved = py::module_::import("keyword").attr("iskeyword")(option.key).cast<bool>();
    return reserved ? option.key + "_" : option.key;
}

bool has_range(const OptionInfo& option)
{
    return option.min != option.max;
}

/// The default as Python writes it.
std::string literal(const OptionInfo& option)
{
    if (option.type == "flag")
        return option.default_value == "1" ? "True" : "False";
    if (option.type == "string")
        return option.default_value.empty() ? "None" : "'" + option.default_value + "'";
    return option.default_value.empty() ? "None" : option.default_value;
}

py::object default_of(const OptionInfo& option)
{
    if (option.type == "flag")
        return py::bool_(option.default_value == "1");
    if (option.default_value.empty())
        return py::none();
    if (option.type == "int")
        return py::int_(std::stoi(option.default_value));
    if (option.type == "float")
        return py::float_(OIIO::Strutil::stod(option.default_value));
    return py::str(option.default_value);
}

std::string paragraph(const OptionInfo& option)
{
    static const std::pair<const char*, const char*> types[]
        = { { "flag", "bool" }, { "int", "int" }, { "float", "float" }, { "string", "str" } };
    std::string text = python_name(option) + " : ";
    for (const auto& [type, python_type] : types)
        if (option.type == type)
            text += python_type;
    if (!option.choices.empty())
        text += ", " + OIIO::Strutil::replace(option.choices, "|", ", ", true);
    if (!option.range.empty())
        text += ", " + option.range;
    if (!option.unit.empty())
        text += ", in " + option.unit;
    if (literal(option) != "None")
        text += ", default " + literal(option);
    return text + "\n    " + option.help + "\n";
}

}  // namespace

OptionTexts to_texts(const py::kwargs& arguments, const std::vector<OptionInfo>& known)
{
    OptionTexts texts;
    std::vector<std::string> names;
    for (const OptionInfo& option : known)
        names.push_back(python_name(option));
    for (const auto& [key, value] : arguments) {
        const std::string name = py::str(key);
        const auto at = std::find(names.begin(), names.end(), name);
        if (at == names.end())
            throw py::type_error(unknown_option(name, { names.begin(), names.end() }));
        if (!value.is_none())
            texts.emplace_back(known[std::size_t(at - names.begin())].key, to_text(value));
    }
    return texts;
}

py::list to_list(const std::vector<OptionInfo>& options)
{
    py::list list;
    for (const OptionInfo& option : options) {
        py::dict row;
        row["name"] = python_name(option);
        row["type"] = option.type;
        row["default"] = default_of(option);
        row["min"] = has_range(option) ? py::object(py::float_(option.min)) : py::none();
        row["max"] = has_range(option) ? py::object(py::float_(option.max)) : py::none();
        row["choices"] = py::none();
        if (!option.choices.empty())
            row["choices"] = py::cast(OIIO::Strutil::splits(option.choices, "|"));
        row["unit"] = option.unit;
        row["help"] = option.help;
        list.append(row);
    }
    return list;
}

std::string docstring(const std::string& name, const std::string& first, const std::string& rest,
                      const std::vector<OptionInfo>& options, const std::string& before, const std::string& after)
{
    std::string signature = name + "(" + first + ", *", parameters;
    for (const OptionInfo& option : options) {
        signature += ", " + python_name(option) + "=" + literal(option);
        parameters += paragraph(option);
    }
    return signature + rest + ")\n--\n\n" + before + "\n\nParameters\n----------\n" + parameters + after;
}

const FilterText& text_of(const Filter& filter)
{
    static const FilterText texts[] = {
        { "hdr_compress",
          "Compresses a scene's range of luminance to a display's (paper, section 5.1). Without options everything is\n"
          "found from the picture; values of 0 that are described so stand for that.",
          "Display-linear light, float, white at 1; srgb_encoded() makes it fit for a screen or an 8-bit file. With\n"
          "fit=False in the units of the source." },
        { "feature_lowpass",
          "Smooths texture away and keeps edges and thin lines. By strength, or by splits or fraction (paper, section\n"
          "4.1); none of them means strength=0.03, or 0.3 stops with log.",
          "As the source; strength=0 is the source, bit for bit." },
        { "detail_enhance",
          "Multiplies details: those of a range of splits (paper, section 4.1) or, with strength, noise or log, what\n"
          "feature_lowpass() of that strength removes.",
          "As the source, but float if that is whole numbers; may exceed its range. gain=1 is the source, bit for bit." },
        { "segment",
          "Partitions the picture into connected regions that look alike (paper, section 4.2). Other numbers of regions of\n"
          "the same ProgressiveImage are nested and cost one pass.",
          "labels: uint32 numbers from 0, one channel; mean: as the source; boundaries: one channel, 1 or 0." },
        { "paint", "Paints the picture with brush strokes that follow its forms (paper, section 5.2).",
          "As the source." },
        { "mosaic", "Lays the dual pieces of a level as tiles of their mean colour (paper, section 7).",
          "As the source." },
        { "ink", "Draws with black lines (0) on white paper (1) along the edges (paper, section 7).",
          "As the source, every colour channel the same." },
        { "level",
          "The mesh M_i of one level as a picture: its triangles, Gouraud-shaded. At most one option; none means the\n"
          "finest level.",
          "As the source." },
        { "wireframe", "The edges of the mesh M_i, black on white or, with overlay, on the picture of the level.",
          "As the source." },
    };
    for (const FilterText& text : texts)
        if (std::strcmp(text.name, filter.name) == 0)
            return text;
    throw std::logic_error(format("no text for {}", filter.name));
}

}  // namespace python
}  // namespace pimg
