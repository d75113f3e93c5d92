// SPDX-License-Identifier: BSD-3-Clause
// Options in one line of text, as the command line, the query of a file's name and C give them: `key=value:key=value`.
//
// Separator  A colon, or in the query of a file's name an ampersand. A colon before a digit belongs to the value, as in
//            curve=0:1,1:3, for no key begins with a digit.
// Quotes     A value that begins with " or ' ends at the next such mark, and may hold anything: path="C:\a:b.svg". The
//            mark itself is written twice: 'it''s'. Inside a value that does not begin with one, marks are ordinary.
// Spaces     and backslashes mean themselves. A value may be empty; a key may not, nor may an item between separators.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pimg {

/// Options as given: pairs of key and value.
using OptionTexts = std::vector<std::pair<std::string, std::string>>;

/// Appends the options in `text` to `texts`; empty text holds none. False, with a one-line message naming the item or its
/// key, for what does not follow the rules above; `texts` then ends with the option before it.
bool split_options(std::string_view text, OptionTexts& texts, std::string& error, char separator = ':');

}  // namespace pimg
