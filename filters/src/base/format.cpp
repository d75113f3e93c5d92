// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/format.h>

#include <algorithm>

namespace pimg {

std::string format_packed(fmt::string_view pattern, fmt::format_args arguments)
{
    return fmt::vformat(pattern, arguments);
}

std::string with_words_shortened(const std::string& message)
{
    // The longest path most systems have for one name fits.
    constexpr std::size_t kLongest = 300, kBegin = 200, kEnd = 80;
    std::string result;
    for (std::size_t at = 0; at < message.size();) {
        const std::size_t end = std::min(message.find(' ', at), message.size());
        if (end - at <= kLongest)
            result.append(message, at, end - at);
        else
            result.append(message, at, kBegin).append("...").append(message, end - kEnd, kEnd);
        at = end;
        if (at < message.size())
            result += message[at++];
    }
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
