// SPDX-License-Identifier: BSD-3-Clause
#include "option_widgets.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <imgui.h>
#include <imgui_stdlib.h>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

#include "state/filter_stack.h"

namespace pimgview {

namespace {

using pimg::format;
using pimg::OptionInfo;

std::string label_of(const OptionInfo& option)
{
    return option.unit.empty() || option.unit == option.key ? option.key : format("{} ({})", option.key, option.unit);
}

void tooltip(const OptionInfo& option)
{
    if (!rests_on_item())
        return;
    std::string text = option.help;
    if (!option.range.empty())
        text += format("\n{}{}{}", option.range, option.unit.empty() ? "" : " ", option.unit);
    if (!option.choices.empty())
        text += "\n" + option.choices;
    text += option.default_value.empty() ? "\nnot set by default" : "\ndefault " + option.default_value;
    text += "\ndouble click: default; Ctrl+click: type a value";
    ImGui::SetTooltip("%s", text.c_str());
}

/// Four digits of what was dragged, and more of what was typed.
std::string number_text(double number, bool whole)
{
    char text[32];
    std::snprintf(text, sizeof text, whole ? "%.0f" : ImGui::GetIO().WantTextInput ? "%.9g" : "%.4g", number);
    return text;
}

bool slider(const OptionInfo& option, const std::string& value, std::string& changed)
{
    const SliderRange range = slider_range(option);
    const bool whole = option.type == "int";
    double number = value.empty() ? std::max(range.low, 0.0) : OIIO::Strutil::stod(value);
    // Four digits, so that a logarithmic slider can show its small values; whole numbers without a fraction.
    const bool is_found = number == 0.0 && option.help.find("0: found") != option.help.npos;
    const char* shown = value.empty() ? "not set" : is_found ? "found" : whole ? "%.0f" : "%.4g";
    const ImGuiSliderFlags flags =
        (range.logarithmic ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_NoRoundToFormat;
    const std::string label = label_of(option);
    if (!ImGui::SliderScalar(label.c_str(), ImGuiDataType_Double, &number, &range.low, &range.high, shown, flags))
        return false;
    if (option.min != option.max)
        number = std::clamp(number, option.min, option.max);
    changed = number_text(number, whole);
    return std::isfinite(number);
}

bool menu(const OptionInfo& option, const std::string& value, std::string& changed)
{
    bool chosen = false;
    if (!ImGui::BeginCombo(label_of(option).c_str(), value.empty() ? "(found)" : value.c_str()))
        return false;
    for (const std::string& word : OIIO::Strutil::splits(option.choices, "|"))
        if (ImGui::Selectable(word.c_str(), word == value)) {
            changed = word;
            chosen = true;
        }
    ImGui::EndCombo();
    return chosen;
}

/// A field whose text counts when the user leaves it, and not at every letter, since half a word is seldom a value.
bool text_field(const OptionInfo& option, const std::string& value, std::string& changed)
{
    std::string text = value;
    ImGui::InputTextWithHint(label_of(option).c_str(), option.default_value.c_str(), &text);
    if (!ImGui::IsItemDeactivatedAfterEdit())
        return false;
    changed = text;
    return true;
}

}  // namespace

bool rests_on_item()
{
    constexpr double kWhile = 0.5;  // seconds
    static ImVec2 place;
    static double since = 0.0;
    const ImGuiIO& io = ImGui::GetIO();
    if (io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f || ImGui::IsAnyMouseDown() || io.MouseWheel != 0.0f) {
        place = io.MousePos;
        since = ImGui::GetTime();
    }
    return ImGui::IsItemHovered() && place.x == io.MousePos.x && place.y == io.MousePos.y
        && ImGui::GetTime() - since > kWhile;
}

bool option_widget(const OptionInfo& option, const std::string& value, std::string& changed)
{
    bool touched = false;
    if (option.type == "flag") {
        bool on = value == "1" || value == "true" || value == "on" || value == "yes";
        touched = ImGui::Checkbox(label_of(option).c_str(), &on);
        changed = on ? "1" : "0";
    } else if (!option.choices.empty())
        touched = menu(option, value, changed);
    else if (option.type == "int" || option.type == "float")
        touched = slider(option, value, changed);
    else
        touched = text_field(option, value, changed);
    tooltip(option);
    const bool number = option.type == "int" || option.type == "float";
    const bool twice = number && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    // A slider that was reset would follow the pointer again while the button is still down.
    static ImGuiID held = 0;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left))
        held = 0;
    if (held == ImGui::GetID(option.key.c_str()))
        return false;
    if (ImGui::IsItemHovered() && (twice || ImGui::IsMouseClicked(ImGuiMouseButton_Middle))) {
        held = twice ? ImGui::GetID(option.key.c_str()) : 0;
        changed = option.default_value;
        touched = true;
    }
    return touched;
}

bool option_widgets(const std::vector<OptionInfo>& options, const pimg::OptionTexts& texts,
                    const std::vector<std::string>& hidden, const OptionInfo** which, std::string& changed)
{
    bool touched = false;
    for (const OptionInfo& option : options) {
        if (std::count(hidden.begin(), hidden.end(), option.key) > 0)
            continue;
        std::string value;
        const bool given = is_given(texts, option);
        if (given)
            ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_PlotHistogramHovered));
        const bool now = option_widget(option, value_of(texts, option), value);
        if (given)
            ImGui::PopStyleColor();
        if (now) {
            *which = &option;
            changed = value;
            touched = true;
        }
    }
    return touched;
}

}  // namespace pimgview
