// SPDX-License-Identifier: BSD-3-Clause
// The text of options, as the command line, a file's query, Python and C give it: every filter's options are parsed,
// checked and bound. The first line says which filter; an unknown one is asked for by name.
#include <cstdint>
#include <string>

#include <pimg/detail/format.h>
#include <pimg/filter_table.h>

#include "taken.h"

using namespace pimg;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Taken in(data, size);
    std::string error;
    const Filter* filter = find_filter(in.text('\n'), error);
    if (!filter) {
        must_be_message(one_line(error));
        error.clear();
        filter = &filter_table()[size % filter_table().size()];
    }
    const std::string text = in.text('\0');
    OptionTexts texts;
    if (!split_options(text, texts, error, size % 2 ? ':' : '&')) {
        must_be_message(one_line(error));
        return 0;
    }
    BoundFilter bound;
    if (!filter->bind(texts, bound, error))
        must_be_message(one_line(error));
    else
        must(bool(bound.run));
    return 0;
}
