// SPDX-License-Identifier: BSD-3-Clause
// The table of all commands. Filters are those of the registry, filter_table(); an operation of another kind has a row
// and a small function.
#include <algorithm>
#include <utility>

#include "command/help.h"
#include "command/rows.h"

namespace pimgtool {

/// Keys of --stats.
struct StatsOptions {
    std::string format = "text";
};

}  // namespace pimgtool

namespace pimg {

template<>
const std::vector<Option<pimgtool::StatsOptions>>& option_table<pimgtool::StatsOptions>()
{
    static const std::vector<Option<pimgtool::StatsOptions>> table = {
        { &pimgtool::StatsOptions::format, { "format", 0, 0, "", "text|json", "json is for programs to read" } },
    };
    return table;
}

}  // namespace pimg

namespace pimgtool {

namespace {

// ---- kinds of rows ----------------------------------------------------------------------------------------

/// Rearranges the stack.
Command shuffle(const char* name, const char* help, int needs, int adds, void (*run)(std::vector<Picture>&))
{
    const auto prepare = [=](const Call& call, Program& program, std::string&) {
        program.steps.push_back({ call.command->name, [=](Session& session) {
                                     run(session.stack);
                                     return true;
                                 } });
        return true;
    };
    return { name, "", help, needs, adds, nullptr, prepare };
}

// ---- hierarchies ------------------------------------------------------------------------------------------

bool build(Session& session, const pimg::BuildOptions& options)
{
    return session.build(options);
}

bool hdr_compress(Session& session, const pimg::HdrCompressOptions& options)
{
    return session.hdr_compress(options);
}

/// The row of --hdr-compress. It counts how often it is used, because --shot-stats needs to know which one it is for.
Command hdr_compress_row(const pimg::Filter& filter)
{
    Command row = operation<pimg::HdrCompressOptions>(filter.command, filter.summary, hdr_compress);
    row.prepare = [prepare = row.prepare](const Call& call, Program& program, std::string& error) {
        ++program.compressions;
        return prepare(call, program, error);
    };
    return row;
}

// ---- settings ---------------------------------------------------------------------------------------------

bool threads(const Call& call, Program& program, std::string& error)
{
    const pimg::OptionRule rule = { "N", 0, 1024, "", "", "" };
    pimg::OptionValue value = 0;
    if (!pimg::parse_option(rule, call.words[0], value, error))
        return false;
    program.threads = std::get<int>(value);
    return true;
}

bool stats(const Call& call, Program& program, std::string& error)
{
    StatsOptions options;
    if (!pimg::set_options(options, call.keys, error))
        return false;
    program.stats = options.format;
    return true;
}

bool verbose(const Call&, Program& program, std::string&)
{
    return program.verbose = true;
}

/// For --help and --version, which are answered before the command line is read; the table only lists them.
bool answered_already(const Call& call, Program&, std::string& error)
{
    HelpOptions options;
    return pimg::set_options(options, call.keys, error);
}

// ---- the table --------------------------------------------------------------------------------------------

/// Those of the registry, in its order.
CommandGroup filters_group()
{
    CommandGroup group { "Filters on the progressive image of the top picture", {} };
    group.commands.push_back(operation<pimg::BuildOptions>(
        "--build", "builds the progressive image with these options, for the filters that follow", build));
    for (const pimg::Filter& row : pimg::filter_table()) {
        group.commands.push_back(std::string_view(row.name) == "hdr_compress" ? hdr_compress_row(row) : filter(row));
        group.commands.back().presets = row.presets;
    }
    return group;
}

CommandGroup stack_group()
{
    using Stack = std::vector<Picture>;
    return { "The stack of pictures",
             {
                 shuffle("--dup", "puts a copy of the top picture on the stack; both share one progressive image", 1, 1,
                         [](Stack& stack) { stack.push_back(Picture(stack.back())); }),
                 shuffle("--pop", "takes the top picture off the stack", 1, -1, [](Stack& stack) { stack.pop_back(); }),
                 shuffle("--swap", "exchanges the two top pictures", 2, 0,
                         [](Stack& stack) { std::swap(stack.back(), stack[stack.size() - 2]); }),
             } };
}

CommandGroup general_group()
{
    return { "General",
             {
                 setting("--threads", "N",
                         "number of threads; 0, the default: one per core. Results do not depend on it", threads),
                 setting("--stats", "", "prints sizes, seconds per stage and peak memory at the end", stats,
                         pimg::describe_options<StatsOptions>),
                 setting("-v", "", "reports each step, and how long it took, on standard error", verbose),
                 setting("--help", "", "lists all commands, or explains the one that is named after it",
                         answered_already, pimg::describe_options<HelpOptions>),
                 setting("--version", "", "prints the versions of pimgtool and OpenImageIO", answered_already),
             } };
}

}  // namespace

const std::vector<CommandGroup>& command_table()
{
    static const std::vector<CommandGroup> table = { input_group(),  filters_group(),  colour_group(), stack_group(),
                                                     output_group(), sequence_group(), general_group() };
    return table;
}

}  // namespace pimgtool
