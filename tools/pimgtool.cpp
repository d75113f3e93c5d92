// SPDX-License-Identifier: BSD-3-Clause
// pimgtool: progressive images on the command line. arguments -> program -> steps on a stack of pictures.
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <limits>

#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <new>
#include <system_error>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

#include "command/help.h"
#include "command/sequence.h"

namespace {

using namespace pimgtool;

/// Errors are one line, whatever a library put into its message.
int report(const std::string& error)
{
    std::fprintf(stderr, "pimgtool: error: %s\n", pimg::one_line(error).c_str());
    return 1;
}

/// What --help, with its keys, prints for the argument after it, if there is one.
bool help(const std::string& argument, const std::string& after, std::string& text, std::string& error)
{
    Call call { find_command(argument), {}, {} };
    HelpOptions options;
    if (!split_keys(argument.substr(std::min(argument.find(':'), argument.size())), call, error))
        return false;
    for (const auto& [key, value] : call.keys)
        if (!pimg::set_option(options, key, value, error))
            return false;
    if (options.format != "text") {
        text = options.format == "man" ? manual_page() : bash_completion();
        return true;
    }
    const Command* topic = after.empty() ? nullptr : find_command(after[0] == '-' ? after : "--" + after);
    if (!topic && !after.empty()) {
        error = "no operation \"" + after + "\": --help alone lists them";
        return false;
    }
    text = topic ? help_text(*topic) : help_text();
    return true;
}

/// Answers --help and --version wherever they stand on the command line. False if neither is there.
bool answer(const std::vector<std::string>& arguments, int& status)
{
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const Command* command = find_command(arguments[i]);
        const std::string name = command ? command->name : "";
        std::string text, error;
        if (name == "--version")
            text = version_text();
        else if (name != "--help")
            continue;
        else if (!help(arguments[i], i + 1 < arguments.size() ? arguments[i + 1] : "", text, error))
            status = report("--help: " + error);
        std::fputs(text.c_str(), stdout);
        return true;
    }
    return false;
}

/// The figures of the shot, measured now if they have to be.
bool find_shot(const Program& settings, const std::vector<Program>& programs, Stats& stats, pimg::Shot& shot,
               std::string& error)
{
    if (OIIO::Filesystem::exists(settings.shot_file) && !settings.shot.update) {
        if (!shot.read(settings.shot_file, error))
            return false;
        for (const Program& program : programs)
            if (!shot.has(program.frame.number)) {
                error = pimg::format("\"{}\" knows nothing of frame {}: expected update=1 to measure anew",
                                     settings.shot_file, program.frame.number);
                return false;
            }
        return true;
    }
    std::mutex mutex;
    const auto measure = [&](const Program& program, Session& session) {
        session.measuring = true;
        if (!run_steps(program, session))
            return false;
        const std::lock_guard<std::mutex> lock(mutex);
        shot.add(program.frame.number, session.anchors);
        return true;
    };
    return for_each_frame(programs, settings.parallel_frames, stats, measure, error)
        && shot.write(settings.shot_file, error);
}

bool run(const Program& settings, const std::vector<Program>& programs, std::string& error)
{
    if (!std::getenv("OPENIMAGEIO_DEBUG"))
        OIIO::attribute("debug", 0);  // otherwise Debian's library writes to standard error
    OIIO::attribute("threads", programs[0].threads);
    OIIO::attribute("exr_threads", programs[0].threads);
    Stats stats;
    pimg::Shot shot;
    const bool has_shot = !settings.shot_file.empty();
    if (has_shot && !find_shot(settings, programs, stats, shot, error)) {
        error = "--shot-stats: " + error;
        return false;
    }
    const auto render = [&](const Program& program, Session& session) {
        if (has_shot)
            session.anchors = shot.anchors(program.frame.number, settings.shot);
        return run_steps(program, session);
    };
    const bool renders = !has_shot || settings.shot.render;
    if (renders && !for_each_frame(programs, settings.parallel_frames, stats, render, error))
        return false;
    if (!programs[0].stats.empty())
        std::fputs((programs[0].stats == "json" ? stats.json() : stats.text()).c_str(), stdout);
    return true;
}

}  // namespace

