// SPDX-License-Identifier: BSD-3-Clause
// Commands on files.
#include <algorithm>
#include <cstdio>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

#include "command/rows.h"
#include "session/output.h"
#include "session/pimg_file.h"

namespace pimgtool {

/// Keys of --iconfig.
struct HintOptions {
    std::string type;
};

}  // namespace pimgtool

namespace pimg {

template<>
const std::vector<Option<pimgtool::HintOptions>>& option_table<pimgtool::HintOptions>()
{
    static const std::vector<Option<pimgtool::HintOptions>> table = {
        { &pimgtool::HintOptions::type,
          { "type", 0, 0, "", "int|float|string", "type of the value; not given: as the value looks" } },
    };
    return table;
}

}  // namespace pimg

namespace pimgtool {

namespace {

using pimg::format;

/// Moves keys behind the name of a file, as in a.pimg:profile=compact, to those of the call.
bool take_keys(std::string& filename, Call& call, std::string& error)
{
    for (const char* extension : { ".pimg:", ".jpg:", ".jpeg:" }) {
        const std::size_t found = OIIO::Strutil::lower(filename).rfind(extension);
        if (found == std::string::npos)
            continue;
        const std::size_t colon = filename.find(':', found);
        if (!split_keys(filename.substr(colon), call, error))
            return false;
        filename.erase(colon);
    }
    return true;
}

/// What the keys of -o say; each kind of file has its own.
struct OutputKeys {
    pimg::io::WriteOptions pimg;
    GainMapRequest jpeg;
};

bool parse_output_keys(const std::string& filename, const Call& call, OutputKeys& keys, std::string& error)
{
    keys.pimg.profile = "full";
    const OutputKeys defaults = keys;
    const std::vector<pimg::OptionInfo> of_jpeg = pimg::describe_options<GainMapRequest>();
    for (const auto& [key, value] : call.keys) {
        const bool is_jpeg_key = has_jpeg_extension(filename)
            || std::any_of(of_jpeg.begin(), of_jpeg.end(),
                           [&name = key](const auto& info) { return info.is_called(name); });
        if (!(is_jpeg_key ? pimg::set_option(keys.jpeg, key, value, error)
                          : pimg::set_option(keys.pimg, key, value, error)))
            return false;
        const bool fits = is_jpeg_key ? has_jpeg_extension(filename) || pimg::same_options(keys.jpeg, defaults.jpeg)
                                      : has_pimg_extension(filename);
        if (!fits) {
            error = format("{}: expected a {} file, not \"{}\"", key, is_jpeg_key ? ".jpg" : ".pimg", filename);
            return false;
        }
    }
    if (!keys.jpeg.gainmap && !pimg::same_options(keys.jpeg, defaults.jpeg)) {
        error = format("{}: expected gainmap=1 with it", call.keys.front().first);
        return false;
    }
    return true;
}

/// -o:profile=compact a.pimg, or the same as -o a.pimg:profile=compact. A .pimg file keeps the hierarchy unless told
/// otherwise.
bool output_file(const Call& call, Program& program, std::string& error)
{
    Call with_keys = call;
    std::string filename = call.words[0];
    OutputKeys keys;
    if (!take_keys(filename, with_keys, error) || !parse_output_keys(filename, with_keys, keys, error))
        return false;
    if (!can_write(filename, error)) {
        error = format("cannot write \"{}\": {}", filename, error);
        return false;
    }
    program.gain_maps |= keys.jpeg.gainmap;
    program.written.push_back(filename);
    program.dangling.clear();
    const auto write = [=](Session& session) {
        return keys.jpeg.gainmap ? session.write(filename, keys.jpeg) : session.write(filename, keys.pimg);
    };
    program.steps.push_back({ call.command->name, write, true });
    return true;
}

std::vector<pimg::OptionInfo> output_keys()
{
    std::vector<pimg::OptionInfo> keys = pimg::describe_options<pimg::io::WriteOptions>();
    for (pimg::OptionInfo& key : keys)
        if (key.key == "profile")
            key.default_value = "full";
    for (const pimg::OptionInfo& key : pimg::describe_options<GainMapRequest>())
        keys.push_back(key);
    return keys;
}

bool gainmap(const Call& call, Program& program, std::string&)
{
    program.steps.push_back({ call.command->name, [](Session& session) {
                                 return session.take_rendition();
                             } });
    return true;
}

bool info(const Call& call, Program& program, std::string& error)
{
    const std::string filename = call.words[0];
    const bool will_exist = std::count(program.written.begin(), program.written.end(), filename) > 0;
    if (!will_exist && !OIIO::Filesystem::is_regular(filename)) {
        error = format("cannot read \"{}\": no such file", filename);
        return false;
    }
    program.informs = true;
    program.steps.push_back({ call.command->name, [=](Session& session) {
                                 std::string text;
                                 if (!describe_file(filename, text))
                                     return session.fail(text);
                                 std::fputs(text.c_str(), stdout);
                                 return true;
                             } });
    return true;
}

/// -d TYPE, or -d CHANNEL=TYPE for one channel or all of a layer.
bool pixel_type(const Call& call, Program& program, std::string& error)
{
    const std::size_t equals = call.words[0].rfind('=');
    const std::string channel = call.words[0].substr(0, equals == std::string::npos ? 0 : equals);
    const OIIO::TypeDesc type = output_type(call.words[0].substr(equals == std::string::npos ? 0 : equals + 1));
    if (type == OIIO::TypeUnknown || equals == 0) {
        error = format("\"{}\": expected one of {}, or CHANNEL=TYPE", call.words[0], kOutputTypes);
        return false;
    }
    program.dangling = call.command->name;
    program.steps.push_back({ call.command->name, [=](Session& session) {
                                 if (channel.empty())
                                     session.output.type = type;
                                 else
                                     session.output.channel_types[channel] = type;
                                 return true;
                             } });
    return true;
}

bool part(const Call& call, Program& program, std::string& error)
{
    if (call.words[0].empty()) {
        error = "\"\": expected a number from 0, a name, or all";
        return false;
    }
    program.dangling_input = call.command->name;
    program.steps.push_back({ call.command->name, [part = call.words[0]](Session& session) {
                                 session.input.part = part;
                                 return true;
                             } });
    return true;
}

bool iconfig(const Call& call, Program& program, std::string& error)
{
    HintOptions options;
    OIIO::ImageSpec checked;
    if (!pimg::set_options(options, call.keys, error)
        || !add_reader_hint(checked, call.words[0], call.words[1], options.type, error))
        return false;
    program.dangling_input = call.command->name;
    program.steps.push_back({ call.command->name, [checked](Session& session) {
                                 for (const OIIO::ParamValue& hint : checked.extra_attribs)
                                     session.input.config.extra_attribs.add_or_replace(hint);
                                 return true;
                             } });
    return true;
}

bool autoorient(const Call&, Program& program, std::string&)
{
    return program.autoorient = true;
}

bool raw(const Call& call, Program& program, std::string&)
{
    program.dangling = call.command->name;
    program.steps.push_back({ call.command->name, [](Session& session) {
                                 return session.output.raw = true;
                             } });
    return true;
}

// ---- sequences --------------------------------------------------------------------------------------------

bool frames(const Call& call, Program& settings, std::string& error)
{
    // A shot of an hour has 90 000 frames; numbers have at most seven digits, so that no range fills the memory.
    constexpr std::size_t kMostFrames = 100000, kMostDigits = 7;
    const std::string& text = call.words[0];
    bool fine = text.find_first_not_of("0123456789-,xy") == text.npos;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const std::size_t end = std::min(text.find_first_not_of("0123456789", at), text.size());
        fine = fine && end - at <= kMostDigits;
        at = end;
    }
    for (const std::string& range : OIIO::Strutil::splits(text, ",")) {
        std::vector<int> numbers;
        fine = fine && OIIO::Filesystem::enumerate_sequence(range, numbers)
            && numbers.size() + settings.frames.size() <= kMostFrames;
        if (fine)
            settings.frames.insert(settings.frames.end(), numbers.begin(), numbers.end());
    }
    if (fine && !settings.frames.empty())
        return true;
    error = format("\"{}\": expected at most {} frames such as 1-240, 1-240x2 or 1,5,9-12", text, kMostFrames);
    return false;
}

bool views(const Call& call, Program& settings, std::string& error)
{
    settings.views = OIIO::Strutil::splits(call.words[0], ",");
    if (std::count(settings.views.begin(), settings.views.end(), "") == 0 && !settings.views.empty())
        return true;
    error = format("\"{}\": expected names of views, such as left,right", call.words[0]);
    return false;
}

bool parallel_frames(const Call&, Program& settings, std::string&)
{
    return settings.parallel_frames = true;
}

bool shot_stats(const Call& call, Program& settings, std::string& error)
{
    settings.shot_file = call.words[0];
    if (!settings.shot_file.empty() && !OIIO::Filesystem::is_directory(settings.shot_file))
        return pimg::set_options(settings.shot, call.keys, error) && pimg::Shot::check_cuts(settings.shot.cuts, error);
    error = format("\"{}\": expected a file's name", settings.shot_file);
    return false;
}

}  // namespace

