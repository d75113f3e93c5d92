// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/option_text.h>

#include <algorithm>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

bool begins_number(char c)
{
    return (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
}

std::size_t end_of_value(std::string_view text, char separator)
{
    std::size_t end = text.find(separator);
    while (separator == ':' && end < text.size() - 1 && begins_number(text[end + 1]))
        end = text.find(separator, end + 1);
    return std::min(end, text.size());
}

/// Moves a value in quotation marks from the front of `text` to `value`. False if no mark ends it.
bool take_quoted(std::string_view& text, std::string& value)
{
    const char mark = text[0];
    for (std::size_t i = 1; i < text.size(); ++i) {
        const bool doubled = text[i] == mark && i + 1 < text.size() && text[i + 1] == mark;
        if (text[i] == mark && !doubled) {
            text.remove_prefix(i + 1);
            return true;
        }
        value += text[i];
        i += doubled;
    }
    return false;
}

/// Moves a value and the separator after it from the front of `text` to `value`.
bool take_value(std::string_view& text, char separator, std::string& value)
{
    if (!text.empty() && (text[0] == '"' || text[0] == '\'')) {
        if (!take_quoted(text, value))
            return false;
    } else {
        const std::size_t end = end_of_value(text, separator);
        value = text.substr(0, end);
        text.remove_prefix(end);
    }
    return text.empty() || text[0] == separator;
}

}  // namespace

bool split_options(std::string_view text, OptionTexts& texts, std::string& error, char separator)
{
    for (bool more = !text.empty(); more;) {
        const std::size_t equals = text.find('=');
        if (equals == 0 || equals == text.npos || text.find(separator) < equals) {
            error = "\"" + std::string(text.substr(0, text.find(separator))) + "\": expected key=value";
            return false;
        }
        const std::string key(text.substr(0, equals));
        std::string value;
        text.remove_prefix(equals + 1);
        if (!take_value(text, separator, value)) {
            error = key + ": expected the value in quotation marks to end with one, and then '" + separator
                + "' or nothing";
            return false;
        }
        texts.emplace_back(key, value);
        more = !text.empty();
        text.remove_prefix(more ? 1 : 0);
    }
    return true;
}

}  // namespace PIMG_ABI
}  // namespace pimg