namespace {

/// Ends the program with one line when memory runs out where nothing catches it, such as in threads of libraries and in
/// their tables, which are made before main().
[[noreturn]] void out_of_memory()
{
    static constexpr char kLine[] = "pimgtool: error: not enough memory\n";
    (void)!write(STDERR_FILENO, kLine, sizeof kLine - 1);
    _exit(1);
}

#ifdef __ELF__
/// With less address space than this, libraries crash while they start (measured: below 440 MB with OpenImageIO 2.4 and
/// OpenColorIO 2.1, and one thread in OpenBLAS).
constexpr rlim_t kLeastAddressSpace = rlim_t(480) << 20;

constexpr char kOneBlasThread[] = "OPENBLAS_NUM_THREADS=1";

/// Starts the program again with one thread in OpenBLAS, which OpenCV brings and nothing here uses. Its threads ask for
/// 128 MB each until they get it: where address space is limited they took what OpenImageIO needs to start, which
/// crashed, or ran for ever. Returns where the environment has that setting already or nothing can be started.
void start_again_with_less(char** argv, char** environment)
{
    constexpr std::size_t kMost = 4096, kName = sizeof kOneBlasThread - 2;  // up to "="
    static const char* changed[kMost + 2];
    std::size_t n = 0;
    for (; environment[n] != nullptr && n < kMost; ++n) {
        if (std::strncmp(environment[n], kOneBlasThread, kName) == 0)
            return;
        changed[n] = environment[n];
    }
    changed[n] = kOneBlasThread;
    execve("/proc/self/exe", argv, const_cast<char**>(changed));
}

/// Where address space is limited, libraries go on with what was not allocated, and fail an assertion or crash: the
/// first thing that memory is missing for ends the program, and so does what a C library makes of a null pointer.
void end_where_memory_ends()
{
    std::set_new_handler(out_of_memory);
    for (const int fatal : { SIGSEGV, SIGABRT })
        std::signal(fatal, [](int) { out_of_memory(); });
}

void before_libraries(int, char** argv, char** environment)
{
    rlimit limit {};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
        if (limit.rlim_cur < kLeastAddressSpace)
            out_of_memory();
        start_again_with_less(argv, environment);
        end_where_memory_ends();
    }
    std::set_terminate(out_of_memory);
}

/// Runs before the constructors of any shared library.
[[gnu::section(".preinit_array"), gnu::used]] void (*const kFirstOfAll)(int, char**, char**) = before_libraries;
#endif

int run_arguments(const std::vector<std::string>& arguments)
{
    int status = 0;
    if (answer(arguments, status))
        return status;
    Program settings;
    std::vector<Program> programs;
    std::string error;
    const bool done = parse_frames(arguments, settings, programs, error) && run(settings, programs, error);
    return done ? 0 : report(error);
}

/// Makes sure that everything printed has been written: a full disk is an error.
int flushed(int status)
{
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
        return status;
    return status != 0 ? status : report(std::string("standard output: ") + std::strerror(errno));
}

}  // namespace

int main(int argc, char** argv)
{
#ifdef M_MMAP_THRESHOLD
    // Memory of large arrays is used again instead of given back: fresh pages, which the kernel must clear, took a
    // twentieth of the time. Those of the largest, as pictures of many megapixels have them, would be holes in the heap that
    // nothing fits into: without a limit the peak was a fifth higher.
    constexpr int kLargest = 32 << 20;  // what glibc takes
    mallopt(M_MMAP_THRESHOLD, kLargest);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
    std::signal(SIGXFSZ, SIG_IGN);  // a file over the limit is an error like any other
    try {
        return flushed(run_arguments(std::vector<std::string>(argv + 1, argv + argc)));
    } catch (const std::bad_alloc&) {
        return report("not enough memory");
    } catch (const std::system_error& e) {
        const bool lacks = e.code() == std::errc::resource_unavailable_try_again;  // stacks of threads are memory, too
        return report(lacks ? "not enough memory for another thread" : e.what());
    } catch (const std::exception& e) {
        return report(e.what());
    }
}
