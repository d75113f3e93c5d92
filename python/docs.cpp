// SPDX-License-Identifier: BSD-3-Clause
#include "docs.h"

#include <algorithm>

#include <OpenImageIO/strutil.h>

#include <pimg/gain_map.h>

#include "pimg_pvt.h"
#include "texts.h"

namespace pimg {
namespace python {

namespace {

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
    return text == "True" ? "1" : text == "False" ? "0" : text;  // the flags of NumPy are not of type bool
}

/// The name of an option in Python. Reserved words such as `from` get an underscore at the end.
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
    static const std::pair<const char*, const char*> types[] = {
        { "flag", "bool" }, { "int", "int" }, { "float", "float" }, { "string", "str" }
    };
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
    std::vector<std::string> names(known.size());
    std::transform(known.begin(), known.end(), names.begin(), python_name);
    for (const auto& [key, value] : arguments) {
        const std::string name = py::str(key);
        const auto at = std::find_if(known.begin(), known.end(), [&](const OptionInfo& option) {
            return name == python_name(option) || (!option.alias.empty() && name == option.alias);
        });
        if (at == known.end())
            throw py::type_error(unknown_option(name, { names.begin(), names.end() }));
        if (!value.is_none())
            texts.emplace_back(at->key, to_text(value));
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

std::vector<OptionInfo> options_of(const std::string& name)
{
    if (name == "build" || name == "open")
        return describe_options<BuildOptions>();
    if (name == "save") {
        std::vector<OptionInfo> options = describe_options<io::WriteOptions>();
        options[0].default_value = "full";
        return options;
    }
    if (name == "gain_map_jpeg")
        return describe_options<GainMapOptions>();
    std::string error;
    const Filter* filter = find_filter(name == "resolve_hdr_compress" ? "hdr_compress" : name, error);
    if (filter == nullptr)
        throw py::value_error(error + ", build, open, save, gain_map_jpeg");
    return filter->options();
}

std::string doc(const std::string& name, const std::string& first)
{
    const FunctionText& text = function_text(name);
    std::string signature = name + "(" + first + ", *", parameters;
    for (const OptionInfo& option : options_of(name)) {
        signature += ", " + python_name(option) + "=" + literal(option);
        parameters += paragraph(option);
    }
    for (const char* argument : text.arguments) {
        const ArgumentText& more = argument_text(argument);
        signature += std::string(", ") + more.name + "=" + more.preset;
        parameters += more.description;
    }
    const bool takes_pictures = first == "src" && name != "build";
    return signature + ")\n--\n\n" + text.description + (takes_pictures ? kSourceText : "")
        + "\n\nParameters\n----------\n" + parameters + "\nReturns\n-------\n" + text.result + "\n\nRaises\n------\n"
        + text.errors;
}

}  // namespace python
}  // namespace pimg