CommandGroup sequence_group()
{
    return {
        "Sequences",
        {
            general_setting("--frames", "RANGE",
                            "runs the command line for every frame: 1-240, 1-240x2, 1,5-7; in names, # is its number "
                            "as %04d, @ as %d",
                            frames),
            general_setting("--views", "NAMES",
                            "runs it for every view, too: left,right; in names, %V is the view and %v its first letter",
                            views),
            general_setting("--parallel-frames", "", "works on several frames at a time, each with one thread",
                            parallel_frames),
            general_setting("--shot-stats", "FILE",
                            "--hdr-compress exposes the frames alike, as FILE says; measured first if there is no FILE",
                            shot_stats, pimg::describe_options<pimg::ShotOptions>),
        }
    };
}

CommandGroup input_group()
{
    return {
        "Input",
        {
            setting("--part", "PART",
                    "which part of the files after it is the picture: a number from 0, a name, or all, to keep them",
                    part),
            { "--gainmap", "", "takes the HDR rendition of the JPEG file before it, which has a gain map, not its base",
              1, 0, nullptr, gainmap },
            setting("--iconfig", "NAME VALUE",
                    "a hint for readers of the files after it: oiio:UnassociatedAlpha 1 keeps colours under alpha 0",
                    iconfig, pimg::describe_options<HintOptions>),
        }
    };
}

CommandGroup output_group()
{
    return {
        "Output",
        {
            { "-o", "FILE", "writes the top picture, which stays on the stack; the keys are for .pimg and .jpg files",
              1, 0, output_keys, output_file },
            setting("--info", "FILE", "prints what is in a .pimg file: windows, channels, sizes of its parts", info),
            setting("-d", "TYPE",
                    "pixel type of the files written after it: uint8, uint16, half, float ...; CHANNEL=TYPE for one",
                    pixel_type),
            setting("--autoorient", "",
                    "turns pictures upright as their metadata ask; done anyway unless only JPEG and TIFF are written",
                    autoorient),
            setting("--raw", "",
                    "writes samples unchanged; otherwise linear light is encoded as sRGB in files of whole numbers",
                    raw),
        }
    };
}

}  // namespace pimgtool
