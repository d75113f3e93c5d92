// SPDX-License-Identifier: BSD-3-Clause
// The grammar of the command line, in one loop over the arguments. OpenImageIO's ArgParse is not used: it would leave
// every `--op:key=value` unparsed, and its help knows no keys. One table of our own serves parsing, checks, --help, the
// manual page and completion.
#include "command/command.h"

#include <algorithm>
#include <numeric>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

#include "session/streams.h"

namespace pimgtool {

namespace {

using pimg::format;

/// Number of letters to change, add or drop to get from one word to the other.
std::size_t distance(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t(0));
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t corner = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = corner + (a[i] == b[j] ? 0 : 1);
            corner = row[j + 1];
            row[j + 1] = std::min({ replaced, row[j + 1] + 1, row[j] + 1 });
        }
    }
    return row.back();
}

std::string unknown_command(const std::string& name)
{
    const Command* nearest = nullptr;
    std::size_t least = 4;  // a word that differs more is no misspelling
    for (const CommandGroup& group : command_table())
        for (const Command& command : group.commands) {
            const std::size_t d = distance(name, command.name);
            if (d < least && d * 2 < name.size()) {
                least = d;
                nearest = &command;
            }
        }
    const std::string hint =
        nearest ? format("did you mean {}?", nearest->name) : "expected an operation that --help lists";
    return format("unknown operation \"{}\": {}", name, hint);
}

/// Takes the words a command needs from the arguments after `at`.
bool take_words(const std::vector<std::string>& arguments, std::size_t& at, Call& call, std::string& error)
{
    for (const std::string& name : OIIO::Strutil::splits(call.command->words)) {
        const bool end = at + 1 >= arguments.size();
        if (end || find_command(arguments[at + 1])) {
            error = format("missing {}: expected {} {}{}", name, call.command->name, call.command->words,
                           end ? "" : format(", found \"{}\"", arguments[at + 1]));
            return false;
        }
        call.words.push_back(arguments[++at]);
    }
    return true;
}

/// Reads a command with its keys and words, the last of which `at` is moved to.
bool read_call(const std::vector<std::string>& arguments, std::size_t& at, Call& call, std::string& error)
{
    const std::string& text = arguments[at];
    const std::size_t colon = std::min(text.find(':'), text.size());
    call.command = find_command(text);
    if (!call.command) {
        error = unknown_command(text.substr(0, colon));
        return false;
    }
    if (!split_keys(text.substr(colon), call, error) || !take_words(arguments, at, call, error))
        return false;
    if (call.keys.empty() || call.command->keys)
        return true;
    error = format("unknown option \"{}\": expected none", call.keys.front().first);
    return false;
}

bool parse_command(const std::vector<std::string>& arguments, std::size_t& at, Program& program, std::string& error)
{
    Call call {};
    const auto prepare = [&] {
        if (!read_call(arguments, at, call, error))
            return false;
        if (program.pictures < call.command->needs) {
            error = program.pictures == 0
                ? "no picture to work on: expected an input file before it"
                : format("expected {} pictures on the stack, there is one", call.command->needs);
            return false;
        }
        return call.command->prepare(call, program, error);
    };
    if (!prepare()) {
        if (call.command)
            error = format("{}: {}", call.command->name, error);
        return false;
    }
    program.pictures += call.command->adds;
    return true;
}

bool parse_input(const std::string& filename, Program& program, std::string& error)
{
    // A reader may take options after the name: `a.pimg?level=10`.
    const std::string file = OIIO::Filesystem::exists(filename) ? filename : filename.substr(0, filename.find('?'));
    const bool will_exist = is_stream(filename) || std::count(program.written.begin(), program.written.end(), file) > 0;
    if (!will_exist && !OIIO::Filesystem::exists(file)) {
        error = format("cannot read \"{}\": no such file", filename);
        return false;
    }
    if (!will_exist && OIIO::Filesystem::is_directory(file)) {
        error = format("cannot read \"{}\": it is a directory, expected a file", filename);
        return false;
    }
    program.inputs.push_back(filename);
    program.dangling_input.clear();
    program.steps.push_back({ "", [filename](Session& session) {
                                 return session.read(filename);
                             } });
    ++program.pictures;
    return true;
}

}  // namespace

bool split_keys(const std::string& text, Call& call, std::string& error)
{
    if (text == ":")
        error = "\"\": expected key=value";
    return error.empty() && (text.empty() || pimg::split_options(text.substr(1), call.keys, error));
}

const Command* find_command(const std::string& name)
{
    const std::string bare = name.substr(0, name.find(':'));
    if (bare.empty() || bare[0] != '-')
        return nullptr;
    for (const CommandGroup& group : command_table())
        for (const Command& command : group.commands)
            if (bare == command.name || "-" + bare == command.name || bare == "-" + std::string(command.name))
                return &command;
    return nullptr;
}

bool take_settings(const std::vector<std::string>& arguments, Program& settings, std::vector<std::string>& rest,
                   std::string& error)
{
    for (std::size_t at = 0; at < arguments.size(); ++at) {
        const Command* command = find_command(arguments[at]);
        if (!command || !command->general)
            rest.push_back(arguments[at]);
        else if (!parse_command(arguments, at, settings, error))
            return false;
    }
    return true;
}

bool turns_upright(const Program& program)
{
    const auto says_orientation = [](const std::string& filename) {
        const std::string extension = OIIO::Strutil::lower(OIIO::Filesystem::extension(filename, false));
        return extension == "jpg" || extension == "jpeg" || extension == "tif" || extension == "tiff";
    };
    return program.autoorient || program.written.empty()
        || !std::all_of(program.written.begin(), program.written.end(), says_orientation);
}

bool keeps_parts(const Program& program)
{
    return std::any_of(program.written.begin(), program.written.end(), holds_parts);
}

bool run_steps(const Program& program, Session& session)
{
    for (const Step& step : program.steps) {
        if (session.measuring && step.writes)
            continue;
        if (!step.run(session))
            return step.label.empty() ? false : session.fail(step.label + ": " + session.error());
        if (session.measuring && session.measured)
            break;
    }
    return true;
}

bool parse(const std::vector<std::string>& arguments, Program& program, std::string& error)
{
    for (std::size_t at = 0; at < arguments.size(); ++at) {
        const bool is_command = !arguments[at].empty() && arguments[at][0] == '-' && !is_stream(arguments[at]);
        if (is_command ? !parse_command(arguments, at, program, error) : !parse_input(arguments[at], program, error))
            return false;
    }
    const auto streams = std::count_if(program.written.begin(), program.written.end(), is_stream);
    if (streams > 0 && (streams > 1 || program.informs || !program.stats.empty()))
        error = format("\"{}\": nothing else can go to standard output: expected one picture, and no --info or --stats",
                       *std::find_if(program.written.begin(), program.written.end(), is_stream));
    else if (!program.dangling_input.empty())
        error = format("{} has no effect here: expected it before the file it is meant for", program.dangling_input);
    else if (!program.dangling.empty())
        error = format("{} has no effect here: expected it before the -o it is meant for", program.dangling);
    else if (program.inputs.empty() && !program.informs)
        error = "nothing to do: expected an input file, operations and -o FILE; --help lists them";
    else if (program.written.empty() && program.stats.empty() && !program.verbose && !program.informs
             && program.shot.render)
        error = "nothing would be written: expected -o FILE, or --stats";
    return error.empty();
}

}  // namespace pimgtool
