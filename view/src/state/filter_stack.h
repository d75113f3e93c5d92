// SPDX-License-Identifier: BSD-3-Clause
// The filters that a picture goes through, in order, each with the options that differ from their defaults.
#pragma once

#include <string>
#include <vector>

#include <pimg/filter_table.h>

namespace pimgview {

/// One filter of the registry.
struct StackItem {
    const pimg::Filter* filter = nullptr;
    pimg::OptionTexts texts;  ///< options given
    bool on = true;           ///< false: the picture passes as it is

    friend bool operator==(const StackItem& a, const StackItem& b)
    {
        return a.filter == b.filter && a.texts == b.texts && a.on == b.on;
    }
};

/// What makes the result from a file, and what undo brings back.
struct FilterStack {
    std::string part;         ///< of the file, by name or number; empty: the first that holds a picture
    pimg::OptionTexts build;  ///< options of BuildOptions given
    std::vector<StackItem> items;

    friend bool operator==(const FilterStack& a, const FilterStack& b)
    {
        return a.part == b.part && a.build == b.build && a.items == b.items;
    }
    friend bool operator!=(const FilterStack& a, const FilterStack& b) { return !(a == b); }
};

/// The value of an option: as given, else its default, which is empty for an option that is not set.
std::string value_of(const pimg::OptionTexts& texts, const pimg::OptionInfo& option);
bool is_given(const pimg::OptionTexts& texts, const pimg::OptionInfo& option);

/// Sets an option. If `value` is the default, or empty for an option that need not be set, the option is removed.
void set_value(pimg::OptionTexts& texts, const pimg::OptionInfo& option, const std::string& value);

/// As above. If the filter then refuses its options because another option says the same thing, that one is removed.
void set_value(StackItem& item, const pimg::OptionInfo& option, const std::string& value);

/// The options of a filter for looking at what it makes of a picture that is `factor` times smaller: lengths in pixels
/// shrink with it, within their ranges, and no files are written.
pimg::OptionTexts for_looking(const StackItem& item, int factor);

/// Makes the last filter that can, such as paint or ink, write its strokes to a file. False, with one line in `error`, if
/// none can.
bool write_strokes(FilterStack& stack, const std::string& filename, std::string& error);

/// The smallest and largest value that a slider should offer, and whether it should be logarithmic.
struct SliderRange {
    double low = 0.0, high = 1.0;
    bool logarithmic = false;
};
SliderRange slider_range(const pimg::OptionInfo& option);

}  // namespace pimgview
