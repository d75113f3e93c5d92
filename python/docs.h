// SPDX-License-Identifier: BSD-3-Clause
// Options and docstrings in Python, made from the option tables.
#pragma once

#include <string>
#include <vector>

#include <pybind11/stl.h>

#include <pimg/filter_table.h>

namespace pimg {
namespace python {

namespace py = pybind11;

/// Keyword arguments as texts for the option tables: numbers, flags, strings, paths; sequences are joined by commas, and
/// None is left out. TypeError for a key that is not among `known`.
OptionTexts to_texts(const py::kwargs& arguments, const std::vector<OptionInfo>& known);

/// [{"name": "beta", "type": "float", "default": 10.0, "min": 0.0, ...}]: min, max and choices are None where there are none.
py::list to_list(const std::vector<OptionInfo>& options);

/// "name(first, *, key=default, ..., rest)\n--\n\n", which is where inspect.signature() finds it, then the text with a
/// description of every option after it.
std::string docstring(const std::string& name, const std::string& first, const std::string& rest,
                      const std::vector<OptionInfo>& options, const std::string& before, const std::string& after);

/// What is to be said of a filter besides its options.
struct FilterText {
    const char* name;
    const char* description;
    const char* result;
};
const FilterText& text_of(const Filter& filter);

}  // namespace python
}  // namespace pimg
