// SPDX-License-Identifier: BSD-3-Clause
// Options and docstrings in Python, made from the option tables and texts.cpp.
#pragma once

#include <string>
#include <vector>

#include <pybind11/stl.h>

#include <pimg/filter_table.h>

namespace pimg {
namespace python {

namespace py = pybind11;

/// Keyword arguments as texts for the option tables: numbers, flags, strings, paths; sequences are joined by commas,
/// and None is left out. TypeError for a key that is not among `known`.
OptionTexts to_texts(const py::kwargs& arguments, const std::vector<OptionInfo>& known);

/// [{"name": "beta", "type": "float", "default": 10.0, "min": 0.0, ...}]; None for what there is not.
py::list to_list(const std::vector<OptionInfo>& options);

/// The options of a filter, of "build" or "open", of "save", of "gain_map_jpeg". ValueError for other names.
std::vector<OptionInfo> options_of(const std::string& name);

/// The docstring of a function: "name(first, *, key=default, ...)\n--\n\n", which is where inspect.signature() finds
/// it, then description, options, results and errors.
std::string doc(const std::string& name, const std::string& first);

}  // namespace python
}  // namespace pimg
