// SPDX-License-Identifier: BSD-3-Clause
// The table of all commands. To add a filter: one row, naming its options struct (whose table has the keys) and
// its function; an operation of another kind has a row and a small function.
#include <algorithm>
#include <cstdio>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>
#include <pimg/imagebufalgo.h>

#include "colour.h"
#include "command.h"
#include "output.h"
#include "pimg_file.h"

namespace pimgtool {

/// Keys of --stats.
struct StatsOptions {
    std::string format = "text";
};

}  // namespace pimgtool

namespace pimg {

template<>
const std::vector<Option<pimgtool::StatsOptions>>& option_table<pimgtool::StatsOptions>()
{
    static const std::vector<Option<pimgtool::StatsOptions>> table = {
        { &pimgtool::StatsOptions::format, { "format", 0, 0, "", "text|json", "json is for programs to read" } },
    };
    return table;
}

}  // namespace pimg

namespace pimgtool {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::Strutil::fmt::format;

using Words = std::vector<std::string>;

// ---- kinds of rows ----------------------------------------------------------------------------------------

template<class Options>
bool read_keys(const Call& call, Options& options, std::string& error)
{
    for (const auto& [key, value] : call.keys)
        if (!pimg::set_option(options, key, value, error))
            return false;
    return pimg::check_options(options, error);
}

/// An operation with keys.
template<class Options>
Command operation(const char* name, const char* help, bool (*run)(Session&, const Options&))
{
    const auto prepare = [run](const Call& call, Program& program, std::string& error) {
        Options options;
        if (!read_keys(call, options, error))
            return false;
        program.steps.push_back({ call.command->name, [=](Session& session) {
                                     return run(session, options);
                                 } });
        return true;
    };
    return { name, "", help, 1, 0, pimg::describe_options<Options>, prepare };
}

template<class Options>
using FilterFunction = bool (*)(ImageBuf&, const pimg::ProgressiveImage&, const Options&, OIIO::ROI, int);

/// A filter on the hierarchy of the top picture. The result is one sweep away once the hierarchy is there.
template<class Options>
Command filter(const char* name, const char* help, FilterFunction<Options> function,
               Meaning meaning = Meaning::as_before)
{
    const auto prepare = [=](const Call& call, Program& program, std::string& error) {
        Options options;
        if (!read_keys(call, options, error))
            return false;
        const auto run = [=](ImageBuf& dst, const pimg::ProgressiveImage& src) {
            return function(dst, src, options, {}, 0);
        };
        program.steps.push_back({ call.command->name, [=](Session& session) {
                                     return session.filter(run, meaning);
                                 } });
        return true;
    };
    return { name, "", help, 1, 0, pimg::describe_options<Options>, prepare };
}

/// An operation with words instead of keys, and what can be said about the words beforehand.
Command worded(const char* name, const char* words, const char* help, bool (*run)(Session&, const Words&),
               bool (*check)(const Words&, std::string& error) = nullptr)
{
    const auto prepare = [=](const Call& call, Program& program, std::string& error) {
        if (check && !check(call.words, error))
            return false;
        program.steps.push_back({ call.command->name, [run, words = call.words](Session& session) {
                                     return run(session, words);
                                 } });
        return true;
    };
    return { name, words, help, 1, 0, nullptr, prepare };
}

/// Rearranges the stack.
Command shuffle(const char* name, const char* help, int needs, int adds, void (*run)(std::vector<Picture>&))
{
    const auto prepare = [=](const Call& call, Program& program, std::string&) {
        program.steps.push_back({ call.command->name, [=](Session& session) {
                                     run(session.stack);
                                     return true;
                                 } });
        return true;
    };
    return { name, "", help, needs, adds, nullptr, prepare };
}

using Prepare = bool (*)(const Call&, Program&, std::string& error);
using Keys = std::vector<pimg::OptionInfo> (*)();

/// Something about files, or about the whole command line.
Command setting(const char* name, const char* words, const char* help, Prepare prepare, Keys keys = nullptr)
{
    return { name, words, help, 0, 0, keys, prepare };
}

// ---- hierarchies ------------------------------------------------------------------------------------------

bool build(Session& session, const pimg::BuildOptions& options)
{
    return session.build(options);
}

// ---- channels and colour ----------------------------------------------------------------------------------

/// Converts the colours of the top picture, in floating point, so that nothing is rounded before the file is written.
bool convert_colours(Session& session, const OIIO::ColorProcessorHandle& processor, const std::string& space)
{
    const bool done = session.change_pixels([&](ImageBuf& dst, const ImageBuf& src) {
        ImageSpec spec = src.spec();
        spec.set_format(OIIO::TypeFloat);
        declare_space(spec, space);
        dst.reset(spec);
        return OIIO::ImageBufAlgo::colorconvert(dst, src, processor.get(), true);
    });
    if (done)
        session.top().linear_light = false;  // converted as the user wants it
    return done;
}

bool check_colorconvert(const Words& words, std::string& error)
{
    return bool(conversion(words[0], words[1], error));
}

bool colorconvert(Session& session, const Words& words)
{
    std::string error;
    const OIIO::ColorProcessorHandle processor = conversion(words[0], words[1], error);
    return processor ? convert_colours(session, processor, words[1]) : session.fail(error);
}

std::string space_of(const Picture& picture)
{
    return configured_space(picture.pixels->spec().get_string_attribute("oiio:ColorSpace", "Linear"));
}

bool check_tocolorspace(const Words& words, std::string& error)
{
    return bool(conversion("linear", words[0], error));
}

bool tocolorspace(Session& session, const Words& words)
{
    return colorconvert(session, { space_of(session.top()), words[0] });
}

bool check_ociodisplay(const Words& words, std::string& error)
{
    std::string display = words[0], view = words[1];
    return find_display(display, view, error);
}

bool ociodisplay(Session& session, const Words& words)
{
    std::string display = words[0], view = words[1], error;
    OIIO::ColorProcessorHandle processor;
    if (find_display(display, view, error))
        processor = display_transform(display, view, space_of(session.top()), error);
    return processor ? convert_colours(session, processor, display_space(display, view)) : session.fail(error);
}

bool incolorspace(Session& session, const Words& words)
{
    const bool done = session.change_pixels([&](ImageBuf& dst, const ImageBuf& src) {
        if (!dst.copy(src))
            return false;
        declare_space(dst.specmod(), words[0]);
        return true;
    });
    Picture& top = session.top();
    top.linear_light = top.stored.all.is_floating_point() && is_linear_space(words[0]);
    return done;
}

bool channels(Session& session, const Words& words)
{
    const ImageSpec& spec = session.top().pixels->spec();
    std::vector<int> order;
    for (const std::string& name : OIIO::Strutil::splits(words[0], ",")) {
        order.push_back(spec.channelindex(name));
        if (order.back() < 0)
            return session.fail(
                format("no channel \"{}\": expected some of {}", name, OIIO::Strutil::join(spec.channelnames, ", ")));
    }
    if (order.empty())
        return session.fail("\"\": expected names of channels, such as R,G,B");
    PixelTypes stored = session.top().stored;
    if (int(stored.per_channel.size()) == spec.nchannels) {
        const std::vector<OIIO::TypeDesc> before = std::exchange(stored.per_channel, {});
        for (const int c : order)
            stored.per_channel.push_back(before[std::size_t(c)]);
    }
    const bool done = session.change_pixels([&](ImageBuf& dst, const ImageBuf& src) {
        return OIIO::ImageBufAlgo::channels(dst, src, int(order.size()), order);
    });
    session.top().stored = stored;
    return done;
}

// ---- files and settings -----------------------------------------------------------------------------------

/// -o:profile=compact a.pimg, or the same as -o a.pimg:profile=compact. A file keeps the hierarchy unless told otherwise.
bool output_file(const Call& call, Program& program, std::string& error)
{
    Call keys = call;
    std::string filename = call.words[0];
    const std::size_t colon = filename.rfind(".pimg:");
    if (colon != std::string::npos) {
        if (!split_keys(filename.substr(colon + 5), keys, error))
            return false;
        filename.erase(colon + 5);
    }
    pimg::io::WriteOptions options;
    options.profile = "full";
    if (!read_keys(keys, options, error))
        return false;
    if (!keys.keys.empty() && !has_pimg_extension(filename)) {
        error = format("{} is for .pimg files, \"{}\" is none", keys.keys[0].first, filename);
        return false;
    }
    if (!can_write(filename, error)) {
        error = format("cannot write \"{}\": {}", filename, error);
        return false;
    }
    program.written.push_back(filename);
    program.dangling.clear();
    program.steps.push_back({ call.command->name, [=](Session& session) {
                                 return session.write(filename, options);
                             } });
    return true;
}

std::vector<pimg::OptionInfo> output_keys()
{
    std::vector<pimg::OptionInfo> keys = pimg::describe_options<pimg::io::WriteOptions>();
    for (pimg::OptionInfo& key : keys)
        if (key.key == "profile")
            key.default_value = "full";
    return keys;
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

bool pixel_type(const Call& call, Program& program, std::string& error)
{
    const OIIO::TypeDesc type = output_type(call.words[0]);
    if (type == OIIO::TypeUnknown) {
        error = format("\"{}\": expected one of {}", call.words[0], kOutputTypes);
        return false;
    }
    program.dangling = call.command->name;
    program.steps.push_back({ call.command->name, [=](Session& session) {
                                 session.output.type = type;
                                 return true;
                             } });
    return true;
}

bool raw(const Call& call, Program& program, std::string&)
{
    program.dangling = call.command->name;
    program.steps.push_back({ call.command->name, [](Session& session) {
                                 return session.output.raw = true;
                             } });
    return true;
}

bool threads(const Call& call, Program& program, std::string& error)
{
    const pimg::OptionRule rule = { "N", 0, 1024, "", "", "" };
    pimg::OptionValue value = 0;
    if (!pimg::parse_option(rule, call.words[0], value, error))
        return false;
    program.threads = std::get<int>(value);
    return true;
}

bool stats(const Call& call, Program& program, std::string& error)
{
    StatsOptions options;
    if (!read_keys(call, options, error))
        return false;
    program.stats = options.format;
    return true;
}

bool verbose(const Call&, Program& program, std::string&)
{
    return program.verbose = true;
}

/// --help and --version answer before anything else is looked at; they are in the table to be listed.
bool answered_already(const Call&, Program&, std::string&)
{
    return true;
}

// ---- the table --------------------------------------------------------------------------------------------

CommandGroup filters_group()
{
    namespace iba = pimg::ImageBufAlgo;
    return { "Filters on the progressive image of the top picture",
             {
                 operation<pimg::BuildOptions>(
                     "--build", "builds the progressive image now, as the filters that follow are to use it", build),
                 filter<pimg::LevelOptions>(
                     "--level", "picture of a coarser mesh; at most one key, none for the finest", iba::level_image),
                 filter<pimg::WireframeOptions>("--wireframe", "edges of the mesh of a level, chosen as for --level",
                                                iba::wireframe),
                 filter<pimg::FeatureLowpassOptions>("--feature-lowpass",
                                                     "drops small features and keeps the edges of large ones",
                                                     iba::feature_lowpass),
                 filter<pimg::DetailEnhanceOptions>("--detail-enhance", "amplifies the details of a range of splits",
                                                    iba::detail_enhance),
                 filter<pimg::HdrCompressOptions>("--hdr-compress",
                                                  "fits high dynamic range to a display: linear light, white at 1",
                                                  iba::hdr_compress, Meaning::display_linear),
                 filter<pimg::DualPiecesOptions>(
                     "--dual-pieces", "pixels that each vertex of a level stands for, chosen as for --level",
                     iba::dual_pieces),
                 filter<pimg::SegmentOptions>("--segment", "merges what looks alike into connected regions",
                                              iba::segment),
                 filter<pimg::PaintOptions>("--paint", "paints with brush strokes that follow the picture's forms",
                                            iba::paint),
                 filter<pimg::MosaicOptions>("--mosaic", "lays the pieces of a level as tiles", iba::mosaic),
                 filter<pimg::InkOptions>("--ink", "draws with pen and ink", iba::ink),
             } };
}

CommandGroup colour_group()
{
    return { "Channels and colour",
             {
                 worded("--ch", "NAMES", "keeps the channels named, in that order: R,G,B", channels),
                 worded("--incolorspace", "SPACE", "says which colour space the top picture is in", incolorspace),
                 worded("--colorconvert", "FROM TO", "converts between colour spaces", colorconvert,
                        check_colorconvert),
                 worded("--tocolorspace", "SPACE", "converts from the space the picture says it is in", tocolorspace,
                        check_tocolorspace),
                 worded("--ociodisplay", "DISPLAY VIEW", "OpenColorIO's display transform; \"default\" for either",
                        ociodisplay, check_ociodisplay),
             } };
}

CommandGroup stack_group()
{
    using Stack = std::vector<Picture>;
    return { "The stack of pictures",
             {
                 shuffle("--dup", "puts a copy of the top picture on the stack; both share one progressive image", 1, 1,
                         [](Stack& stack) { stack.push_back(Picture(stack.back())); }),
                 shuffle("--pop", "takes the top picture off the stack", 1, -1, [](Stack& stack) { stack.pop_back(); }),
                 shuffle("--swap", "exchanges the two top pictures", 2, 0,
                         [](Stack& stack) { std::swap(stack.back(), stack[stack.size() - 2]); }),
             } };
}

CommandGroup output_group()
{
    return { "Output",
             {
                 { "-o", "FILE", "writes the top picture, which stays on the stack; keys are for .pimg files", 1, 0,
                   output_keys, output_file },
                 setting("--info", "FILE", "prints what is in a .pimg file: windows, channels, sizes of its parts", info),
                 setting("-d", "TYPE",
                         "pixel type of the files that follow: uint8, uint16, half, float ...; else the input's",
                         pixel_type),
                 setting("--raw", "",
                         "writes the numbers as they are; else linear light is encoded sRGB in files of whole numbers",
                         raw),
             } };
}

CommandGroup general_group()
{
    return { "General",
             {
                 setting("--threads", "N", "threads to use; 0, the default: one per core. Results do not depend on it",
                         threads),
                 setting("--stats", "", "prints sizes, seconds per stage and peak memory when all is done", stats,
                         pimg::describe_options<StatsOptions>),
                 setting("-v", "", "says what is done, and how long it took, on standard error", verbose),
                 setting("--help", "", "lists all commands, or explains the one named after it", answered_already),
                 setting("--version", "", "prints the versions of pimgtool and OpenImageIO", answered_already),
             } };
}

}  // namespace

const std::vector<CommandGroup>& command_table()
{
    static const std::vector<CommandGroup> table = { filters_group(), colour_group(), stack_group(), output_group(),
                                                     general_group() };
    return table;
}

}  // namespace pimgtool
