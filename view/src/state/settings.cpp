// SPDX-License-Identifier: BSD-3-Clause
#include "state/settings.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <OpenImageIO/filesystem.h>

#include <pimg/detail/format.h>
#include <pimg/detail/safe_file.h>

namespace pimgview {

namespace {

namespace Filesystem = OIIO::Filesystem;

/// The folder that a variable names. By the specification a name that is not absolute counts as not set.
std::string base_folder(const char* variable, const char* in_home)
{
    const char* given = std::getenv(variable);
    if (given != nullptr && given[0] == '/')
        return std::string(given) + "/pimg";
    const char* home = std::getenv("HOME");
    return home != nullptr && home[0] == '/' ? std::string(home) + "/" + in_home + "/pimg" : "";
}

bool make_folders(const std::string& folder)
{
    if (folder.empty() || Filesystem::is_directory(folder))
        return !folder.empty();
    const std::string parent = Filesystem::parent_path(folder);
    std::string error;
    return (parent.empty() || make_folders(parent)) && Filesystem::create_directory(folder, error);
}

bool write_text(const std::string& filename, const std::string& text)
{
    std::string why;
    return make_folders(Filesystem::parent_path(filename)) && pimg::write_whole_file(filename, text, why);
}

}  // namespace

std::string config_folder()
{
    return base_folder("XDG_CONFIG_HOME", ".config");
}

std::string preset_folder()
{
    const std::string folder = base_folder("XDG_DATA_HOME", ".local/share");
    return folder.empty() ? "" : folder + "/presets";
}

Settings read_settings(const std::string& filename)
{
    Settings settings;
    std::ifstream file(filename);
    for (std::string line; std::getline(file, line);) {
        const std::size_t equals = line.find('=');
        if (equals != line.npos)
            settings[line.substr(0, equals)] = line.substr(equals + 1);
    }
    return settings;
}

bool write_settings(const Settings& settings, const std::string& filename)
{
    std::string text;
    for (const auto& [key, value] : settings)
        if (value.find('\n') == value.npos)
            text.append(key).append("=").append(value).append("\n");
    return write_text(filename, text);
}

std::vector<std::string> preset_names()
{
    std::vector<std::string> files, names;
    if (!preset_folder().empty() && Filesystem::is_directory(preset_folder()))
        Filesystem::get_directory_entries(preset_folder(), files);
    for (const std::string& file : files)
        if (Filesystem::extension(file) == ".txt") {
            const std::string name = Filesystem::filename(file);
            names.push_back(name.substr(0, name.size() - 4));
        }
    std::sort(names.begin(), names.end());
    return names;
}

std::string read_preset(const std::string& name)
{
    std::string text;
    Filesystem::read_text_file(preset_folder() + "/" + name + ".txt", text);
    return text;
}

bool write_preset(const std::string& name, const std::string& line, std::string& error)
{
    if (name.empty() || name[0] == '.' || name.find('/') != name.npos) {
        error = pimg::format("\"{}\": expected a name for the preset without slashes, not beginning with a dot", name);
        return false;
    }
    const std::string filename = preset_folder() + "/" + name + ".txt";
    if (!preset_folder().empty() && write_text(filename, line + "\n"))
        return true;
    error = pimg::format("cannot write \"{}\"", filename);
    return false;
}

}  // namespace pimgview
