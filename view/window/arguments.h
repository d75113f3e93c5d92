// SPDX-License-Identifier: BSD-3-Clause
// The command line of pimgview.
#pragma once

#include <string>
#include <vector>

#include "state/command_line.h"

namespace pimgview {

/// One state of the window that is to be written to a file.
struct Shot {
    Script script;
    std::string screenshot;  ///< file it is written to; empty: none
};

struct Arguments {
    std::vector<std::string> files;
    Script script;                   ///< of the first state
    std::string screenshot;          ///< of the first state; empty: none
    std::vector<Shot> more;          ///< the states after it
    int width = 1280, height = 800;  ///< of the window
    bool sized = false;              ///< --size was given
    std::string measured;            ///< option that is dragged for --measure, such as beta; empty: none
    int random_events = 0, seed = 1;
    int tile = 0;  ///< largest texture; 0: what the driver allows
    bool help = false, version = false;
};

/// False with one line in `error` for what is not understood.
bool parse_arguments(const std::vector<std::string>& words, Arguments& arguments, std::string& error);

/// What --help prints, and the keys among it.
std::string help_text();

/// A manual page for man(1).
std::string manual_page();

}  // namespace pimgview
