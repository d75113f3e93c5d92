// SPDX-License-Identifier: BSD-3-Clause
// Sequences: one command line stands for many, one per frame and view.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "command/command.h"

namespace pimgtool {

/// The programs of all frames, in order, from a command line as given: general settings are taken off, then the rest is
/// parsed once per frame and view with their names put in. Without --frames and --views there is one.
bool parse_frames(const std::vector<std::string>& arguments, Program& settings, std::vector<Program>& programs,
                  std::string& error);

/// `argument` with `frame` in place of "#" (four digits each), "@" (one each) and "%04d", and `view` in place of "%V"
/// (its first letter for "%v").
std::string for_frame(const std::string& argument, const Frame& frame);

/// Calls run() for every program with a session of its own; `parallel`: for several at a time, each with one thread.
/// False with the error of the first frame that failed.
bool for_each_frame(const std::vector<Program>& programs, bool parallel, Stats& stats,
                    const std::function<bool(const Program&, Session&)>& run, std::string& error);

}  // namespace pimgtool
