// SPDX-License-Identifier: BSD-3-Clause
// pimgtool: progressive images on the command line. arguments -> program -> steps on a stack of pictures.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include <OpenImageIO/imageio.h>

#include "command.h"
#include "help.h"

namespace {

using namespace pimgtool;

/// Errors are one line, whatever a library put into its message.
int report(std::string error)
{
    while (!error.empty() && error.back() == '\n')
        error.pop_back();
    std::replace(error.begin(), error.end(), '\n', ' ');
    std::fprintf(stderr, "pimgtool: error: %s\n", error.c_str());
    return 1;
}

/// Answers --help and --version wherever they stand. False if neither does.
bool answer(const std::vector<std::string>& arguments, int& status)
{
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const Command* command = find_command(arguments[i]);
        const std::string name = command ? command->name : "";
        if (name == "--version") {
            std::fputs(version_text().c_str(), stdout);
            return true;
        }
        if (name != "--help")
            continue;
        const Command* topic = nullptr;
        if (i + 1 < arguments.size()) {
            topic = find_command(arguments[i + 1][0] == '-' ? arguments[i + 1] : "--" + arguments[i + 1]);
            if (!topic)
                status = report("--help: no operation \"" + arguments[i + 1] + "\": --help alone lists them");
        }
        if (status == 0)
            std::fputs((topic ? help_text(*topic) : help_text()).c_str(), stdout);
        return true;
    }
    return false;
}

int run(const Program& program)
{
    if (!std::getenv("OPENIMAGEIO_DEBUG"))
        OIIO::attribute("debug", 0);  // Debian's library talks on standard error otherwise
    OIIO::attribute("threads", program.threads);
    OIIO::attribute("exr_threads", program.threads);
    Session session;
    session.verbose = program.verbose;
    for (const std::string& input : program.inputs)
        session.announce(input);
    for (const Step& step : program.steps)
        if (!step.run(session))
            return report(step.label.empty() ? session.error() : step.label + ": " + session.error());
    if (!program.stats.empty())
        std::fputs((program.stats == "json" ? session.stats.json() : session.stats.text()).c_str(), stdout);
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    try {
        const std::vector<std::string> arguments(argv + 1, argv + argc);
        int status = 0;
        if (answer(arguments, status))
            return status;
        Program program;
        std::string error;
        return parse(arguments, program, error) ? run(program) : report(error);
    } catch (const std::bad_alloc&) {
        return report("not enough memory");
    } catch (const std::exception& e) {
        return report(e.what());
    }
}
