// SPDX-License-Identifier: BSD-3-Clause
// What the user is doing: the list of files, the stack and the look with their history, and what keys do to them. Panels
// and the view draw from it and change it.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "arguments.h"
#include "keys.h"
#include "state/history.h"
#include "state/settings.h"
#include "studio.h"

namespace pimgview {

/// What undo brings back.
struct Snapshot {
    FilterStack stack;
    LookOptions look;

    friend bool operator==(const Snapshot& a, const Snapshot& b) { return a.stack == b.stack && a.look == b.look; }
};

class Workbench {
public:
    /// `changed` is called from other threads when there is something new to draw.
    Workbench(const Arguments& arguments, std::function<void()> changed);

    void open(const std::vector<std::string>& files);
    void go_to(int index);

    /// Tells the threads what is wanted; called for every drawn frame. `dragging`: a widget or the mouse is held.
    void update(const Region& visible, double scale, bool dragging);

    /// Remembers the state for undo once nothing is held any more.
    void record();
    void act(Action action);

    /// The line for pimgtool that makes what is seen.
    std::string line() const;

    /// Applies a script: a preset or what was pasted. False with `message` set.
    bool apply(const std::string& line);

    /// Begins anew with what a script says.
    void replace(const Script& script);

    /// Saves the result as `save_name`. What is open is never written over, and a file that this window has not written
    /// only if `replace`; `message` says so.
    void save(bool replace);

    void save_preset(const std::string& name);
    void remember() const;  ///< writes the settings

    Studio studio;
    std::vector<std::string> files;
    int index = -1;
    bool playing = false;
    FilterStack stack;
    LookOptions look;
    Settings settings;
    std::string message;    ///< one line for the status bar
    std::string save_name;  ///< what the result is saved as
    bool sheet = false, opening = false, saving = false, quit = false, copied = false;

private:
    void open_document();
    void restore(const Snapshot& snapshot);
    void act_on_look(Action action);

    History<Snapshot> m_history;
    pimg::OptionTexts m_built;        ///< options of building the document has
    std::string m_part;               ///< part of the file that the document has
    std::set<std::string> m_written;  ///< names that results were saved as
    std::shared_ptr<const Shown> m_last_played;
};

}  // namespace pimgview
