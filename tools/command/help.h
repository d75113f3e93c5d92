// SPDX-License-Identifier: BSD-3-Clause
// What --help and --version print, and what is installed with the tool, from the command table.
#pragma once

#include <string>

#include <pimg/options.h>

namespace pimgtool {

struct Command;

/// Keys of --help.
struct HelpOptions {
    std::string format = "text";
};

std::string version_text();

/// Every command with every key.
std::string help_text();

/// One command with its keys.
std::string help_text(const Command& command);

/// The same table as a manual page, and as a script that makes bash complete commands, keys and values.
std::string manual_page();
std::string bash_completion();

/// "a to b unit" or "one|two": what a key may be set to.
std::string values_of(const pimg::OptionInfo& option);

}  // namespace pimgtool

namespace pimg {

template<>
const std::vector<Option<pimgtool::HelpOptions>>& option_table<pimgtool::HelpOptions>();

}  // namespace pimg
