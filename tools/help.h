// SPDX-License-Identifier: BSD-3-Clause
// What --help and --version print, from the command table.
#pragma once

#include <string>

namespace pimgtool {

struct Command;

std::string version_text();

/// Every command with every key.
std::string help_text();

/// One command with its keys.
std::string help_text(const Command& command);

}  // namespace pimgtool
