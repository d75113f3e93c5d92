// SPDX-License-Identifier: BSD-3-Clause
// A small host of OpenFX: it loads one bundle and looks closely at what it does.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "commands.h"
#include "property_set.h"

namespace {

constexpr char kUsage[] = R"(usage: ofx_test_host BUNDLE COMMAND ...

  list                            identifiers and labels of the effects
  describe EFFECT                 its properties, clips and parameters; --context general
  render EFFECT IN... OUT [NAME=VALUE...]
                                  renders the frame --time 1 of the sequence IN... ; NAME@TIME=VALUE sets a key
      --tile N                    in tiles of N pixels; --threads N of them at a time
      --scale S                   at that render scale
      --depth float|half|short|byte    --components rgba|rgb|alpha    --straight 1: not premultiplied
      --left X --bottom Y         where the picture lies;  --aspect A: the shape of its pixels
      --top-down 1                its rows in memory;  --without-end 1: the clip is defined everywhere
      --field none|lower|upper    --context filter|general    --manages 1: the host manages colours
      --config FILE --space NAME  it does so by OpenColorIO, and its clips are in that space
      --repeat N                  N times, and says how long each took; NAME=A..B changes from A to B meanwhile
      --abort MS                  asks to stop after that time, and says when it stopped
      --press NAME                presses that button first;  --show 1: prints parameters with their keys
      --identity 1                says whether it changes nothing, and renders nothing
  stops EFFECT IN [NAME=VALUE...]
                                  stops renders at --moments 30 moments each, and says how long they took to
                                  end; --verbose 1: for each moment
  stress IN...                    --threads 8 --renders 100 --instances 4: random renders of all effects, each on
                                  --cpus 2 threads of the pool
  misuse IN                       wrong clips, handles and actions, missing suites: each must be refused politely
)";

test_host::Words words_of(int count, char** arguments)
{
    test_host::Words words;
    for (int i = 0; i < count; ++i) {
        const std::string word = arguments[i];
        const std::size_t sign = word.find('=');
        if (word.rfind("--", 0) == 0 && i + 1 < count)
            words.options.emplace_back(word.substr(2), arguments[++i]);
        else if (sign != word.npos)
            words.settings.emplace_back(word.substr(0, sign), word.substr(sign + 1));
        else
            words.rest.push_back(word);
    }
    return words;
}

}  // namespace

int main(int argc, char** argv)
{
    using namespace test_host;
    if (argc < 3) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    const std::string command = argv[2];
    const Words words = words_of(argc - 3, argv + 3);
    std::string error = "unknown command " + command;
    bool fine = false;
    const struct {
        const char* name;
        bool (*function)(const std::string&, const Words&, std::string&);
    } commands[] = {
        { "list", list },   { "describe", describe }, { "render", render },
        { "stops", stops }, { "stress", stress },     { "misuse", misuse },
    };
    for (const auto& [name, function] : commands)
        if (command == name)
            fine = function(argv[1], words, error);
    if (!fine)
        std::fprintf(stderr, "ofx_test_host: %s\n", error.c_str());
    if (count_violations() > 0)
        std::fprintf(stderr, "ofx_test_host: %d violations\n", count_violations());
    return fine && count_violations() == 0 ? 0 : 1;
}
