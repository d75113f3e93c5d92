// SPDX-License-Identifier: BSD-3-Clause
// Options in one line of text, `key=value:key=value`, as they are given on the command line, in the query of a file's name
// (`a.pimg?key=value&key=value`) and in C. The rules are:
//
// Separator  A colon; in the query of a file's name an ampersand. A colon before a digit, sign or point belongs to the value,
//            as in curve=0:1,1:3, because no key begins with one of these.
// Quotes     A value that begins with " or ' ends at the next such mark, and may hold anything: path="C:\a:b.svg". The
//            mark itself is written twice: 'it''s'. Inside a value that does not begin with one, marks are ordinary.
// Other      Spaces and backslashes have no special meaning. A value may be empty. A key, and an item between two
//            separators, may not.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Options as given: pairs of key and value.
using OptionTexts = std::vector<std::pair<std::string, std::string>>;

/// Appends the options in `text` to `texts`. An empty text holds none. If an item does not follow the rules above, returns
/// false with one line in `error` that names the item or its key; `texts` then ends with the option before it.
PIMG_EXPORT bool split_options(std::string_view text, OptionTexts& texts, std::string& error, char separator = ':');

}  // namespace PIMG_ABI
}  // namespace pimg
