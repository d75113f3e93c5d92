// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/format.h>

#include <algorithm>

namespace pimg {
inline namespace PIMG_ABI {

std::string format_packed(fmt::string_view pattern, fmt::format_args arguments)
{
    return fmt::vformat(pattern, arguments);
}

namespace {

/// Appends `text` from `begin` to `end`. If that is longer than `longest`, its middle is left out: a quarter of what is
/// kept is its end.
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
    // Long enough for the longest name of a file (255 bytes on most systems), and for the list of all keys of the
    // plugin.
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

}  // namespace PIMG_ABI
}  // namespace pimg
