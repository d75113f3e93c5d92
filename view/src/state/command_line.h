// SPDX-License-Identifier: BSD-3-Clause
// The command line of pimgtool that gives the present result, and the reverse: stack and look from a command line.
#pragma once

#include <string>
#include <vector>

#include "state/filter_stack.h"
#include "state/look.h"

namespace pimgview {

/// The operations of a stack as arguments of pimgtool, without those that are off.
std::vector<std::string> arguments_of(const FilterStack& stack);

/// One line for a shell: `pimgtool [--part PART] FILE OPERATIONS -o OUTPUT`. Words are quoted where they need it; an empty `file` or
/// `output` is left out with what belongs to it.
std::string shell_line(const std::string& file, const FilterStack& stack, const std::string& output);

/// The look as an argument of pimgview: --view:key=value; empty if all is as by default.
std::string look_argument(const LookOptions& look);

/// Takes a line apart as a shell does, at spaces outside of quotes; a backslash keeps the next letter. False with a
/// line in `error` for a quote without its end.
bool split_words(const std::string& line, std::vector<std::string>& words, std::string& error);

/// What a script says, and whether it says anything of `stack` and of `look`.
struct Script {
    std::vector<std::string> files;
    FilterStack stack;
    LookOptions look;
    bool has_stack = false, has_look = false;
    std::string output;  ///< the file of -o; empty: none
};

/// Reads the operations on one picture of pimgtool's command line (--part, --build and the filters), file names, -o FILE and
/// --view. A first word "pimgtool" or "pimgview" is passed over. False with one line in `error` for all else.
bool parse_script(const std::vector<std::string>& words, Script& script, std::string& error);

}  // namespace pimgview
