// SPDX-License-Identifier: BSD-3-Clause
#include "arguments.h"

#include <cstdio>
#include <functional>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/version.h>

#include "keys.h"

namespace pimgview {

namespace {

using pimg::format;

/// A word of the command line. `take` receives the word after it, or nothing for a switch.
struct Word {
    const char* name;
    const char* operand;  ///< "" for a switch
    const char* help;
    std::function<bool(const std::string& operand, Arguments& arguments, std::string& error)> take;
};

bool take_script(const std::string& text, Arguments& arguments, std::string& error)
{
    std::string line = text;
    std::vector<std::string> words;
    if (!text.empty() && text[0] == '@' && !OIIO::Filesystem::read_text_file(text.substr(1), line)) {
        error = format("cannot read \"{}\"", text.substr(1));
        return false;
    }
    Script script;
    if (!split_words(line, words, error) || !parse_script(words, script, error))
        return false;
    if (arguments.screenshot.empty())
        arguments.script = std::move(script);
    else
        arguments.more.push_back({ std::move(script), "" });
    return true;
}

/// A screenshot belongs to the script before it.
bool take_screenshot(const std::string& name, Arguments& arguments, std::string& error)
{
    std::string& screenshot = arguments.more.empty() ? arguments.screenshot : arguments.more.back().screenshot;
    if (!screenshot.empty())
        error = "expected --script before the next one";
    else
        screenshot = name;
    return error.empty() && !name.empty();
}

bool take_number(const std::string& text, int least, int& number, std::string& error)
{
    if (OIIO::Strutil::string_is_int(text))
        number = OIIO::Strutil::stoi(text);
    if (OIIO::Strutil::string_is_int(text) && number >= least)
        return true;
    error = format("\"{}\": expected a whole number, {} or more", text, least);
    return false;
}

bool take_size(const std::string& text, Arguments& arguments, std::string& error)
{
    char rest = '\0';
    arguments.sized = std::sscanf(text.c_str(), "%dx%d%c", &arguments.width, &arguments.height, &rest) == 2
        && arguments.width >= 64 && arguments.height >= 64 && arguments.width <= 16384 && arguments.height <= 16384;
    if (!arguments.sized)
        error = format("\"{}\": expected WIDTHxHEIGHT from 64x64 to 16384x16384, such as 1280x800", text);
    return arguments.sized;
}

const std::vector<Word>& word_table()
{
    using A = Arguments;
    using S = std::string;
    static const std::vector<Word> table = {
        { "--script", "TEXT", "replays a command line of pimgtool, with --view for what is looked at; @FILE: a file's",
          take_script },
        { "--screenshot", "FILE", "writes what the window shows when all is done; then the next --script, or the end",
          take_screenshot },
        { "--size", "WxH", "size of the window", take_size },
        { "--measure", "OPTION", "drags that option of the first filter that has it, and prints frames per second",
          [](const S& text, A& a, S&) {
              return !(a.measured = text).empty();
          } },
        { "--random-events", "N", "plays that many random keys, clicks and drags, and ends",
          [](const S& text, A& a, S& error) {
              return take_number(text, 1, a.random_events, error);
          } },
        { "--seed", "N", "of the random events",
          [](const S& text, A& a, S& error) {
              return take_number(text, 0, a.seed, error);
          } },
        { "--tile", "N", "largest side of a texture, 64 or more; 0, the default: what the driver allows",
          [](const S& text, A& a, S& error) {
              return text == "0" || take_number(text, 64, a.tile, error);  // smaller ones take minutes to draw
          } },
        { "--help", "", "prints this",
          [](const S&, A& a, S&) {
              return a.help = true;
          } },
        { "--version", "", "prints the version",
          [](const S&, A& a, S&) {
              return a.version = true;
          } },
    };
    return table;
}

/// Whether a filter of the script has an option of that name.
bool has_option(const FilterStack& stack, const std::string& key)
{
    for (const StackItem& item : stack.items)
        for (const pimg::OptionInfo& option : item.filter->options())
            if (option.key == key)
                return true;
    return false;
}

/// Options of --view, one a line.
std::string look_text()
{
    std::string text;
    for (const pimg::OptionInfo& option : pimg::describe_options<LookOptions>())
        text += format("    {:<12}{}{}\n", option.key, option.help,
                       option.choices.empty() ? "" : " (" + option.choices + ")");
    return text;
}

}  // namespace

bool parse_arguments(const std::vector<std::string>& words, Arguments& arguments, std::string& error)
{
    for (std::size_t i = 0; i < words.size(); ++i) {
        const Word* found = nullptr;
        for (const Word& word : word_table())
            if (words[i] == word.name)
                found = &word;
        if (found == nullptr && !words[i].empty() && words[i][0] == '-') {
            error = format("unknown option \"{}\": --help lists them; filters belong into --script", words[i]);
            return false;
        }
        if (found == nullptr) {
            arguments.files.push_back(words[i]);
            continue;
        }
        const bool operand = *found->operand != '\0';
        if (operand && i + 1 == words.size()) {
            error = format("{}: expected {} after it", found->name, found->operand);
            return false;
        }
        if (!found->take(operand ? words[++i] : "", arguments, error)) {
            error = format("{}: {}", found->name, error.empty() ? "expected a name that is not empty" : error);
            return false;
        }
    }
    if (!arguments.more.empty() && arguments.more.back().screenshot.empty()) {
        error = "--script: expected --screenshot after the last one";
        return false;
    }
    if (!arguments.measured.empty() && !has_option(arguments.script.stack, arguments.measured)) {
        error = format("--measure: expected a filter in --script that has the option \"{}\"", arguments.measured);
        return false;
    }
    arguments.files.insert(arguments.files.end(), arguments.script.files.begin(), arguments.script.files.end());
    return true;
}

std::string help_text()
{
    std::string text =
        "usage: pimgview [FILE ...] [OPTION ...]\n"
        "Shows pictures, and turns every option of every filter of pimgtool while looking at them. A file may be\n"
        "a folder, or a sequence such as shot.####.exr.\n\nOptions\n";
    for (const Word& word : word_table())
        text += format("  {:<22}{}\n", format("{} {}", word.name, word.operand), word.help);
    text += "\nKeys of --view in a script, as in --view:zoom=1:show=split\n" + look_text() + "\nKeys in the window\n";
    for (const Key& key : key_table())
        text += *key.name == '\0' ? "" : format("    {:<14}{}\n", key.name, key.help);
    return text
        + "\nThe mouse drags the picture; the wheel zooms. Sliders: a double click brings the default, Ctrl+click "
          "types.\n";
}

std::string manual_page()
{
    const auto roff = [](const std::string& text) {
        std::string out;
        for (const char letter : text)
            out += letter == '\\' ? "\\e" : letter == '-' ? "\\-" : std::string(1, letter);
        return out;
    };
    std::string page = format(
        ".TH PIMGVIEW 1 \"\" \"pimg {}\" \"User Commands\"\n.SH NAME\n"
        "pimgview \\- look at pictures and turn the filters of pimgtool\n"
        ".SH SYNOPSIS\n.B pimgview\n[\\fIFILE\\fR ...] [\\fIOPTION\\fR ...]\n.SH DESCRIPTION\n"
        "Shows pictures of any format that OpenImageIO reads, among them .pimg. Every option of every filter is a "
        "slider. The command line of pimgtool that makes what is seen is always shown.\n.SH OPTIONS\n",
        PIMG_VERSION_STRING);
    for (const Word& word : word_table())
        page += format(".TP\n\\fB{}\\fR \\fI{}\\fR\n{}\n", roff(word.name), roff(word.operand), roff(word.help));
    page += ".SH KEYS OF \\-\\-VIEW\n";
    for (const pimg::OptionInfo& option : pimg::describe_options<LookOptions>())
        page += format(".TP\n\\fB{}\\fR\n{}\n", roff(option.key), roff(option.help));
    page += ".SH KEYS IN THE WINDOW\n";
    for (const Key& key : key_table())
        page += *key.name == '\0' ? "" : format(".TP\n\\fB{}\\fR\n{}\n", roff(key.name), roff(key.help));
    return page + ".SH SEE ALSO\n.BR pimgtool (1)\n";
}

}  // namespace pimgview
