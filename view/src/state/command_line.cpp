// SPDX-License-Identifier: BSD-3-Clause
#include "state/command_line.h"

#include <algorithm>
#include <string_view>

#include <pimg/detail/format.h>

namespace pimgview {

namespace {

using pimg::format;
using pimg::OptionTexts;

/// The text between two quotation marks; `inside` replaces each mark that the text itself contains.
std::string quoted(const std::string& text, char mark, const char* inside)
{
    std::string result(1, mark);
    for (const char letter : text)
        result += letter == mark ? std::string(inside) : std::string(1, letter);
    return result + mark;
}

/// By the rules of option_text.h: a value that holds a separator, or begins with a mark, is put between marks.
std::string option_value(const std::string& value)
{
    const bool plain = value.find_first_of(":&") == value.npos && value.find_first_of("\"'") != 0;
    return plain ? value : quoted(value, '"', "\"\"");
}

std::string argument(const std::string& command, const OptionTexts& texts)
{
    std::string text = command;
    for (const auto& [key, value] : texts)
        text += format(":{}={}", key, option_value(value));
    return text;
}

std::string shell_word(const std::string& word)
{
    const bool plain = !word.empty()
        && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:=,+-@%^")
            == word.npos;
    return plain ? word : quoted(word, '\'', "'\\''");
}

const pimg::Filter* filter_of(const std::string& command)
{
    for (const pimg::Filter& filter : pimg::filter_table())
        if (command == filter.command)
            return &filter;
    return nullptr;
}

template<class Options>
OptionTexts given_in(const Options& options)
{
    OptionTexts texts;
    const Options defaults;
    const std::vector<pimg::OptionInfo> infos = pimg::describe_options<Options>();
    for (std::size_t i = 0; i < infos.size(); ++i) {
        const pimg::Option<Options>& option = pimg::option_table<Options>()[i];
        const pimg::OptionValue value = option.get(options);
        if (value != option.get(defaults))
            texts.emplace_back(infos[i].key, pimg::describe_option(option.rule, value).default_value);
    }
    return texts;
}

bool parse_operation(const std::string& word, Script& script, std::string& error)
{
    const std::size_t colon = std::min(word.find(':'), word.size());
    const std::string command = word.substr(0, colon);
    OptionTexts texts;
    if (colon < word.size() && !pimg::split_options(std::string_view(word).substr(colon + 1), texts, error))
        return false;
    if (command == "--view") {
        script.has_look = true;
        return pimg::set_options(script.look, texts, error);
    }
    script.has_stack = true;
    if (command == "--build") {
        pimg::BuildOptions build;
        script.stack.build = texts;
        return pimg::set_options(build, texts, error);
    }
    const pimg::Filter* filter = filter_of(command);
    pimg::BoundFilter bound;
    if (filter == nullptr) {
        error = "expected --build, --view, -o FILE or a filter such as --hdr-compress";
        return false;
    }
    script.stack.items.push_back({ filter, texts, true });
    return filter->bind(texts, bound, error);
}

}  // namespace

std::vector<std::string> arguments_of(const FilterStack& stack)
{
    std::vector<std::string> words;
    if (!stack.build.empty())
        words.push_back(argument("--build", stack.build));
    for (const StackItem& item : stack.items)
        if (item.on)
            words.push_back(argument(item.filter->command, item.texts));
    return words;
}

std::string shell_line(const std::string& file, const FilterStack& stack, const std::string& output)
{
    std::string line = "pimgtool";
    if (!file.empty() && !stack.part.empty())
        line += " --part " + shell_word(stack.part);
    if (!file.empty())
        line += " " + shell_word(file);
    for (const std::string& word : arguments_of(stack))
        line += " " + shell_word(word);
    return output.empty() ? line : line + " -o " + shell_word(output);
}

std::string look_argument(const LookOptions& look)
{
    const OptionTexts texts = given_in(look);
    return texts.empty() ? "" : argument("--view", texts);
}

bool split_words(const std::string& line, std::vector<std::string>& words, std::string& error)
{
    std::string word;
    bool begun = false;
    char quote = '\0';
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char letter = line[i];
        if (quote != '\0' && letter == quote)
            quote = '\0';
        else if (quote == '\0' && (letter == '\'' || letter == '"')) {
            quote = letter;
            begun = true;
        } else if (letter == '\\' && quote != '\'' && i + 1 < line.size()) {
            word += line[++i];
            begun = true;
        } else if (quote == '\0' && (letter == ' ' || letter == '\t' || letter == '\n')) {
            if (begun)
                words.push_back(word);
            word.clear();
            begun = false;
        } else {
            word += letter;
            begun = true;
        }
    }
    if (begun)
        words.push_back(word);
    if (quote != '\0')
        error = format("{} without its end: expected a second one", quote);
    return quote == '\0';
}

bool parse_script(const std::vector<std::string>& words, Script& script, std::string& error)
{
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (i == 0 && (word == "pimgtool" || word == "pimgview"))
            continue;
        if (word.empty() || word[0] != '-') {
            script.files.push_back(word);
            continue;
        }
        if (word == "-o" || word == "--part") {
            if (i + 1 == words.size()) {
                error = format("{}: expected the name of a {} after it", word, word == "-o" ? "file" : "part");
                return false;
            }
            (word == "-o" ? script.output : script.stack.part) = words[++i];
            script.has_stack = script.has_stack || word == "--part";
            continue;
        }
        if (!parse_operation(word, script, error)) {
            error = format("{}: {}", word.substr(0, word.find(':')), error);
            return false;
        }
    }
    return true;
}

}  // namespace pimgview
