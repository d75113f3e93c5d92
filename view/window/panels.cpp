// SPDX-License-Identifier: BSD-3-Clause
#include "panels.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/sysutil.h>

#include <pimg/detail/format.h>

#include "option_widgets.h"
#include "state/command_line.h"
#include "state/file_list.h"

namespace pimgview {

namespace {

using pimg::format;
using pimg::OptionInfo;

constexpr double kBaseVertices = 70.0;  // about those of a base mesh, which has 128 faces

/// A header whose contents are drawn; open at first if `open`.
bool section(const char* title, bool open)
{
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

std::string megabytes(std::size_t bytes)
{
    return format("{:.0f} MB", double(bytes) / 1e6);
}

std::string stops(double luminance)
{
    return luminance > 0.0 ? format("{:+.2f} stops", std::log2(luminance)) : std::string("no light");
}

std::string samples_text(const PixelValue& value)
{
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(value.samples.size(), 4); ++i)
        text += format("{}{:.4g}", i == 0 ? "" : " ", value.samples[i]);
    return text;
}

/// A row of a list. All of its name is shown, where the label of a Selectable would end at ##.
bool name_row(int row, const std::string& name, bool chosen)
{
    ImGui::PushID(row);
    const bool clicked = ImGui::Selectable("##row", chosen);
    ImGui::SameLine(0.0f, 0.0f);
    ImGui::TextUnformatted(name.c_str());
    ImGui::PopID();
    return clicked;
}

/// A list of names to choose from, and that the program finds one itself, which is the empty name. Whether it changed.
bool chooser(const char* title, const std::vector<std::string>& names, std::string& chosen)
{
    const std::string before = chosen;
    if (!ImGui::BeginCombo(title, chosen.empty() ? "found" : chosen.c_str()))
        return false;
    if (ImGui::Selectable("found", chosen.empty()))
        chosen.clear();
    for (std::size_t i = 0; i < names.size(); ++i)
        if (name_row(int(i), names[i], names[i] == chosen))
            chosen = names[i];
    ImGui::EndCombo();
    return chosen != before;
}

/// The look as texts of options, so that it can have the same widgets as filters.
pimg::OptionTexts texts_of(const LookOptions& look)
{
    pimg::OptionTexts texts;
    const std::string argument = look_argument(look);
    std::string error;
    const std::size_t colon = argument.find(':');
    if (colon != argument.npos)
        pimg::split_options(std::string_view(argument).substr(colon + 1), texts, error);
    return texts;
}

}  // namespace

void Panels::draw(Workbench& bench, const ViewInfo& info, float scale)
{
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    if (bench.look.panels) {
        ImGui::SetNextWindowPos({ 0, 0 });
        ImGui::SetNextWindowSize({ float(kWidth) * scale, display.y - float(kStatusHeight) * scale });
        ImGui::Begin("Panels", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
        ImGui::PushItemWidth(float(kWidth) * 0.44f * scale);
        scopes(bench);
        files(bench);
        filters(bench);
        look(bench);
        presets(bench);
        save(bench);
        ImGui::PopItemWidth();
        ImGui::End();
        status(bench, info, scale);
    }
    if (bench.sheet)
        sheet(bench);
}

void Panels::files(Workbench& bench)
{
    if (bench.opening)
        ImGui::SetNextItemOpen(true);
    if (!section("Files", true))
        return;
    if (bench.files.size() > 1) {
        int frame = bench.index + 1;
        const int frames = int(bench.files.size());
        if (ImGui::SliderInt("file or frame", &frame, 1, frames, format("%d of {}", frames).c_str()))
            bench.go_to(frame - 1);
        ImGui::Checkbox("play", &bench.playing);
    }
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const float rows = float(std::min<std::size_t>(bench.files.size(), 5));
    if (ImGui::BeginListBox("##files", { -1, line * std::max(1.0f, rows) + 6 })) {
        for (int i = 0; i < int(bench.files.size()); ++i)
            if (name_row(i, OIIO::Filesystem::filename(bench.files[std::size_t(i)]), i == bench.index))
                bench.go_to(i);
        ImGui::EndListBox();
    }
    parts_and_layers(bench);
    if (ImGui::Button(bench.opening ? "Close the browser" : "Open ..."))
        bench.opening = !bench.opening;
    if (bench.opening)
        browser(bench);
}

void Panels::parts_and_layers(Workbench& bench)
{
    const DocumentState document = bench.studio.document().state();
    if (document.parts.size() > 1)
        chooser("part", document.parts, bench.stack.part);
    if (document.layers.empty())
        return;
    for (const OptionInfo& option : pimg::describe_options<pimg::BuildOptions>()) {
        std::string layer = value_of(bench.stack.build, option);
        if (std::string_view(option.key) == "layer" && chooser("layer", document.layers, layer))
            set_value(bench.stack.build, option, layer);
    }
}

void Panels::browser(Workbench& bench)
{
    if (m_folder.empty())
        go_to_folder(bench.settings["folder"].empty() ? "." : bench.settings["folder"]);
    if (ImGui::InputText("folder", &m_folder, ImGuiInputTextFlags_EnterReturnsTrue)) {
        if (OIIO::Filesystem::is_directory(m_folder))
            go_to_folder(m_folder);
        else
            bench.open({ m_folder });
    }
    if (!ImGui::BeginListBox("##browser", { -1, 10 * ImGui::GetTextLineHeightWithSpacing() }))
        return;
    std::string next;
    if (ImGui::Selectable("../"))
        next = m_folder + "/..";
    for (std::size_t i = 0; i < m_entries.size(); ++i)
        if (name_row(int(i), m_entries[i], false)) {
            const std::string path = (std::filesystem::path(m_folder) / m_entries[i]).string();
            if (path.back() == '/')
                next = path;
            else
                bench.open({ path });
        }
    ImGui::EndListBox();
    if (!next.empty())
        go_to_folder(next);
}

/// Shows a folder by its full name, without the .. that led there.
void Panels::go_to_folder(const std::string& folder)
{
    std::error_code unknown;
    const std::filesystem::path path = std::filesystem::canonical(folder, unknown);
    m_folder = unknown ? folder : path.string();
    m_entries = list_folder(m_folder);
}

void Panels::filters(Workbench& bench)
{
    if (!section("Filters", true))
        return;
    level_slider(bench);
    for (std::size_t i = 0; i < bench.stack.items.size(); ++i) {
        ImGui::PushID(int(i));
        const bool removed = filter(bench, i);
        ImGui::PopID();
        if (removed) {
            bench.stack.items.erase(bench.stack.items.begin() + std::ptrdiff_t(i));
            break;
        }
    }
    move_filter(bench.stack.items);
    add_filter(bench.stack.items);
    if (ImGui::TreeNode("Building the progressive image")) {
        const OptionInfo* which = nullptr;
        std::string value;
        const std::vector<OptionInfo> infos = pimg::describe_options<pimg::BuildOptions>();
        if (option_widgets(infos, bench.stack.build, {}, &which, value))
            set_value(bench.stack.build, *which, value);
        ImGui::TreePop();
    }
}

/// All filters with what they do, so that nobody needs to know their names.
void Panels::add_filter(std::vector<StackItem>& items)
{
    constexpr float kWidest = 48.0f;  // in letters' heights
    ImGui::SetNextWindowSizeConstraints({ kWidest * ImGui::GetFontSize(), 0 }, { FLT_MAX, FLT_MAX });
    if (!ImGui::BeginCombo("##add", "Add a filter ...", ImGuiComboFlags_HeightLargest))
        return;
    for (const pimg::Filter& row : pimg::filter_table())
        if (ImGui::Selectable(format("{:<17}{}", row.name, row.summary).c_str()))
            items.push_back({ &row, {}, true });
    ImGui::EndCombo();
}

void Panels::move_filter(std::vector<StackItem>& items)
{
    const auto [from, to] = std::exchange(m_moved, { 0, 0 });
    if (from >= items.size() || to >= items.size())
        return;
    const auto begin = items.begin();
    if (from < to)
        std::rotate(begin + std::ptrdiff_t(from), begin + std::ptrdiff_t(from) + 1, begin + std::ptrdiff_t(to) + 1);
    else
        std::rotate(begin + std::ptrdiff_t(to), begin + std::ptrdiff_t(from), begin + std::ptrdiff_t(from) + 1);
}

/// The title of a filter that was just drawn can be dragged to that of another, whose place it takes.
void Panels::drag_filter(Workbench& bench, std::size_t index)
{
    constexpr const char* kKind = "filter";
    std::vector<StackItem>& items = bench.stack.items;
    if (ImGui::BeginDragDropSource()) {
        ImGui::SetDragDropPayload(kKind, &index, sizeof index);
        ImGui::TextUnformatted(items[index].filter->name);
        ImGui::EndDragDropSource();
    }
    if (!ImGui::BeginDragDropTarget())
        return;
    if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(kKind)) {
        std::size_t from = 0;
        std::memcpy(&from, payload->Data, sizeof from);
        m_moved = { from, index };
    }
    ImGui::EndDragDropTarget();
}

bool Panels::filter(Workbench& bench, std::size_t index)
{
    StackItem& item = bench.stack.items[index];
    ImGui::Checkbox("##on", &item.on);
    ImGui::SameLine();
    const bool removed = ImGui::SmallButton("x");
    if (rests_on_item())
        ImGui::SetTooltip("takes the filter out");
    ImGui::SameLine();
    const bool open = ImGui::TreeNodeEx(item.filter->name, ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_Framed);
    if (rests_on_item() && !ImGui::IsItemActive())
        ImGui::SetTooltip("%s\ndrag it onto another filter, whose place it takes", item.filter->summary);
    drag_filter(bench, index);
    if (!open)
        return removed;
    const OptionInfo* which = nullptr;
    std::string value;
    StackItem& now = bench.stack.items[index];
    const std::vector<OptionInfo> infos = now.filter->options();
    if (option_widgets(infos, now.texts, {}, &which, value))
        set_value(now, *which, value);
    ImGui::TreePop();
    return removed;
}

/// A slider from the base mesh to all pixels. It sets the number of vertices of the filter `level`, which becomes the
/// last filter if there is none yet.
void Panels::level_slider(Workbench& bench)
{
    const DocumentState document = bench.studio.document().state();
    if (!document.has_picture())
        return;
    std::string error;
    const pimg::Filter* level = pimg::find_filter("level", error);
    if (level == nullptr)
        return;
    const auto is_level = [&](const StackItem& item) {
        return item.filter == level && item.on;
    };
    const auto found = std::find_if(bench.stack.items.begin(), bench.stack.items.end(), is_level);
    const double low = kBaseVertices, high = double(document.width) * document.height;
    double vertices = high;
    const auto infos = level->options();
    const auto option =
        std::find_if(infos.begin(), infos.end(), [](const OptionInfo& i) { return i.key == "vertices"; });
    if (option == infos.end())
        return;
    if (found != bench.stack.items.end() && is_given(found->texts, *option))
        vertices = std::stod(value_of(found->texts, *option));
    if (!ImGui::SliderScalar("level (vertices)", ImGuiDataType_Double, &vertices, &low, &high, "%.0f",
                             ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat))
        return;
    if (vertices >= 0.999 * high) {
        if (found != bench.stack.items.end())
            bench.stack.items.erase(found);
        return;
    }
    const std::string value = format("{:.0f}", vertices);
    if (found != bench.stack.items.end())
        return set_value(*found, *option, value);
    bench.stack.items.push_back({ level, {}, true });  // last, so that nothing follows that must be done again
    set_value(bench.stack.items.back(), *option, value);
}

void Panels::look(Workbench& bench)
{
    if (!section("Look", false))
        return;
    const OptionInfo* which = nullptr;
    std::string value, error;
    const std::vector<OptionInfo> infos = pimg::describe_options<LookOptions>();
    if (!m_displays.displays.empty()
        && ImGui::BeginCombo("display and view", bench.look.display.empty() ? "sRGB" : bench.look.transform.c_str())) {
        if (ImGui::Selectable("sRGB, as pimgtool writes"))
            bench.look.display = bench.look.transform = "";
        for (std::size_t d = 0; d < m_displays.displays.size(); ++d)
            for (const std::string& view : m_displays.views[d])
                if (ImGui::Selectable((m_displays.displays[d] + ": " + view).c_str())) {
                    bench.look.display = m_displays.displays[d];
                    bench.look.transform = view;
                }
        ImGui::EndCombo();
    }
    const DocumentState document = bench.studio.document().state();
    double mesh = bench.look.mesh;
    const double none = 0.0, all = std::max(kBaseVertices, double(document.width) * document.height);
    if (ImGui::SliderScalar("mesh (vertices)", ImGuiDataType_Double, &mesh, &none, &all, mesh < 1 ? "none" : "%.0f",
                            ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat))
        bench.look.mesh = int(std::clamp(mesh, 0.0, 2147483647.0));
    if (option_widgets(infos, texts_of(bench.look), { "x", "y", "display", "transform", "mesh" }, &which, value))
        pimg::set_option(bench.look, which->key, value.empty() ? "0" : value, error);
}

/// Both histograms in one plot, the source filled and the result as a line, over a scale in stops.
void Panels::histogram(const Shown& shown, float width)
{
    const float height = 6.0f * ImGui::GetFontSize();
    constexpr int kTick = 4;  // stops
    const auto& result = shown.histogram.bins;
    const auto& source = shown.source_histogram.bins;
    const float most = std::max(
        { 1e-6f, *std::max_element(result.begin(), result.end()), *std::max_element(source.begin(), source.end()) });
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float bottom = corner.y + height, cell = width / float(Histogram::kBins);
    const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text), faint = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(corner, { corner.x + width, bottom }, ImGui::GetColorU32(ImGuiCol_FrameBg));
    for (int stop = Histogram::kLeast; stop <= Histogram::kMost; stop += kTick) {
        const float x = corner.x + float((stop - Histogram::kLeast) * Histogram::kBinsPerStop) * cell;
        draw->AddLine({ x, corner.y }, { x, bottom }, stop == 0 ? ink : ImGui::GetColorU32(ImGuiCol_Border));
        draw->AddText({ std::min(x + 2, corner.x + width - 2.0f * ImGui::GetFontSize()), bottom }, faint,
                      (stop == 0 ? std::string("0") : format("{:+d}", stop)).c_str());
    }
    std::vector<ImVec2> line;
    for (int i = 0; i < Histogram::kBins; ++i) {
        const auto top = [&](float share) {
            return bottom - height * share / most;
        };
        const float x = corner.x + float(i) * cell;
        draw->AddRectFilled({ x, top(source[std::size_t(i)]) }, { x + cell, bottom }, faint);
        line.push_back({ x, top(result[std::size_t(i)]) });
        line.push_back({ x + cell, top(result[std::size_t(i)]) });
    }
    draw->AddPolyline(line.data(), int(line.size()), ImGui::GetColorU32(ImGuiCol_PlotHistogram), 0, 1.5f);
    ImGui::Dummy({ width, height + ImGui::GetTextLineHeight() });
    ImGui::TextDisabled("stops around 1: source filled, result as a line");
}

