// SPDX-License-Identifier: BSD-3-Clause
// What keys do: one table for the window, the sheet of F1, --help and the manual page.
#pragma once

#include <vector>

namespace pimgview {

enum class Action {
    fit,
    actual_size,
    zoom_in,
    zoom_out,
    brighter,
    darker,
    more_gamma,
    less_gamma,
    plain_look,
    source,
    split,
    difference,
    clipped,
    histogram,
    waveform,
    mesh,
    piece,
    panels,
    theme,
    undo,
    redo,
    copy,
    open,
    save,
    next,
    previous,
    play,
    sheet,
    quit
};

struct Key {
    Action action;
    int code;  ///< as GLFW numbers keys; those with letters are the capitals on them
    bool control, shift;
    const char* name;  ///< "Ctrl+Z"; empty for a second key of an action, which no list shows
    const char* help;
};

const std::vector<Key>& key_table();

}  // namespace pimgview
