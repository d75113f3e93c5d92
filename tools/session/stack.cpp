// SPDX-License-Identifier: BSD-3-Clause
#include "session/stack.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/oiio_compat.h>
#include <pimg/detail/parts.h>
#include <pimg/imagebufalgo.h>
#include <pimg/labels.h>

#include "session/colour.h"
#include "session/progress_bar.h"

namespace pimgtool {

namespace {

using pimg::format;

PixelTypes pixel_types(const OIIO::ImageSpec& stored)
{
    return { stored.format, stored.channelformats };
}

/// The types that -d asks for. Channels that hold data keep their own unless -d names them.
PixelTypes asked_types(const OIIO::ImageSpec& spec, const PixelTypes& stored, const OutputOptions& output,
                       const std::string& layer)
{
    PixelTypes types { output.type != OIIO::TypeUnknown ? output.type : stored.all, {} };
    pimg::Colour colour;
    std::string error;
    OIIO::ImageSpec as_stored = spec;
    as_stored.format = stored.all;
    if (int(stored.per_channel.size()) == spec.nchannels)
        as_stored.channelformats = stored.per_channel;
    const bool known = pimg::Colour::resolve(as_stored, "", layer, colour, error);
    for (int c = 0; c < spec.nchannels; ++c) {
        const bool keeps = output.type == OIIO::TypeUnknown || (known && pimg::holds_data(as_stored, c, colour));
        types.per_channel.push_back(keeps ? as_stored.channelformat(c) : output.type);
        const std::string name = spec.channel_name(c);
        for (const auto& [asked, type] : output.channel_types)
            if (name == asked || OIIO::Strutil::starts_with(name, asked + "."))
                types.per_channel.back() = type;
    }
    if (std::count(types.per_channel.begin(), types.per_channel.end(), types.all) == spec.nchannels)
        types.per_channel.clear();
    return types;
}

std::string describe(const OIIO::ImageSpec& stored)
{
    return format("{} x {}, {} channel{}, {}, taken as {}", stored.width, stored.height, stored.nchannels,
                  stored.nchannels == 1 ? "" : "s", stored.format.c_str(), meaning_of(stored).description());
}

/// A key for a file as it is read: its name and the settings of the reader.
std::string key_of(const std::string& filename, const InputOptions& settings)
{
    std::string key = filename + "\n" + settings.part;
    for (const OIIO::ParamValue& hint : settings.config.extra_attribs)
        key += "\n" + hint.name().string() + "=" + hint.get_string();
    return key;
}

Picture picture_of(const std::string& filename, const InputPart& part)
{
    Picture picture;
    picture.name = filename;
    picture.pixels = part.pixels;
    picture.stored = pixel_types(part.stored);
    picture.linear_light = holds_linear_light(part.stored);
    picture.is_straight = part.stored.get_int_attribute(pimg::io::kUnassociatedAlpha) != 0;
    picture.part = part.number;
    picture.hierarchy = std::make_shared<LazyHierarchy>();
    return picture;
}

std::string label(const char* doing, const std::string& filename)
{
    return format("{} {}", doing, OIIO::Filesystem::filename(filename));
}

}  // namespace

bool Session::fail(std::string message)
{
    m_error = std::move(message);
    return false;
}

void Session::say(const std::string& line) const
{
    if (verbose)
        std::fprintf(stderr, "%s\n", line.c_str());
}

bool Session::read(const std::string& filename)
{
    const bool again = --m_reads_left[filename] > 0;
    const std::string key = key_of(filename, input);
    const auto kept = m_kept.find(key);
    if (kept != m_kept.end()) {
        stack.push_back(kept->second);
        if (!again)
            m_kept.erase(kept);
        return true;
    }
    const StageTimer timer(stats, Stage::read);
    ProgressBar bar(label("reading", filename));
    InputFile file;
    std::string error;
    if (!read_file(
            filename, input, [&](float done) { bar.show(done); }, file, error))
        return fail(format("cannot read \"{}\": {}", filename, error));
    if (!file.warning.empty())
        std::fprintf(stderr, "pimgtool: warning: \"%s\": %s\n", filename.c_str(), file.warning.c_str());
    Picture picture = picture_of(filename, file.parts[0]);
    for (std::size_t i = 1; i < file.parts.size(); ++i)
        picture.others.push_back(picture_of(filename, file.parts[i]));
    if (pimg::io::file_of(file.path) == file.path && !file.parts[0].turned)
        picture.hierarchy->stored = StoredHierarchy::open(file.path, file.parts[0].stored);
    say(format("{}: {}, {:.2f} s", filename, describe(file.parts[0].stored), timer.seconds()));
    stack.push_back(picture);
    if (again)
        m_kept[key] = picture;
    return true;
}

OutputPicture Session::output_of(const Picture& picture) const
{
    OutputPicture out { *picture.pixels, picture.stored, picture.linear_light && !output.raw, picture.labels };
    out.layer = picture.hierarchy->options.layer;
    out.is_straight = picture.is_straight;
    out.is_gain = picture.is_gain;
    out.part = part_name(picture.pixels->spec(), picture.part);
    if (picture.labels) {
        out.types = { output.type, {} };
        out.encode_srgb = false;
    } else if (output.type != OIIO::TypeUnknown || !output.channel_types.empty())
        out.types = asked_types(out.pixels.spec(), picture.stored, output, out.layer);
    return out;
}

bool Session::write(const std::string& filename, const GainMapRequest& request)
{
    if (!top().rendition)
        return fail(
            format("cannot write \"{}\": gainmap: expected the result of --hdr-compress for SDR displays", filename));
    return write(filename, pimg::io::WriteOptions(), [&](std::string& bytes, std::string& error) {
        return add_rendition(request, top().rendition, bytes, error);
    });
}

bool Session::take_rendition()
{
    auto pixels = std::make_shared<OIIO::ImageBuf>();
    if (!read_rendition(top().name, input.upright, *pixels, m_error))
        return false;
    Picture picture = picture_of(top().name, { pixels, pixels->spec(), 0, false });
    picture.hierarchy->options = top().hierarchy->options;
    top() = picture;
    return true;
}

bool Session::write(const std::string& filename, const pimg::io::WriteOptions& options)
{
    return write(filename, options, {});
}

bool Session::write(const std::string& filename, const pimg::io::WriteOptions& options,
                    const std::function<bool(std::string& bytes, std::string& error)>& finish)
{
    pimg::ProgressiveImage stored;
    if (has_pimg_extension(filename) && options.profile == "full") {
        const pimg::ProgressiveImage* image = hierarchy_of(top());
        if (!image)
            return false;
        stored = image->unwrapped(*top().pixels);
        if (!stored.initialized())
            return fail(format("cannot write \"{}\": {}", filename, stored.error()));
    }
    const StageTimer timer(stats, Stage::write);
    std::vector<const Picture*> parts { &top() };
    for (const Picture& other : top().others)
        parts.push_back(&other);
    std::sort(parts.begin(), parts.end(), [](const Picture* a, const Picture* b) { return a->part < b->part; });
    std::vector<OutputPicture> out;
    out.reserve(parts.size());
    for (const Picture* part : parts)
        out.push_back(output_of(*part));
    const auto picture = std::size_t(std::find(parts.begin(), parts.end(), &top()) - parts.begin());
    out[picture].hierarchy = stored.initialized() ? &stored.hierarchy() : nullptr;
    out[picture].options = options;
    out[picture].finish = finish;
    ProgressBar bar(label("writing", filename));
    std::string summary, warning, error;
    const auto show = [&](float done) {
        bar.show(done);
    };
    if (!write_parts(out, picture, filename, show, { summary, warning, error }))
        return fail(format("cannot write \"{}\": {}", filename, error));
    if (!warning.empty())
        std::fprintf(stderr, "pimgtool: warning: \"%s\": %s\n", filename.c_str(), warning.c_str());
    // From now on this name means the new file, so pictures kept of the old one are dropped.
    for (auto kept = m_kept.begin(); kept != m_kept.end();)
        kept = kept->second.name == filename ? m_kept.erase(kept) : std::next(kept);
    pimg::forget_in_shared_cache(filename);
    say(format("{}: wrote {}, {:.2f} s", filename, summary, timer.seconds()));
    return true;
}

bool Session::build(const pimg::BuildOptions& options)
{
    // Copies that were made earlier keep their hierarchy.
    const auto set = [&](Picture& picture) {
        if (!pimg::same_options(picture.hierarchy->options, options))
            picture.hierarchy = std::make_shared<LazyHierarchy>(LazyHierarchy { options, nullptr, {} });
        return true;
    };
    return for_parts(set) && hierarchy_of(top()) != nullptr;
}

bool Session::for_parts(const std::function<bool(Picture&)>& work)
{
    Picture result = top();
    if (!work(result))
        return false;
    for (Picture& other : result.others)
        if (pimg::holds_picture(other.pixels->spec(), top().hierarchy->options.layer) && !work(other))
            return fail(format("part {}: {}", part_name(other.pixels->spec(), other.part), error()));
    top() = result;
    return true;
}

const pimg::ProgressiveImage* Session::hierarchy_of(const Picture& picture)
{
    LazyHierarchy& lazy = *picture.hierarchy;
    if (lazy.image.initialized())
        return &lazy.image;
    ProgressBar bar(label("building", picture.name));
    const auto show = [&](float done) {
        bar.show(done);
        return true;
    };
    if (lazy.stored ? !lazy.stored->read(*picture.pixels, lazy.options, lazy.image)
                    : !lazy.image.build(*picture.pixels, lazy.options, 0, show)) {
        fail(lazy.image.error());
        return nullptr;
    }
    const pimg::Hierarchy& hierarchy = lazy.image.hierarchy();
    const bool is_read = lazy.stored && lazy.image.stats().wrap == "none";
    stats.add(picture.name, lazy.image);
    say(format("{}: {} {} vertices, {} splits, {:.2f} s", picture.name, is_read ? "read" : "built",
               hierarchy.vertices(), hierarchy.levels(), lazy.image.stats().simplify_seconds));
    if (lazy.image.stats().wrap != "none")
        say(format("{}: opposite sides meet: wrap={}{}", picture.name, lazy.image.stats().wrap,
                   lazy.options.wrap.empty() ? ", as its metadata say it is a lat-long panorama" : ""));
    return &lazy.image;
}

bool Session::filter(const Filter& run, Meaning meaning)
{
    return for_parts([&](Picture& picture) { return filter(picture, run, meaning); });
}

bool Session::filter(Picture& picture, const Filter& run, Meaning meaning)
{
    const pimg::ProgressiveImage* source = hierarchy_of(picture);
    if (!source)
        return false;
    const StageTimer timer(stats, Stage::filter);
    auto result = std::make_shared<OIIO::ImageBuf>();
    if (!run(*result, *source))
        return fail(result->has_error() ? result->geterror() : "failed");
    picture.pixels = result;
    picture.rendition = {};
    // The options of the first build hold for the next one, except the colour space, which the result states itself, and
    // that a quick look was wanted.
    const pimg::BuildOptions options = picture.hierarchy->options;
    picture.hierarchy = std::make_shared<LazyHierarchy>();
    picture.hierarchy->options = options;
    picture.hierarchy->options.incolorspace.clear();
    picture.hierarchy->options.preview = false;
    if (meaning == Meaning::display_linear)
        picture.linear_light = true;
    picture.is_gain = meaning == Meaning::gain;
    if (picture.is_gain)
        picture.stored = pixel_types(result->spec());
    picture.labels = result->spec().format == OIIO::TypeUInt32 && result->spec().find_attribute(pimg::kLabelCount);
    say(format("{}: filtered, {:.3f} s", picture.name, timer.seconds()));
    return true;
}

bool Session::hdr_compress(pimg::HdrCompressOptions options)
{
    namespace iba = pimg::ImageBufAlgo;
    if (measuring) {
        if (!iba::resolve_hdr_compress(*top().pixels, options, m_error, top().hierarchy->options))
            return false;
        float light = 0.0f;
        if (!pimg::median_light(*top().pixels, top().hierarchy->options.incolorspace, light, m_error))
            return false;
        if (light > 0.0f)  // else nothing was measured
            anchors = { options.dmax, options.key, options.white, light };
        return measured = true;
    }
    anchors.apply(options);
    // All parts get the same exposure, because they are views and passes of one scene.
    if (!top().others.empty() && !iba::resolve_hdr_compress(*top().pixels, options, m_error, top().hierarchy->options))
        return false;
    if (options.output != "display" && !top().others.empty())
        return fail("output: expected one part, as each would get a gain of its own: --part PART before the file");
    const auto run = [&](OIIO::ImageBuf& dst, const pimg::ProgressiveImage& src) {
        return iba::hdr_compress(dst, src, options) && describe_fit(src, options);
    };
    const std::shared_ptr<LazyHierarchy> source = top().hierarchy;
    if (!filter(run, options.output == "gain" ? Meaning::gain : Meaning::display_linear))
        return false;
    const pimg::HdrCompressOptions for_sdr;
    if (options.output == for_sdr.output && options.peak == for_sdr.peak && options.fit && keeps_renditions)
        top().rendition = [source, options](OIIO::ImageBuf& dst, float peak) mutable {
            options.peak = peak;
            return iba::hdr_compress(dst, source->image, options);
        };
    return true;
}

bool Session::describe_fit(const pimg::ProgressiveImage& image, pimg::HdrCompressOptions options)
{
    if (verbose && pimg::ImageBufAlgo::resolve_hdr_compress(image, options, m_error))
        say(format("{}: s0={:.3g} dmax={:.3g} detail={:.3g} key={:.3g} white={:.3g}", top().name, options.s0,
                   options.dmax, options.detail, options.key, options.white));
    return true;
}

bool Session::change_pixels(const PixelOperation& run)
{
    return for_parts([&](Picture& picture) { return change_pixels(picture, run); });
}

bool Session::change_pixels(Picture& picture, const PixelOperation& run)
{
    const StageTimer timer(stats, Stage::filter);
    auto result = std::make_shared<OIIO::ImageBuf>();
    if (!run(*result, *picture.pixels))
        return fail(result->has_error() ? result->geterror() : "failed");
    auto hierarchy = std::make_shared<LazyHierarchy>();
    hierarchy->options = picture.hierarchy->options;
    picture.pixels = result;
    picture.rendition = {};
    picture.hierarchy = hierarchy;
    return true;
}

}  // namespace pimgtool