void Panels::scopes(const Workbench& bench)
{
    const std::shared_ptr<const Shown> shown = bench.studio.shown();
    if (!(bench.look.histogram || bench.look.waveform) || !shown || !shown->has_scopes)
        return;
    const float width = ImGui::GetContentRegionAvail().x;
    if (bench.look.histogram)
        histogram(*shown, width);
    if (!bench.look.waveform)
        return;
    const Waveform& waveform = shown->waveform;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float cell = width / float(waveform.columns), row = std::round(ImGui::GetFontSize() / 6.0f);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(corner, { corner.x + width, corner.y + row * Waveform::kRows }, IM_COL32(0, 0, 0, 255));
    for (int y = 0; y < Waveform::kRows; ++y)
        for (int x = 0; x < waveform.columns; ++x) {
            const float share = waveform.shares[std::size_t(y) * std::size_t(waveform.columns) + std::size_t(x)];
            if (share <= 0.0f)
                continue;
            const ImVec2 at { corner.x + float(x) * cell, corner.y + float(y) * row };
            draw->AddRectFilled(at, { at.x + cell, at.y + row },
                                IM_COL32(120, 255, 120, int(255.0f * std::sqrt(share))));
        }
    ImGui::Dummy({ width, row * Waveform::kRows });
}

void Panels::presets(Workbench& bench)
{
    if (!section("Presets", false))
        return;
    const auto last = bench.settings.find("last");
    if (last != bench.settings.end() && ImGui::Selectable("(as last time)"))
        bench.apply(last->second);
    const std::vector<std::string> names = preset_names();
    for (std::size_t i = 0; i < names.size(); ++i)
        if (name_row(int(i), names[i], false))
            bench.apply(read_preset(names[i]));
    ImGui::InputTextWithHint("##name", "name", &m_preset);
    ImGui::SameLine();
    if (ImGui::Button("Keep as a preset"))
        bench.save_preset(m_preset);
    if (ImGui::InputTextWithHint("##paste", "paste a command line, Enter", &m_pasted,
                                 ImGuiInputTextFlags_EnterReturnsTrue))
        bench.apply(m_pasted);
}

