// SPDX-License-Identifier: BSD-3-Clause
#include "state/filter_stack.h"

#include <algorithm>
#include <cmath>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

namespace pimgview {

namespace {

using pimg::OptionInfo;
using pimg::OptionTexts;

auto find(const OptionTexts& texts, const OptionInfo& option)
{
    return std::find_if(texts.begin(), texts.end(), [&](const auto& text) { return option.is_called(text.first); });
}

bool binds(const StackItem& item)
{
    pimg::BoundFilter bound;
    std::string error;
    return item.filter->bind(item.texts, bound, error);
}

}  // namespace

std::string value_of(const OptionTexts& texts, const OptionInfo& option)
{
    const auto found = find(texts, option);
    return found == texts.end() ? option.default_value : found->second;
}

bool is_given(const OptionTexts& texts, const OptionInfo& option)
{
    return find(texts, option) != texts.end();
}

void set_value(OptionTexts& texts, const OptionInfo& option, const std::string& value)
{
    const auto found = find(texts, option);
    if (value == option.default_value) {
        if (found != texts.end())
            texts.erase(found);
    } else if (found != texts.end())
        texts[std::size_t(found - texts.begin())].second = value;
    else
        texts.emplace_back(option.key, value);
}

void set_value(StackItem& item, const OptionInfo& option, const std::string& value)
{
    set_value(item.texts, option, value);
    if (binds(item))
        return;
    for (const auto& [key, unused] : item.texts) {
        if (option.is_called(key))
            continue;
        StackItem without = item;
        for (const OptionInfo& other : item.filter->options())
            if (other.is_called(key))
                set_value(without.texts, other, other.default_value);
        if (binds(without)) {
            item = without;
            return;
        }
    }
}

OptionTexts for_looking(const StackItem& item, int factor)
{
    OptionTexts texts = item.texts;
    for (const OptionInfo& option : item.filter->options()) {
        if (option.file == pimg::FileUse::written)
            set_value(texts, option, option.default_value);
        const std::string value = value_of(item.texts, option);
        if (factor == 1 || (option.unit != "pixels" && option.unit != pimg::kPixelsOrShare) || value.empty())
            continue;
        const double smaller = pimg::resized_length(option, OIIO::Strutil::stod(value), 1.0 / factor);
        const double kept = std::max(option.min, smaller);
        set_value(texts, option, pimg::format("{}", option.type == "int" ? std::round(kept) : kept));
    }
    return texts;
}

bool write_strokes(FilterStack& stack, const std::string& filename, std::string& error)
{
    for (auto item = stack.items.rbegin(); item != stack.items.rend(); ++item)
        for (const OptionInfo& option : item->filter->options())
            if (item->on && option.file == pimg::FileUse::written) {
                set_value(*item, option, filename);
                return true;
            }
    error =
        pimg::format("\"{}\": expected a filter whose strokes can be written, such as paint, mosaic or ink", filename);
    return false;
}

SliderRange slider_range(const OptionInfo& option)
{
    // A slider cannot use a range that ends at the largest number. It then ends at ten times the default, or at least
    // at 100.
    constexpr double kWidest = 1000.0, kTimesDefault = 10.0, kLeastOpen = 100.0;
    const double preset = option.default_value.empty() ? 0.0 : OIIO::Strutil::stod(option.default_value);
    SliderRange range { option.min, option.max, false };
    if (option.min == option.max)
        range = { std::min(-1.0, -2.0 * std::fabs(preset)), std::max(1.0, 2.0 * std::fabs(preset)), false };
    else if (option.max > kWidest) {
        const double least = option.type == "int" && option.default_value.empty() ? 1e6 : kLeastOpen;
        range.high = std::max({ least, kTimesDefault * preset, kTimesDefault * std::max(option.min, 0.0) });
    }
    range.logarithmic = range.high > kTimesDefault * kTimesDefault / 2 && range.low >= 0.0;
    return range;
}

}  // namespace pimgview
