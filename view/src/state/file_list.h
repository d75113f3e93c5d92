// SPDX-License-Identifier: BSD-3-Clause
// The files that may be looked at, one after the other.
#pragma once

#include <string>
#include <vector>

namespace pimgview {

/// The names of files that were meant: a pattern with # or %04d stands for all frames that exist, in order; a folder
/// for its pictures, by name; everything else for itself.
std::vector<std::string> expand_files(const std::vector<std::string>& given);

/// Folders first, then pictures, by name; what begins with a dot is left out. Names of folders end in a slash.
std::vector<std::string> list_folder(const std::string& folder);

}  // namespace pimgview
