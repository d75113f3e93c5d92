// SPDX-License-Identifier: BSD-3-Clause
#include "process_time.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <unistd.h>

namespace pimgview {

double seconds_since_start()
{
    std::ifstream stat("/proc/self/stat"), uptime("/proc/uptime");
    const std::string text { std::istreambuf_iterator<char>(stat), {} };
    const std::size_t name_end = text.rfind(')');  // the name before it may contain spaces
    double up = 0.0, ticks = 0.0;
    if (name_end == text.npos || !(uptime >> up))
        return 0.0;
    std::istringstream fields(text.substr(name_end + 1));
    std::string skipped;
    for (int field = 3; field < 22; ++field)  // proc(5): the 22nd is the time of the start
        fields >> skipped;
    if (!(fields >> ticks))
        return 0.0;
    return std::max(0.0, up - ticks / double(sysconf(_SC_CLK_TCK)));
}

}  // namespace pimgview
