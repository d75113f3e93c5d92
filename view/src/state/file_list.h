// SPDX-License-Identifier: BSD-3-Clause
// The files that may be looked at, one after the other.
#pragma once

#include <string>
#include <vector>

namespace pimgview {

/// Names of files for what was given: a pattern with # or %04d stands for the frames there are, in order, a folder for its
/// pictures by name, and everything else for itself.
std::vector<std::string> expand_files(const std::vector<std::string>& given);

/// Folders first, then pictures, by name; what begins with a dot is left out. Names of folders end in a slash.
std::vector<std::string> list_folder(const std::string& folder);

}  // namespace pimgview
