// SPDX-License-Identifier: BSD-3-Clause
// What is to be said of the functions besides their options.
#pragma once

#include <string>
#include <vector>

namespace pimg {
namespace python {

/// An argument that is no option.
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

/// Added to filters that are functions of a picture.
extern const char* const kSourceText;

}  // namespace python
}  // namespace pimg
