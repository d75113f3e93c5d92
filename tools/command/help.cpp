// SPDX-License-Identifier: BSD-3-Clause
#include "command/help.h"

#include <algorithm>
#include <map>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/version.h>

#include "command/command.h"

namespace pimg {

template<>
const std::vector<Option<pimgtool::HelpOptions>>& option_table<pimgtool::HelpOptions>()
{
    static const std::vector<Option<pimgtool::HelpOptions>> table = {
        { &pimgtool::HelpOptions::format,
          { "format", 0, 0, "", "text|man|bash", "man: the manual page, bash: a script for completion" } },
    };
    return table;
}

}  // namespace pimg

namespace pimgtool {

using pimg::format;

std::string values_of(const pimg::OptionInfo& option)
{
    if (!option.choices.empty())
        return option.choices;
    std::string text = option.type == "flag" ? "0 or 1" : option.range.empty() ? option.type : option.range;
    if (!option.unit.empty())
        text += " " + option.unit;
    return text;
}

std::string version_text()
{
    const int v = OIIO::get_int_attribute("version", OIIO_VERSION);
    return format("pimgtool {} (OpenImageIO {}.{}.{})\n", PIMG_VERSION_STRING, v / 10000, v / 100 % 100, v % 100);
}

namespace {

/// The values of a preset, by key.
std::map<std::string, std::string> values_of(const pimg::Preset& preset)
{
    pimg::OptionTexts texts;
    std::string error;
    pimg::split_options(preset.values, texts, error);
    return { texts.begin(), texts.end() };
}

/// A table of the presets: a column for each, a row for every option they set.
std::string presets_text(const Command& command)
{
    std::string text = "      values where none is given:\n";
    std::vector<std::map<std::string, std::string>> columns;
    std::vector<std::size_t> widths;
    text += format("      {:<13}", "style");
    for (const pimg::Preset& preset : command.presets()) {
        columns.push_back(values_of(preset));
        widths.push_back(std::string(preset.name).size());
        for (const auto& [key, value] : columns.back())
            widths.back() = std::max(widths.back(), value.size());
        text += format("  {:>{}}", preset.name, widths.back());
    }
    text += '\n';
    for (const pimg::OptionInfo& option : command.keys()) {
        if (columns[0].count(option.key) == 0)
            continue;
        text += format("      {:<13}", option.key);
        for (std::size_t i = 0; i < columns.size(); ++i)
            text += format("  {:>{}}", columns[i][option.key], widths[i]);
        text += '\n';
    }
    return text;
}

}  // namespace

std::string help_text(const Command& command)
{
    const std::string words = *command.words == '\0' ? "" : format(" {}", command.words);
    const std::string suffix = command.keys ? "[:key=value...]" : "";
    std::string text = format("  {}{}{}\n      {}\n", command.name, suffix, words, command.help);
    if (!command.keys)
        return text;
    const std::vector<pimg::OptionInfo> options = command.keys();
    std::size_t keys = 0, values = 0;
    for (const pimg::OptionInfo& option : options) {
        keys = std::max(keys, option.key.size() + 1 + option.default_value.size());
        values = std::max(values, values_of(option).size());
    }
    for (const pimg::OptionInfo& option : options)
        text += format("      {:<{}}  {:<{}}  {}\n", option.key + "=" + option.default_value, keys, values_of(option),
                       values, option.help);
    return text + (command.presets ? presets_text(command) : "");
}

std::string help_text()
{
    std::string text = "pimgtool: progressive images: HDR compression, smoothing and enhancement that know features\n"
                       "\n"
                       "usage: pimgtool INPUT [--operation[:key=value...]]... -o OUTPUT ...\n"
                       "\n"
                       "Arguments are taken from left to right: a file name puts a picture on the stack, an operation\n"
                       "replaces the picture on top, -o writes it. Defaults are shown as key=default.\n"
                       "\n"
                       "  pimgtool in.exr --hdr-compress:beta=10 -o out.png\n"
                       "  pimgtool in.exr --dup --level:faces=5000 -o coarse.exr --pop --detail-enhance -o fine.exr\n";
    for (const CommandGroup& group : command_table()) {
        text += format("\n{}:\n", group.title);
        for (const Command& command : group.commands)
            text += help_text(command);
    }
    return text;
}

}  // namespace pimgtool
