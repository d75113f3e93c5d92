// SPDX-License-Identifier: BSD-3-Clause
#include "state/file_list.h"

#include <algorithm>
#include <set>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

namespace pimgview {

namespace {

namespace Filesystem = OIIO::Filesystem;

/// Extensions of all formats that can be read, in small letters.
const std::set<std::string>& extensions()
{
    static const std::set<std::string> all = [] {
        std::set<std::string> names { "pimg" };
        // "tiff:tif,tiff,tx;jpeg:jpg,jpeg"
        for (const std::string& format : OIIO::Strutil::splits(OIIO::get_string_attribute("extension_list"), ";"))
            for (const std::string& name : OIIO::Strutil::splits(format.substr(format.find(':') + 1), ","))
                names.insert(OIIO::Strutil::lower(name));
        return names;
    }();
    return all;
}

bool is_picture(const std::string& name)
{
    return extensions().count(OIIO::Strutil::lower(Filesystem::extension(name, false))) > 0;
}

/// The frames that a pattern stands for. A single # is four digits, as everywhere in OpenImageIO; of several each is one
/// digit, as in most other programs.
std::vector<std::string> frames_of(std::string pattern)
{
    if (pattern.find("##") != pattern.npos)
        std::replace(pattern.begin(), pattern.end(), '#', '@');
    std::string normal, frames;
    std::vector<std::string> names;
    std::vector<int> numbers;
    if (Filesystem::parse_pattern(pattern.c_str(), 0, normal, frames))
        Filesystem::scan_for_matching_filenames(normal, numbers, names);
    return names;
}

}  // namespace

std::vector<std::string> list_folder(const std::string& folder)
{
    std::vector<std::string> names, folders, files;
    Filesystem::get_directory_entries(folder, names);
    for (const std::string& path : names) {
        const std::string name = Filesystem::filename(path);
        if (name.empty() || name[0] == '.')
            continue;
        if (Filesystem::is_directory(path))
            folders.push_back(name + "/");
        else if (is_picture(name))
            files.push_back(name);
    }
    std::sort(folders.begin(), folders.end());
    std::sort(files.begin(), files.end());
    folders.insert(folders.end(), files.begin(), files.end());
    return folders;
}

std::vector<std::string> expand_files(const std::vector<std::string>& given)
{
    std::vector<std::string> files;
    for (const std::string& name : given) {
        const bool exists = Filesystem::exists(name);
        if (exists && Filesystem::is_directory(name)) {
            const std::string folder = name.back() == '/' ? name : name + '/';
            const std::size_t before = files.size();
            for (const std::string& entry : list_folder(name))
                if (entry.back() != '/')
                    files.push_back(folder + entry);
            if (files.size() == before)
                files.push_back(name);  // reading it says what is wrong
        } else if (!exists && name.find_first_of("#%@") != name.npos) {
            const std::vector<std::string> frames = frames_of(name);
            files.insert(files.end(), frames.begin(), frames.end());
            if (frames.empty())
                files.push_back(name);
        } else
            files.push_back(name);
    }
    return files;
}

}  // namespace pimgview
