// SPDX-License-Identifier: BSD-3-Clause
// What a command is, and how a command line becomes a program: a list of steps, all checked before the first
// one runs, so that a misspelt key does not cost the minutes of work in front of it.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pimg/option_text.h>
#include <pimg/options.h>

#include "session/stack.h"

namespace pimgtool {

struct Command;

/// A command as given: `--level:fraction=0.1`, `--colorconvert sRGB linear`.
struct Call {
    const Command* command;
    pimg::OptionTexts keys;
    std::vector<std::string> words;
};

/// Something to do to the stack. `label` goes before its error messages.
struct Step {
    std::string label;
    std::function<bool(Session&)> run;
    bool writes = false;  ///< writes a file, and is left out while a shot is measured
};

/// Which of a sequence's frames a program is for.
struct Frame {
    int number = 0;
    std::string view;
    bool numbered = false;  ///< false: there are no frames, perhaps views
};

/// A checked command line.
struct Program {
    std::vector<Step> steps;
    std::vector<std::string> inputs, written;  ///< names of files, in order
    int pictures = 0;                          ///< on the stack after the steps so far
    std::string dangling;                      ///< an output setting that still needs an -o after it
    std::string dangling_input;                ///< an input setting that still needs a file after it
    int threads = 0;                           ///< 0: one per core
    bool informs = false;                      ///< something is printed that needs no pictures
    std::string stats;                         ///< how to print figures: text, json; empty: not
    bool verbose = false;
    bool gain_maps = false;   ///< a file with a gain map is written
    bool autoorient = false;  ///< pictures are turned upright whatever is written
    Frame frame;
    int compressions = 0;  ///< number of --hdr-compress

    /// General settings.
    std::vector<int> frames;
    std::vector<std::string> views;
    bool parallel_frames = false;
    std::string shot_file;  ///< empty: none
    pimg::ShotOptions shot;
};

/// One row of the command table.
struct Command {
    const char* name;   ///< "--level"
    const char* words;  ///< names of the words that follow, "FROM TO"; "" for none
    const char* help;   ///< one line
    int needs, adds;    ///< pictures that must be on the stack, and how many more there are afterwards
    std::vector<pimg::OptionInfo> (*keys)();  ///< of the :key=value suffix; null for none
    /// Checks all that can be checked now and appends steps or sets a switch of `program`.
    std::function<bool(const Call&, Program&, std::string& error)> prepare;
    bool general = false;                                     ///< about all frames; see take_settings()
    const std::vector<pimg::Preset>& (*presets)() = nullptr;  ///< as in pimg::Filter
};

/// Headed part of the table: --help and the manual show them so.
struct CommandGroup {
    const char* title;
    std::vector<Command> commands;
};

/// Every command there is: the parser, --help, the manual page and shell completion read this table.
const std::vector<CommandGroup>& command_table();

/// The command of that name, with one or two dashes; null if there is none.
const Command* find_command(const std::string& name);

/// Splits ":key=value:key=value" by the rules of option_text.h.
bool split_keys(const std::string& text, Call& call, std::string& error);

/// Prepares the general settings among the arguments, wherever they stand; `rest` receives the others.
bool take_settings(const std::vector<std::string>& arguments, Program& settings, std::vector<std::string>& rest,
                   std::string& error);

/// Whether pictures are to be turned upright while they are read: unless only formats are written that say which way
/// is up, JPEG and TIFF.
bool turns_upright(const Program& program);

/// Whether a file is written that holds several parts, so that all parts of the inputs are read.
bool keeps_parts(const Program& program);

/// Runs the steps. To measure a shot, only those up to --hdr-compress, and none that write files.
bool run_steps(const Program& program, Session& session);

/// Checks `arguments` and turns them into a program. False with a line in `error` for anything that is wrong.
bool parse(const std::vector<std::string>& arguments, Program& program, std::string& error);

}  // namespace pimgtool
