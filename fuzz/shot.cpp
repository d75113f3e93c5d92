// SPDX-License-Identifier: BSD-3-Clause
// Figures of a shot as a file gives them. What can be read can be asked for any frame, and is written and read again.
#include <cmath>
#include <cstdint>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include <pimg/detail/format.h>

#include "shot.h"
#include "taken.h"

using namespace pimg;

namespace {

/// A file in memory, with a name.
class MemoryFile {
public:
    MemoryFile() : m_file(memfd_create("shot", 0)), m_name("/proc/self/fd/" + std::to_string(m_file)) { }
    const std::string& holding(const std::uint8_t* data, std::size_t size)
    {
        must(ftruncate(m_file, 0) == 0 && pwrite(m_file, data, size, 0) == ssize_t(size));
        return m_name;
    }

private:
    int m_file;
    std::string m_name;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static MemoryFile file;
    Shot shot;
    std::string error;
    if (!shot.read(file.holding(data, size), error)) {
        must_be_message(pimg::one_line(error));
        return 0;
    }
    ShotOptions options;
    for (const char* mode : { "smooth", "lock" })
        for (const float radius : { 0.1f, 3.0f, 10000.0f })
            for (const int frame : { -2147483647 - 1, 0, 1, 2147483647 }) {
                options.mode = mode;
                options.radius = radius;
                const Anchors anchors = shot.anchors(frame, options);
                must(!std::isnan(anchors.dmax) && !std::isnan(anchors.key) && !std::isnan(anchors.white));
            }
    return 0;
}
