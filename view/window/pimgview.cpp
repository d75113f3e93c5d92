// SPDX-License-Identifier: BSD-3-Clause
// pimgview shows pictures, with a widget for every option of every filter.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>

#include <OpenImageIO/imageio.h>

#include <pimg/detail/format.h>
#include <pimg/version.h>

#include "window.h"

namespace {

/// Errors are one line, whatever a library put into its message.
int report(std::string error)
{
    while (!error.empty() && error.back() == '\n')
        error.pop_back();
    std::replace(error.begin(), error.end(), '\n', ' ');
    std::fprintf(stderr, "pimgview: error: %s\n", pimg::one_line(error).c_str());
    return 1;
}

int run(const std::vector<std::string>& words)
{
    pimgview::Arguments arguments;
    std::string error;
    if (words.size() == 1 && words[0] == "--help:format=man") {
        std::fputs(pimgview::manual_page().c_str(), stdout);
        return 0;
    }
    if (!pimgview::parse_arguments(words, arguments, error))
        return report(error);
    if (arguments.help || arguments.version) {
        std::fputs(arguments.help ? pimgview::help_text().c_str() : "pimgview " PIMG_VERSION_STRING "\n", stdout);
        return 0;
    }
    OIIO::attribute("debug", 0);  // otherwise Debian's library writes to standard error
    pimgview::Window window(arguments);
    return window.open(error) && window.run(error) ? 0 : report(error);
}

}  // namespace

int main(int argc, char** argv)
{
    try {
        return run(std::vector<std::string>(argv + 1, argv + argc));
    } catch (const std::bad_alloc&) {
        return report("not enough memory");
    } catch (const std::exception& exception) {
        return report(exception.what());
    }
}