void Panels::save(Workbench& bench)
{
    const bool asked = std::exchange(bench.saving, false);
    if (asked)
        ImGui::SetNextItemOpen(true);
    if (!section("Save", false))
        return;
    if (asked)
        ImGui::SetKeyboardFocusHere();
    const bool entered =
        ImGui::InputTextWithHint("##file", "out.png, out.exr, out.pimg, out.svg ...", &bench.save_name,
                                 ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    ImGui::SameLine();
    const bool replaces = !bench.save_name.empty() && OIIO::Filesystem::exists(bench.save_name);
    const bool clicked = ImGui::Button(replaces ? "Replace" : "Save");
    if ((clicked || entered) && !bench.save_name.empty() && !bench.studio.saving().busy)
        bench.save(clicked);
    ImGui::TextWrapped("The extension chooses the format: of a picture, .pimg, or .svg and .json for strokes.");
}

void Panels::status(Workbench& bench, const ViewInfo& info, float scale)
{
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({ 0, display.y - float(kStatusHeight) * scale });
    ImGui::SetNextWindowSize({ display.x, float(kStatusHeight) * scale });
    ImGui::Begin("Status", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove
                     | ImGuiWindowFlags_NoScrollbar);
    command_line(bench);
    const DocumentState document = bench.studio.document().state();
    const SaveState saving = bench.studio.saving();
    if (!document.activity.empty()) {
        ImGui::ProgressBar(document.progress, { 160 * scale, 0 }, document.activity.c_str());
        ImGui::SameLine();
    }
    // First what is always there, so that nothing longer pushes it out of the window.
    ImGui::TextUnformatted(format("{}{}  ", document.has_picture() ? format("{:.0f} %  ", 100.0 * info.zoom) : "",
                                  megabytes(bench.studio.memory() + info.texture_memory))
                               .c_str());
    ImGui::SameLine();
    std::string problem = !document.error.empty() ? document.error : bench.studio.error();
    if (problem.empty() && saving.failed)
        problem = saving.text;
    if (!problem.empty()) {
        ImGui::TextColored({ 1.0f, 0.35f, 0.3f, 1.0f }, "%s", problem.c_str());
        ImGui::SameLine();
    }
    std::string text = bench.message + (bench.message.empty() ? "" : "   ");
    text += saving.failed || saving.text.empty() ? "" : saving.text + "   ";
    if (info.has_pixel && problem.empty())
        text += format("({}, {})  source {} = {}   result {} = {}, codes {} {} {}", info.x, info.y,
                       samples_text(info.source), stops(info.source.luminance), samples_text(info.result),
                       stops(info.result.luminance), info.result.codes[0], info.result.codes[1], info.result.codes[2]);
    ImGui::TextUnformatted(text.c_str());
    ImGui::End();
}

/// The line that makes what is seen, with a button that copies it as the key does.
void Panels::command_line(Workbench& bench)
{
    const std::string line = bench.line();
    if (bench.copied || ImGui::SmallButton("Copy")) {
        ImGui::SetClipboardText(line.c_str());
        bench.message = "copied the command line";
        bench.copied = false;
    }
    ImGui::SameLine();
    ImGui::TextUnformatted(line.c_str());
}

void Panels::sheet(Workbench& bench)
{
    ImGui::SetNextWindowPos({ ImGui::GetIO().DisplaySize.x / 2, ImGui::GetIO().DisplaySize.y / 2 }, ImGuiCond_Always,
                            { 0.5f, 0.5f });
    ImGui::Begin("Keys", &bench.sheet, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize);
    for (const Key& key : key_table()) {
        if (*key.name == '\0')
            continue;
        ImGui::TextUnformatted(key.name);
        ImGui::SameLine(9.0f * ImGui::GetFontSize());
        ImGui::TextUnformatted(key.help);
    }
    ImGui::End();
}

}  // namespace pimgview
