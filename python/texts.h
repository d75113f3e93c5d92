// SPDX-License-Identifier: BSD-3-Clause
// Texts of the docstrings: all but the options, which come from the option tables.
#pragma once

#include <string>
#include <vector>

namespace pimg {
namespace python {

/// An argument that is not an option of a filter.
struct ArgumentText {
    const char* name;
    const char* preset;
    const char* description;
};
const ArgumentText& argument_text(const std::string& name);

struct FunctionText {
    const char* name;
    const char* description;
    std::vector<const char*> arguments;
    const char* result;
    const char* errors;
};
const FunctionText& function_text(const std::string& name);

/// Appended to the description of filters that are functions of the module, and so take any kind of picture.
extern const char* const kSourceText;

}  // namespace python
}  // namespace pimg
