// SPDX-License-Identifier: BSD-3-Clause
#include "workbench.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <pimg/detail/format.h>

#include "state/file_list.h"

namespace pimgview {

namespace {

/// Undo does not change zoom and place, which would draw the eye away from what changes in the picture.
Snapshot without_place(Snapshot snapshot)
{
    const LookOptions none;
    snapshot.look.zoom = none.zoom;
    snapshot.look.x = none.x;
    snapshot.look.y = none.y;
    return snapshot;
}

std::string settings_file()
{
    return config_folder().empty() ? "" : config_folder() + "/pimgview";
}

}  // namespace

Workbench::Workbench(const Arguments& arguments, std::function<void()> changed)
    : studio(std::move(changed)),
      stack(arguments.script.stack),
      look(arguments.script.look),
      save_name(arguments.script.output),
      m_history(without_place({ arguments.script.stack, arguments.script.look }))
{
    if (arguments.screenshot.empty() && arguments.measured.empty() && arguments.random_events == 0)
        settings = read_settings(settings_file());
    if (!arguments.script.has_look && settings.count("look") > 0) {
        const std::string line = settings["look"];
        apply(line);
    }
    open(arguments.files);
}

void Workbench::open(const std::vector<std::string>& given)
{
    if (given.empty())
        return;
    files = expand_files(given);
    if (index >= 0)
        stack.part.clear();  // the parts of another file have other names
    index = -1;
    go_to(0);
    std::error_code unknown;  // the present folder may have vanished
    const std::filesystem::path first = std::filesystem::absolute(files[0], unknown);
    if (!unknown)
        settings["folder"] = first.parent_path().string();
}

void Workbench::go_to(int next)
{
    if (files.empty())
        return;
    next = std::clamp(next, 0, int(files.size()) - 1);
    if (next == index)
        return;
    index = next;
    message.clear();
    studio.forget_saved();
    open_document();
}

void Workbench::open_document()
{
    m_built = stack.build;
    m_part = stack.part;
    studio.document().open(files[std::size_t(index)], stack.part, stack.build);
}

void Workbench::update(const Region& visible, double scale, bool dragging)
{
    if (m_part != stack.part && index >= 0)
        open_document();
    if (m_built != stack.build && !dragging) {
        m_built = stack.build;
        studio.document().rebuild(stack.build);
    }
    Wanted wanted;
    wanted.stack = stack;
    wanted.visible = visible;
    wanted.scale = scale;
    wanted.dragging = dragging;
    wanted.source = look.show != "result";
    wanted.mesh = pimg::Index(look.mesh);
    wanted.pieces = look.piece;
    wanted.playing = playing;
    wanted.scopes = look.histogram || look.waveform;
    studio.want(wanted);
    const std::shared_ptr<const Shown> shown = studio.shown();
    // A frame is left when a picture of it has been seen with its filters, or nothing more can be seen of it.
    if (playing && ((shown != m_last_played && studio.has_current()) || studio.settled())) {
        m_last_played = shown;
        go_to(index + 1 < int(files.size()) ? index + 1 : 0);
    }
}

void Workbench::record()
{
    m_history.record(without_place({ stack, look }));
}

void Workbench::restore(const Snapshot& snapshot)
{
    const LookOptions place = look;
    stack = snapshot.stack;
    look = snapshot.look;
    look.zoom = place.zoom;
    look.x = place.x;
    look.y = place.y;
}

void Workbench::act_on_look(Action action)
{
    constexpr float kStops = 0.5f, kGammaStep = 1.1f;
    constexpr int kUsualMesh = 2000;  // vertices: enough to show what a mesh is, in a picture of any size
    static const std::pair<Action, bool LookOptions::*> switches[] = {
        { Action::clipped, &LookOptions::clipped },   { Action::histogram, &LookOptions::histogram },
        { Action::waveform, &LookOptions::waveform }, { Action::piece, &LookOptions::piece },
        { Action::panels, &LookOptions::panels },     { Action::theme, &LookOptions::light },
    };
    static const std::pair<Action, const char*> shows[] = { { Action::source, "source" },
                                                            { Action::split, "split" },
                                                            { Action::difference, "difference" } };
    for (const auto& [key, member] : switches)
        if (key == action)
            look.*member = !(look.*member);
    for (const auto& [key, word] : shows)
        if (key == action)
            look.show = look.show == word ? "result" : word;
    if (action == Action::brighter || action == Action::darker)
        look.exposure = std::clamp(look.exposure + (action == Action::brighter ? kStops : -kStops), -16.0f, 16.0f);
    if (action == Action::more_gamma || action == Action::less_gamma)
        look.gamma = std::clamp(look.gamma * (action == Action::more_gamma ? kGammaStep : 1 / kGammaStep), 0.2f, 5.0f);
    if (action == Action::mesh)
        look.mesh = look.mesh > 0 ? 0 : kUsualMesh;
    if (action == Action::plain_look) {
        const LookOptions plain;
        look.exposure = plain.exposure;
        look.gamma = plain.gamma;
        look.clipped = plain.clipped;
    }
}

void Workbench::act(Action action)
{
    message.clear();  // what was said about the key before
    studio.forget_saved();
    const std::pair<Action, bool*> switches[] = { { Action::open, &opening },
                                                  { Action::save, &saving },
                                                  { Action::sheet, &sheet } };
    for (const auto& [key, flag] : switches)
        if (key == action)
            *flag = !*flag;
    if (action == Action::undo)
        restore(m_history.undo());
    if (action == Action::redo)
        restore(m_history.redo());
    if (action == Action::next || action == Action::previous)
        go_to(index + (action == Action::next ? 1 : -1));
    if (action == Action::play)
        playing = !playing && files.size() > 1;
    copied = copied || action == Action::copy;
    quit = quit || action == Action::quit;
    act_on_look(action);
}

std::string Workbench::line() const
{
    const std::string file = index >= 0 ? files[std::size_t(index)] : "";
    return shell_line(file, stack, save_name.empty() ? "out.png" : save_name);
}

bool Workbench::apply(const std::string& line)
{
    std::vector<std::string> words;
    Script script;
    if (!split_words(line, words, message) || !parse_script(words, script, message))
        return false;
    if (script.has_stack)
        stack = script.stack;
    if (script.has_look)
        look = script.look;
    if (!script.files.empty())
        open(script.files);
    return true;
}

void Workbench::replace(const Script& script)
{
    stack = script.stack;
    look = script.look;
    save_name = script.output;
    if (!script.files.empty())
        open(script.files);
}

void Workbench::save(bool replace)
{
    std::error_code missing;  // then the names are of different files
    message.clear();
    studio.forget_saved();
    if (index < 0)
        message = "nothing to save: expected an open picture";
    else if (std::filesystem::equivalent(save_name, files[std::size_t(index)], missing))
        message = pimg::format("\"{}\" is the picture that is open: expected another name", save_name);
    else if (!replace && m_written.count(save_name) == 0 && std::filesystem::exists(save_name, missing))
        message = pimg::format("\"{}\" is there already: the button Replace writes over it", save_name);
    else {
        m_written.insert(save_name);
        studio.save(stack, save_name);
    }
}

void Workbench::save_preset(const std::string& name)
{
    if (write_preset(name, shell_line("", stack, ""), message))
        message = pimg::format("saved the preset \"{}\" in {}", name, preset_folder());
}

void Workbench::remember() const
{
    Settings all = settings;
    LookOptions kept;
    kept.light = look.light;
    kept.panels = look.panels;
    kept.display = look.display;
    kept.transform = look.transform;
    all["look"] = look_argument(kept);
    if (!stack.items.empty())
        all["last"] = shell_line("", stack, "");
    if (!settings_file().empty())
        write_settings(all, settings_file());
}

}  // namespace pimgview
