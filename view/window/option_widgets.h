// SPDX-License-Identifier: BSD-3-Clause
// A widget for any option of any table: slider, check box, menu or text, with range, unit, default and help.
#pragma once

#include <string>
#include <vector>

#include <pimg/option_text.h>
#include <pimg/options.h>

namespace pimgview {

/// Whether the pointer has been on the last item for a while, without a button held: help that comes at once hides what is
/// beside it.
bool rests_on_item();

/// Draws the widget of an option that has `value`, which is empty if it is not set. True if the user changed it: `changed`
/// is then the new value. A double click, or the middle button, asks for the default.
bool option_widget(const pimg::OptionInfo& option, const std::string& value, std::string& changed);

/// All options of a table but those named in `hidden`. True if one was changed: `key` is that one.
bool option_widgets(const std::vector<pimg::OptionInfo>& options, const pimg::OptionTexts& texts,
                    const std::vector<std::string>& hidden, const pimg::OptionInfo** which, std::string& changed);

}  // namespace pimgview
