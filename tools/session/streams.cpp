// SPDX-License-Identifier: BSD-3-Clause
#include "session/streams.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

namespace pimgtool {

namespace {

constexpr std::size_t kBuffer = 1 << 16;

/// Copies all bytes of one descriptor to another, and counts them. False with errno set.
bool copy_all(int from, int to, std::size_t& count)
{
    std::vector<char> buffer(kBuffer);
    for (;;) {
        const ssize_t got = read(from, buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return got == 0;
        for (ssize_t done = 0; done < got;) {
            const ssize_t n = write(to, buffer.data() + done, std::size_t(got - done));
            if (n < 0 && errno == EINTR)
                continue;
            if (n <= 0)
                return false;
            done += n;
        }
        count += std::size_t(got);
    }
}

/// The name of the file in memory; empty, with a line in `error`, if there is none.
std::string read_all(std::string& error)
{
    std::size_t count = 0;
    const int fd = memfd_create("standard input", MFD_CLOEXEC);
    if (fd < 0 || !copy_all(STDIN_FILENO, fd, count)) {
        error = std::strerror(errno);
        return "";
    }
    if (count == 0) {
        error = "it is empty, expected an image file";
        return "";
    }
    return pimg::format("/proc/self/fd/{}", fd);
}

}  // namespace

bool is_stream(const std::string& filename)
{
    const std::string name = filename.substr(0, filename.find('?'));
    return name == "-" || (OIIO::Strutil::starts_with(name, "-.") && name.find_first_of("/:", 2) == name.npos);
}

bool standard_input(std::string& filename, std::string& error)
{
    static std::mutex mutex;
    static std::string name, failure;
    const std::lock_guard<std::mutex> lock(mutex);
    if (name.empty() && failure.empty())
        name = read_all(failure);
    filename = name;
    error = failure;
    return !name.empty();
}

bool can_write_standard_output(std::string& error)
{
    if (isatty(STDOUT_FILENO) != 0)
        error = "standard output is a terminal: expected a pipe or a file, as in \"-o -.png > a.png\"";
    return error.empty();
}

std::string scratch_name(const std::string& filename)
{
    return OIIO::Filesystem::temp_directory_path() + "/pimgtool" + OIIO::Filesystem::extension(filename);
}

bool send_to_standard_output(const std::string& filename, std::string& error)
{
    std::signal(SIGPIPE, SIG_IGN);  // a reader that went away is an error like any other
    const int fd = open(filename.c_str(), O_RDONLY | O_CLOEXEC);
    std::size_t count = 0;
    const bool sent = fd >= 0 && copy_all(fd, STDOUT_FILENO, count);
    if (!sent)
        error = std::strerror(errno);
    if (fd >= 0)
        close(fd);
    return sent;
}

}  // namespace pimgtool
