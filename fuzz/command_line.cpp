// SPDX-License-Identifier: BSD-3-Clause
// The command line of pimgtool, one argument a line, taken apart for all frames and views without running it.
#include <cstdint>
#include <string>
#include <vector>

#include <pimg/detail/format.h>

#include "command/sequence.h"
#include "taken.h"

using namespace pimgtool;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Taken in(data, size);
    std::vector<std::string> arguments;
    while (in.left() > 0)
        arguments.push_back(in.text('\n'));
    Program settings;
    std::vector<Program> programs;
    std::string error;
    if (!parse_frames(arguments, settings, programs, error))
        must_be_message(pimg::one_line(error));
    return 0;
}
