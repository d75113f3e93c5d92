// SPDX-License-Identifier: BSD-3-Clause
// The command line of pimgtool taken apart without running it: what is turned away, and in which words.
#include "command/command.h"

#include <cmath>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <OpenImageIO/strutil.h>

#include "command/help.h"
#include "command/sequence.h"

namespace {

using namespace pimgtool;
using Arguments = std::vector<std::string>;

class CommandLine : public testing::Test {
protected:
    // The parser only asks whether inputs are there.
    CommandLine() { std::ofstream("in.png") << "not looked into"; }

    static std::string error_of(const Arguments& arguments)
    {
        Program program;
        std::string error;
        const bool parsed = parse(arguments, program, error);
        EXPECT_EQ(parsed, error.empty());
        return error;
    }

    static void expect_error(const Arguments& arguments, std::initializer_list<const char*> words)
    {
        const std::string error = error_of(arguments);
        const std::string line = testing::PrintToString(arguments) + ": " + error;
        EXPECT_FALSE(error.empty()) << line;
        EXPECT_EQ(error.find('\n'), error.npos) << line;
        for (const char* word : words)
            EXPECT_NE(error.find(word), error.npos) << line << ", expected " << word;
    }

    /// An operation with something wrong in it.
    static void expect_operation_error(const std::string& operation, std::initializer_list<const char*> words)
    {
        expect_error({ "in.png", operation, "-o", "out.png" }, words);
    }
};

std::vector<const Command*> commands_with_keys()
{
    std::vector<const Command*> found;
    for (const CommandGroup& group : command_table())
        for (const Command& command : group.commands)
            if (command.keys)
                found.push_back(&command);
    return found;
}

/// A command line in which this command, as `text`, has the words it needs.
Arguments with_words(const Command& command, const std::string& text)
{
    Arguments arguments = { "in.png", text };
    for (const std::string& word : OIIO::Strutil::splits(command.words))
        arguments.push_back(word == "FILE" ? "out.pimg" : word == "FROM" ? "linear" : "sRGB");
    if (std::string(command.name) != "-o")
        arguments.insert(arguments.end(), { "-o", "out.png" });
    return arguments;
}

TEST_F(CommandLine, BecomesOneStepPerFileAndOperation)
{
    Program program;
    std::string error;
    ASSERT_TRUE(parse({ "in.png", "--level:faces=9", "-o", "a.png", "--dup", "--pop", "-d", "half", "-o", "b.exr",
                        "--threads", "3", "--stats:format=json" },
                      program, error))
        << error;
    EXPECT_EQ(program.steps.size(), 7u);
    EXPECT_EQ(program.inputs, Arguments { "in.png" });
    EXPECT_EQ(program.written, (Arguments { "a.png", "b.exr" }));
    EXPECT_EQ(program.pictures, 1);
    EXPECT_EQ(program.threads, 3);
    EXPECT_EQ(program.stats, "json");
}

TEST_F(CommandLine, AcceptsWhatIsWrittenEarlierAsInput)
{
    EXPECT_EQ(error_of({ "in.png", "-o", "new.png", "new.png", "-o", "out.png" }), "");
    expect_error({ "new.png", "-o", "out.png", "in.png", "-o", "new.png" }, { "\"new.png\"", "no such file" });
}

TEST_F(CommandLine, AcceptsOneDashAndTwo)
{
    EXPECT_EQ(find_command("-level:faces=3"), find_command("--level"));
    EXPECT_EQ(find_command("--o"), find_command("-o"));
    EXPECT_EQ(find_command("level"), nullptr);
    EXPECT_EQ(find_command("o"), nullptr);
    EXPECT_EQ(find_command(""), nullptr);
}

TEST_F(CommandLine, KeepsColonsInQuotationMarks)
{
    EXPECT_EQ(error_of({ "in.png", "--build:incolorspace=\"a:b\":base=9", "-o", "out.png" }), "");
    EXPECT_EQ(error_of({ "in.png", "--build:incolorspace='a:b'", "-o", "out.png" }), "");
    EXPECT_EQ(error_of({ "in.png", "--build:incolorspace=", "-o", "out.png" }), "");
    expect_operation_error("--build:incolorspace=a:b", { "--build", "\"b\"", "key=value" });
    expect_operation_error("--build:incolorspace=\"a:b", { "--build", "incolorspace: expected", "quotation marks" });
}

TEST_F(CommandLine, NamesUnknownOperations)
{
    expect_operation_error("--lvel", { "\"--lvel\"", "did you mean --level?" });
    expect_operation_error("--hdr-compres:s0=1", { "\"--hdr-compres\"", "did you mean --hdr-compress?" });
    expect_operation_error("--paint-it-black", { "\"--paint-it-black\"", "--help" });
    expect_operation_error("-x", { "\"-x\"", "--help" });
    expect_operation_error("-:s0=1", { "\"-\"", "--help" });
}

TEST_F(CommandLine, NamesUnknownAndUnfinishedKeys)
{
    for (const Command* command : commands_with_keys()) {
        const std::string name = command->name;
        for (const auto& [suffix, word] : { std::pair(":size=3", "expected"),
                                            { ":size", "key=value" },
                                            { ":=3", "key=value" },
                                            { ":", "key=value" } })
            expect_error(with_words(*command, name + suffix), { command->name, word });
        expect_error(with_words(*command, name + ":size=3"), { "\"size\"" });
    }
    expect_operation_error("--dup:deep=1", { "--dup", "\"deep\"", "none" });
    expect_error({ "in.png", "-o:type=half", "out.pimg" }, { "-o", "\"type\"", "profile" });
}

TEST_F(CommandLine, NamesBadValues)
{
    expect_operation_error("--level:fraction=2", { "--level", "fraction", "\"2\"", "0 to 1" });
    expect_operation_error("--level:fraction=", { "--level", "fraction", "\"\"", "0 to 1" });
    expect_operation_error("--level:faces=many", { "faces", "\"many\"", "whole number" });
    expect_operation_error("--level:faces=2.5", { "faces", "\"2.5\"", "whole number" });
    expect_operation_error("--level:faces=nan", { "faces", "\"nan\"", "whole number" });
    expect_operation_error("--level:splits=-1", { "splits", "\"-1\"", "0 or more" });
    expect_operation_error("--hdr-compress:s0=0.1:beta=inf", { "beta", "\"inf\"" });
    expect_operation_error("--hdr-compress:s0=1e99", { "s0", "\"1e99\"", "0 to 1" });
    expect_operation_error("--build:guide=chroma", { "guide", "\"chroma\"", "luma" });
    expect_operation_error("--wireframe:overlay=maybe", { "overlay", "\"maybe\"" });
    expect_operation_error("--stats:format=xml", { "format", "\"xml\"", "json" });
}

TEST_F(CommandLine, NamesMissingAndBadWords)
{
    expect_error({ "in.png", "--colorconvert", "sRGB", "-o", "out.png" }, { "--colorconvert", "missing TO", "\"-o\"" });
    expect_error({ "in.png", "--colorconvert", "sRGB", "sepia", "-o", "out.png" }, { "\"sepia\"", "expected" });
    expect_error({ "in.png", "--tocolorspace", "sepia", "-o", "out.png" }, { "\"sepia\"", "expected" });
    expect_error({ "in.png", "--ociodisplay", "Screen", "Film", "-o", "out.png" }, { "--ociodisplay", "expected" });
    expect_error({ "in.png", "--threads", "many", "-o", "out.png" }, { "--threads", "\"many\"", "0 to" });
    expect_error({ "in.png", "--threads", "-1", "-o", "out.png" }, { "--threads", "\"-1\"", "0 to" });
    expect_error({ "in.png", "-d", "int3", "-o", "out.png" }, { "-d", "\"int3\"", "uint8" });
    expect_error({ "in.png", "-o" }, { "-o", "missing FILE" });
    expect_error({ "in.png", "-o", "--level" }, { "-o", "missing FILE", "\"--level\"" });
}

TEST_F(CommandLine, NamesBadFiles)
{
    expect_error({ "missing.exr", "-o", "out.png" }, { "\"missing.exr\"", "no such file" });
    expect_error({ "in.png", "missing.exr", "-o", "out.png" }, { "\"missing.exr\"", "no such file" });
    expect_error({ ".", "-o", "out.png" }, { "\".\"", "directory" });
    expect_error({ "", "-o", "out.png" }, { "\"\"", "no such file" });
    expect_error({ "in.png", "-o", "out.xyz" }, { "\"out.xyz\"", "\".xyz\"" });
    expect_error({ "in.png", "-o", "out" }, { "\"out\"", "extension" });
    expect_error({ "in.png", "-o", "nowhere/out.png" }, { "\"nowhere/out.png\"", "no directory \"nowhere\"" });
    expect_error({ "in.png", "-o", "." }, { "\".\"" });
}

TEST_F(CommandLine, MissesPictures)
{
    for (const CommandGroup& group : command_table())
        for (const Command& command : group.commands) {
            Arguments arguments = { command.name };
            for (const char* word = command.words; *word; ++word)
                if (word == command.words || *word == ' ')
                    arguments.push_back("uint8.png");
            if (command.needs > 0)
                expect_error(arguments, { command.name, "no picture" });
        }
    expect_error({ "in.png", "--pop", "-o", "out.png" }, { "-o", "no picture" });
    expect_error({ "in.png", "--swap", "-o", "out.png" }, { "--swap", "2 pictures" });
}

TEST_F(CommandLine, MissesSomethingToDo)
{
    expect_error({}, { "input file", "--help" });
    expect_error({ "--stats" }, { "input file" });
    expect_error({ "in.png" }, { "-o FILE" });
    expect_error({ "in.png", "--level" }, { "-o FILE" });
    EXPECT_EQ(error_of({ "in.png", "--build", "--stats" }), "");
    expect_error({ "in.png", "-o", "out.png", "-d", "half" }, { "-d", "before the -o" });
    expect_error({ "in.png", "-o", "out.png", "--raw" }, { "--raw", "before the -o" });
}

TEST_F(CommandLine, TakesEveryKeyAtItsDefault)
{
    for (const Command* command : commands_with_keys())
        for (const pimg::OptionInfo& option : command->keys()) {
            if (option.default_value.empty() || std::string(command->words) == "DISPLAY VIEW")
                continue;  // without a configuration there are no displays
            const std::string text = std::string(command->name) + ":" + option.key + "=" + option.default_value;
            EXPECT_EQ(error_of(with_words(*command, text)), "") << text;
        }
}

TEST(Help, ShowsTheWholeTable)
{
    const std::string text = help_text();
    std::set<std::string> names;
    for (const CommandGroup& group : command_table())
        for (const Command& command : group.commands) {
            EXPECT_TRUE(names.insert(command.name).second) << command.name << " is there twice";
            EXPECT_NE(text.find("\n  " + std::string(command.name)), text.npos) << command.name;
            EXPECT_NE(text.find(command.help), text.npos) << command.name;
        }
    for (const Command* command : commands_with_keys())
        for (const pimg::OptionInfo& option : command->keys()) {
            const std::string of_command = help_text(*command);
            EXPECT_NE(of_command.find(" " + option.key + "=" + option.default_value + " "), text.npos) << option.key;
            EXPECT_NE(of_command.find(option.help), text.npos) << option.key;
        }
}

TEST(Help, ManualAndCompletionShowIt)
{
    const std::string manual = manual_page(), completion = bash_completion();
    for (const CommandGroup& group : command_table())
        for (const Command& command : group.commands)
            EXPECT_NE(completion.find(command.name), completion.npos) << command.name;
    for (const Command* command : commands_with_keys())
        for (const pimg::OptionInfo& option : command->keys()) {
            EXPECT_NE(manual.find("\\fB" + option.key + "\\fR="), manual.npos) << option.key;
            EXPECT_NE(completion.find(option.key + "="), completion.npos) << option.key;
        }
    EXPECT_NE(manual.find("\\fB\\-\\-hdr\\-compress\\fR"), manual.npos);
}

TEST(Sequence, NamesOfFrames)
{
    const Frame frame { 12, "left", true }, view { 0, "right", false };
    for (const auto& [pattern, name] : { std::pair("a.#.exr", "a.0012.exr"),
                                         { "a.@@@.exr", "a.012.exr" },
                                         { "a.@", "a.12" },
                                         { "a%04d.b", "a0012.b" },
                                         { "a%d", "a12" },
                                         { "%V/a.%v.##.exr", "left/a.l.00000012.exr" },
                                         { "100%", "100%" },
                                         { "a%x", "a%x" } })
        EXPECT_EQ(for_frame(pattern, frame), name) << pattern;
    EXPECT_EQ(for_frame("a.#.%V.%04d", view), "a.#.right.%04d");
    EXPECT_EQ(for_frame("a.#", { -3, "", true }), "a.-0003");
    EXPECT_EQ(for_frame("%V#", {}), "%V#");
}

TEST(Help, FitsATerminal)
{
    std::string::size_type begin = 0;
    const std::string text = help_text();
    for (auto end = text.find('\n'); end != text.npos; begin = end + 1, end = text.find('\n', begin))
        EXPECT_LE(end - begin, 120u) << text.substr(begin, end - begin);
}

}  // namespace
