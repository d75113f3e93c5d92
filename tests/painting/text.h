// SPDX-License-Identifier: BSD-3-Clause
// What the tests of written files ask of a text.
#pragma once

#include <cstddef>
#include <string>

namespace pimg::test {

/// How often `word` stands in `text`.
inline std::size_t count_of(const std::string& word, const std::string& text)
{
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        ++count;
    return count;
}

}  // namespace pimg::test
