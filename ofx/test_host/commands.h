// SPDX-License-Identifier: BSD-3-Clause
// What the test host can be asked to do.
#pragma once

#include <string>
#include <vector>

namespace test_host {

/// Words of the command line after the bundle and the command: those with "=" set parameters, those that begin with "--"
/// are options and are followed by their value, the rest are in order.
struct Words {
    std::vector<std::string> rest;
    std::vector<std::pair<std::string, std::string>> settings, options;

    std::string option(const std::string& name, const std::string& otherwise = "") const;
    int number(const std::string& name, int otherwise) const;
};

/// Each returns false with a line in `error`.
bool list(const std::string& bundle, const Words& words, std::string& error);      ///< identifiers and labels
bool describe(const std::string& bundle, const Words& words, std::string& error);  ///< all properties of an effect
bool render(const std::string& bundle, const Words& words, std::string& error);
bool stops(const std::string& bundle, const Words& words, std::string& error);  ///< how long after it is asked to
bool stress(const std::string& bundle, const Words& words, std::string& error);
bool misuse(const std::string& bundle, const Words& words, std::string& error);

}  // namespace test_host
