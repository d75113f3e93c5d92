// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/format.h>

#include <algorithm>

namespace pimg {

std::string format_packed(fmt::string_view pattern, fmt::format_args arguments)
{
    return fmt::vformat(pattern, arguments);
}

namespace {

/// `text` from `begin` to `end` without the middle if it is longer than `longest`, of which a quarter is kept of its end.
void append_shortened(std::string& result, const std::string& text, std::size_t begin, std::size_t end,
                      std::size_t longest)
{
    const std::size_t tail = longest / 4, head = longest - tail - 3;
    if (end - begin <= longest)
        result.append(text, begin, end - begin);
    else
        result.append(text, begin, head).append("...").append(text, end - tail, tail);
}

}  // namespace

std::string one_line(const std::string& message)
{
    // The longest path most systems have for one name fits in a word; the list of all keys of the plugin in a message.
    constexpr std::size_t kLongestWord = 300, kLongest = 1500;
    std::string words;
    for (std::size_t at = 0; at < message.size();) {
        const std::size_t end = std::min(message.find(' ', at), message.size());
        append_shortened(words, message, at, end, kLongestWord);
        at = end;
        if (at < message.size())
            words += message[at++];
    }
    std::string result;
    append_shortened(result, words, 0, words.find_last_not_of('\n') + 1, kLongest);
    for (char& c : result)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            c = c == '\n' ? ' ' : '?';
    return result;
}

std::string quoted_json(const std::string& text)
{
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            result += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            result += format("\\u{:04x}", int(c));
        else
            result += c;
    }
    return result + '"';
}

}  // namespace pimg
