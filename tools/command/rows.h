// SPDX-License-Identifier: BSD-3-Clause
// The kinds of rows there are in the command table.
#pragma once

#include <string>
#include <vector>

#include <pimg/filter_table.h>

#include "command/command.h"

namespace pimgtool {

using Words = std::vector<std::string>;

CommandGroup colour_group();
CommandGroup input_group();
CommandGroup output_group();
CommandGroup sequence_group();

/// An operation with keys.
template<class Options>
Command operation(const char* name, const char* help, bool (*run)(Session&, const Options&))
{
    const auto prepare = [run](const Call& call, Program& program, std::string& error) {
        Options options;
        if (!pimg::set_options(options, call.keys, error))
            return false;
        program.steps.push_back({ call.command->name, [=](Session& session) {
                                     return run(session, options);
                                 } });
        return true;
    };
    return { name, "", help, 1, 0, pimg::describe_options<Options>, prepare };
}

/// A filter on the hierarchy of the top picture. The result is one sweep away once the hierarchy is there.
inline Command filter(const pimg::Filter& row)
{
    const auto prepare = [bind = row.bind](const Call& call, Program& program, std::string& error) {
        pimg::BoundFilter bound;
        if (!bind(call.keys, bound, error))
            return false;
        for (const auto& [key, value] : call.keys)
            program.autoorient |= key == "strokes";  // the files of strokes cannot say which way is up
        const auto run = [bound](OIIO::ImageBuf& dst, const pimg::ProgressiveImage& src) {
            return bound(dst, src, {}, 0);
        };
        program.steps.push_back({ call.command->name, [run](Session& session) {
                                     return session.filter(run);
                                 } });
        return true;
    };
    return { row.command, "", row.summary, 1, 0, row.options, prepare };
}

/// An operation with words and keys, and what can be said about them beforehand.
template<class Options>
Command worded(const char* name, const char* words, const char* help,
               bool (*run)(Session&, const Words&, const Options&),
               bool (*check)(const Words&, const Options&, std::string& error) = nullptr)
{
    const auto prepare = [=](const Call& call, Program& program, std::string& error) {
        Options options;
        if (!pimg::set_options(options, call.keys, error) || (check && !check(call.words, options, error)))
            return false;
        program.steps.push_back({ call.command->name, [run, options, words = call.words](Session& session) {
                                     return run(session, words, options);
                                 } });
        return true;
    };
    return { name, words, help, 1, 0, pimg::describe_options<Options>, prepare };
}

/// The same without keys.
inline Command worded(const char* name, const char* words, const char* help, bool (*run)(Session&, const Words&))
{
    const auto prepare = [=](const Call& call, Program& program, std::string&) {
        program.steps.push_back({ call.command->name, [run, words = call.words](Session& session) {
                                     return run(session, words);
                                 } });
        return true;
    };
    return { name, words, help, 1, 0, nullptr, prepare };
}

using Prepare = bool (*)(const Call&, Program&, std::string& error);
using Keys = std::vector<pimg::OptionInfo> (*)();

/// Something about files, or about the whole command line.
inline Command setting(const char* name, const char* words, const char* help, Prepare prepare, Keys keys = nullptr)
{
    return { name, words, help, 0, 0, keys, prepare };
}

/// Something about all frames: it is taken off the command line before the rest is looked at; see take_settings().
inline Command general_setting(const char* name, const char* words, const char* help, Prepare prepare,
                               Keys keys = nullptr)
{
    return { name, words, help, 0, 0, keys, prepare, true };
}

}  // namespace pimgtool
