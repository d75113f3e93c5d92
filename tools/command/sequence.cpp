// SPDX-License-Identifier: BSD-3-Clause
#include "command/sequence.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdlib>
#include <mutex>
#include <set>
#include <thread>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

#include "session/progress_bar.h"

namespace pimgtool {

namespace {

using pimg::format;

std::string with_name(const Frame& frame, const std::string& error)
{
    std::string name = frame.numbered ? format("frame {}: ", frame.number) : "";
    if (!frame.view.empty())
        name += format("view {}: ", frame.view);
    return name + error;
}

std::string padded(int number, std::size_t digits)
{
    const std::string text = std::to_string(std::abs(number));
    return (number < 0 ? "-" : "") + std::string(digits - std::min(digits, text.size()), '0') + text;
}

/// Length of "%4d", "%04d" and the like at `at`; 0 for anything else.
std::size_t printf_pattern(const std::string& text, std::size_t at, std::size_t& digits)
{
    std::size_t end = at + 1;
    while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])))
        ++end;
    if (end >= text.size() || text[end] != 'd' || end - at > 3)
        return 0;
    digits = std::size_t(std::atoi(text.c_str() + at + 1));
    return end + 1 - at;
}

/// Whether a name has a range of frames such as "1001-1003#", which other programs understand. Here the numbers would
/// become part of the name.
bool has_range(const std::string& name)
{
    for (std::size_t at = name.find_first_of("#@"); at != name.npos; at = name.find_first_of("#@", at + 1)) {
        const auto digits_before = [&](std::size_t end) {
            std::size_t begin = end;
            while (begin > 0 && std::isdigit(static_cast<unsigned char>(name[begin - 1])))
                --begin;
            return begin;
        };
        const std::size_t last = digits_before(at);
        if (last < at && last > 1 && name[last - 1] == '-' && digits_before(last - 1) < last - 1)
            return true;
    }
    return false;
}

/// The frames and views to run: at least one, which has neither if none were asked for.
std::vector<Frame> frames_of(const Program& settings)
{
    std::vector<Frame> frames;
    const std::vector<std::string> views = settings.views.empty() ? std::vector<std::string> { "" } : settings.views;
    const std::vector<int> numbers = settings.frames.empty() ? std::vector<int> { 0 } : settings.frames;
    for (const int number : numbers)
        for (const std::string& view : views)
            frames.push_back({ number, view, !settings.frames.empty() });
    return frames;
}

/// Two frames must not write the same file.
bool check_written(const std::vector<Program>& programs, std::string& error)
{
    std::set<std::string> written;
    for (const Program& program : programs) {
        for (const std::string& filename : std::set<std::string>(program.written.begin(), program.written.end()))
            if (!written.insert(filename).second) {
                error = format("\"{}\" would be written by several frames: expected # for the frame's number in it{}",
                               filename, program.frame.view.empty() ? "" : " and %V for the view's name");
                return false;
            }
    }
    return true;
}

bool parse_one(const std::vector<std::string>& arguments, const Frame& frame, const Program& settings, Program& program,
               std::string& error)
{
    std::vector<std::string> expanded(arguments.size());
    std::transform(arguments.begin(), arguments.end(), expanded.begin(),
                   [&](const std::string& argument) { return for_frame(argument, frame); });
    program.frame = frame;
    program.shot = settings.shot;
    if (!parse(expanded, program, error))
        return false;
    if (!settings.shot_file.empty() && program.compressions != 1) {
        error = format("--shot-stats: expected one --hdr-compress, found {}", program.compressions);
        return false;
    }
    return true;
}

/// Calls run(). Exceptions become the session's error.
bool run_caught(const std::function<bool(const Program&, Session&)>& run, const Program& program, Session& session)
{
    try {
        return run(program, session);
    } catch (const std::bad_alloc&) {
        session.fail("not enough memory");
    } catch (const std::exception& e) {
        session.fail(e.what());
    }
    return false;
}

}  // namespace

std::string for_frame(const std::string& argument, const Frame& frame)
{
    std::string result;
    for (std::size_t at = 0; at < argument.size();) {
        const char c = argument[at];
        std::size_t length = 1, digits = 0;
        if (frame.numbered && (c == '#' || c == '@')) {
            while (at + length < argument.size() && argument[at + length] == c)
                ++length;
            result += padded(frame.number, c == '#' ? 4 * length : length);
        } else if (c == '%' && at + 1 < argument.size() && !frame.view.empty()
                   && (argument[at + 1] == 'V' || argument[at + 1] == 'v')) {
            length = 2;
            result += argument[at + 1] == 'V' ? frame.view : frame.view.substr(0, 1);
        } else if (frame.numbered && c == '%' && printf_pattern(argument, at, digits) > 0) {
            length = printf_pattern(argument, at, digits);
            result += padded(frame.number, digits);
        } else {
            result += c;
        }
        at += length;
    }
    return result;
}

bool parse_frames(const std::vector<std::string>& arguments, Program& settings, std::vector<Program>& programs,
                  std::string& error)
{
    std::vector<std::string> rest;
    if (!take_settings(arguments, settings, rest, error))
        return false;
    for (const std::string& argument : rest)
        if (has_range(argument)) {
            error = format("\"{}\": expected # alone in the name, and the frames as --frames 1-240", argument);
            return false;
        }
    for (const Frame& frame : frames_of(settings)) {
        programs.emplace_back();
        if (!parse_one(rest, frame, settings, programs.back(), error)) {
            error = with_name(frame, error);
            return false;
        }
    }
    return check_written(programs, error);
}

bool for_each_frame(const std::vector<Program>& programs, bool parallel, Stats& stats,
                    const std::function<bool(const Program&, Session&)>& run, std::string& error)
{
    std::size_t workers = 1;
    if (parallel && programs.size() > 1) {
        // Frames run side by side with one thread each, so that no thread has to wait for another.
        const int threads = OIIO::get_int_attribute("threads");
        workers = std::min(std::size_t(std::max(threads, 1)), programs.size());
        OIIO::attribute("threads", 1);
        OIIO::attribute("exr_threads", 1);
        ProgressBar::disable();
    }
    std::atomic<std::size_t> next { 0 };
    std::size_t failed = programs.size();
    std::mutex mutex;
    const auto work = [&] {
        for (std::size_t i; (i = next.fetch_add(1)) < programs.size();) {
            const Program& program = programs[i];
            Session session;
            session.verbose = program.verbose;
            session.keeps_renditions = program.gain_maps;
            session.input.upright = turns_upright(program);
            session.input.keeps_parts = keeps_parts(program);
            for (const std::string& input : program.inputs)
                session.announce(input);
            const bool done = run_caught(run, program, session);
            const std::lock_guard<std::mutex> lock(mutex);
            stats.add(session.stats);
            if (done)
                continue;
            next = programs.size();  // no further frame is begun; those begun are finished
            if (i < failed) {
                failed = i;
                error = with_name(program.frame, session.error());
            }
        }
    };
    std::vector<std::thread> threads;
    for (std::size_t i = 1; i < workers; ++i)
        threads.emplace_back(work);
    work();
    for (std::thread& thread : threads)
        thread.join();
    if (workers > 1)
        OIIO::attribute("threads", int(workers));
    return failed == programs.size();
}

}  // namespace pimgtool
