// SPDX-License-Identifier: BSD-3-Clause
// What is remembered from one run to the next, where the XDG base directory specification puts it: settings in
// $XDG_CONFIG_HOME/pimg, presets in $XDG_DATA_HOME/pimg/presets.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace pimgview {

using Settings = std::map<std::string, std::string>;

/// $XDG_CONFIG_HOME/pimg and so on; by default in the user's home. Empty if there is none.
std::string config_folder();
std::string preset_folder();

/// Lines of key=value. A file that cannot be read holds none.
Settings read_settings(const std::string& filename);

/// Writes the file whole or not at all; false if it cannot be.
bool write_settings(const Settings& settings, const std::string& filename);

/// Presets are command lines in files NAME.txt.
std::vector<std::string> preset_names();
std::string read_preset(const std::string& name);
bool write_preset(const std::string& name, const std::string& line, std::string& error);

}  // namespace pimgview
