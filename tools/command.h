// SPDX-License-Identifier: BSD-3-Clause
// What a command is, and how a command line becomes a program: a list of steps, all checked before the first
// one runs, so that a misspelt key does not cost the minutes of work in front of it.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pimg/options.h>

#include "stack.h"

namespace pimgtool {

struct Command;

/// A command as given: `--level:fraction=0.1`, `--colorconvert sRGB linear`.
struct Call {
    const Command* command;
    std::vector<std::pair<std::string, std::string>> keys;
    std::vector<std::string> words;
};

/// Something to do to the stack. `label` goes before its error messages.
struct Step {
    std::string label;
    std::function<bool(Session&)> run;
};

/// A checked command line.
struct Program {
    std::vector<Step> steps;
    std::vector<std::string> inputs, written;  ///< names of files, in order
    int pictures = 0;                          ///< on the stack after the steps so far
    std::string dangling;                      ///< an output setting that no -o has followed yet
    int threads = 0;                           ///< 0: one per core
    std::string stats;                         ///< how to print figures: text, json; empty: not
    bool verbose = false;
};

/// One row of the command table.
struct Command {
    const char* name;   ///< "--level"
    const char* words;  ///< names of the words that follow, "FROM TO"; "" for none
    const char* help;   ///< one line
    int needs, adds;    ///< pictures it takes for granted on the stack, and how many more there are afterwards
    std::vector<pimg::OptionInfo> (*keys)();  ///< of the :key=value suffix; null for none
    /// Checks all that can be checked now and appends steps or sets a switch of `program`.
    std::function<bool(const Call&, Program&, std::string& error)> prepare;
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

/// Checks `arguments` and turns them into a program. False with a line in `error` for anything that is wrong.
bool parse(const std::vector<std::string>& arguments, Program& program, std::string& error);

}  // namespace pimgtool
