// SPDX-License-Identifier: BSD-3-Clause
#include "session/stack.h"

#include <algorithm>
#include <cstdio>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
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

/// Types as -d asks for them: channels of data keep theirs unless named.
PixelTypes asked_types(const OIIO::ImageSpec& spec, const PixelTypes& stored, const OutputSettings& output,
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

/// What Orientation of the metadata asks for.
bool turn_upright(OIIO::ImageBuf& pixels)
{
    OIIO::ImageBuf turned;
    if (!OIIO::ImageBufAlgo::reorient(turned, pixels)) {
        pimg::set_error(pixels, turned.geterror());
        return false;
    }
    turned.set_orientation(1);
    pixels = std::move(turned);
    return true;
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
    const auto kept = m_kept.find(filename);
    if (kept != m_kept.end()) {
        stack.push_back(kept->second);
        if (!again)
            m_kept.erase(kept);
        return true;
    }
    const StageTimer timer(stats, Stage::read);
    OIIO::ImageSpec stored;
    const std::shared_ptr<OIIO::ImageBuf> pixels = read_pixels(filename, stored);
    if (!pixels)
        return false;

    const std::string space = stored.get_string_attribute("oiio:ColorSpace");
    if (const std::string ruled = space_of_file(filename, stored); ruled != space) {
        declare_space(pixels->specmod(), ruled);
        declare_space(stored, ruled);
    }

    const bool turned = upright && pixels->orientation() > 1 && !pixels->deep();
    if (turned && !turn_upright(*pixels))
        return fail(format("cannot turn \"{}\" upright: {}", filename, pixels->geterror()));

    Picture picture;
    picture.name = filename;
    picture.stored = pixel_types(stored);
    picture.linear_light = holds_linear_light(stored);
    picture.pixels = pixels;
    picture.hierarchy = std::make_shared<LazyHierarchy>();
    if (pimg::io::file_of(filename) == filename && !turned)
        picture.hierarchy->stored = StoredHierarchy::open(filename);
    say(format("{}: {}, {:.2f} s", filename, describe(stored), timer.seconds()));
    stack.push_back(picture);
    if (again)
        m_kept[filename] = picture;
    return true;
}

std::shared_ptr<OIIO::ImageBuf> Session::read_pixels(const std::string& filename, OIIO::ImageSpec& stored)
{
    ProgressBar bar(label("reading", filename));
    const auto show = [](void* data, float done) {
        static_cast<ProgressBar*>(data)->show(done);
        return false;
    };
    if (const std::unique_ptr<OIIO::ImageInput> input = pimg_input(filename)) {
        std::shared_ptr<OIIO::ImageBuf> pixels;
        if (input->open(filename, stored)) {
            OIIO::ImageSpec spec = stored;
            spec.channelformats.clear();
            spec.tile_width = spec.tile_height = 0;
            pixels = std::make_shared<OIIO::ImageBuf>(spec);
            if (input->read_image(0, 0, 0, spec.nchannels, spec.format, pixels->localpixels(), OIIO::AutoStride,
                                  OIIO::AutoStride, OIIO::AutoStride, show, &bar))
                return pixels;
        }
        fail(format("cannot read {}", input->geterror()));
        return nullptr;
    }
    auto pixels = std::make_shared<OIIO::ImageBuf>(filename);
    // Forced: straight into memory of our own, in the file's type, and not through the shared image cache.
    if (!pixels->read(0, 0, true, OIIO::TypeUnknown, show, &bar)) {
        fail(format("cannot read \"{}\": {}", filename, pixels->geterror()));
        return nullptr;
    }
    if (pixels->nsubimages() > 1)
        std::fprintf(stderr, "pimgtool: warning: \"%s\": only the first of %d parts is used\n", filename.c_str(),
                     pixels->nsubimages());
    stored = pixels->nativespec();
    return pixels;
}

bool Session::write(const std::string& filename, const pimg::io::WriteOptions& options)
{
    const pimg::Hierarchy* hierarchy = nullptr;
    if (has_pimg_extension(filename) && options.profile == "full") {
        const pimg::ProgressiveImage* image = hierarchy_of_top();
        if (!image)
            return false;
        hierarchy = &image->hierarchy();
    }
    const StageTimer timer(stats, Stage::write);
    const Picture& picture = top();
    OutputPicture out { *picture.pixels, picture.stored, picture.linear_light && !output.raw,
                        picture.labels,  hierarchy,      options };
    out.layer = picture.hierarchy->options.layer;
    if (picture.labels) {
        out.types = { output.type, {} };
        out.encode_srgb = false;
    } else if (output.type != OIIO::TypeUnknown || !output.channel_types.empty())
        out.types = asked_types(out.pixels.spec(), picture.stored, output, out.layer);
    ProgressBar bar(label("writing", filename));
    std::string summary, warning, error;
    const bool written = write_picture(out, filename, [&](float done) { bar.show(done); }, { summary, warning, error });
    if (!written)
        return fail(format("cannot write \"{}\": {}", filename, error));
    if (!warning.empty())
        std::fprintf(stderr, "pimgtool: warning: \"%s\": %s\n", filename.c_str(), warning.c_str());
    // What will be read under this name is the new file.
    m_kept.erase(filename);
    OIIO::ImageCache::create(true)->invalidate(OIIO::ustring(filename), true);
    say(format("{}: wrote {}, {:.2f} s", filename, summary, timer.seconds()));
    return true;
}

bool Session::build(const pimg::BuildOptions& options)
{
    // Copies made earlier keep theirs.
    if (!pimg::same_options(top().hierarchy->options, options))
        top().hierarchy = std::make_shared<LazyHierarchy>(LazyHierarchy { options, nullptr, {} });
    return hierarchy_of_top() != nullptr;
}

const pimg::ProgressiveImage* Session::hierarchy_of_top()
{
    LazyHierarchy& lazy = *top().hierarchy;
    if (lazy.image.initialized())
        return &lazy.image;
    ProgressBar bar(label("building", top().name));
    const auto show = [&](float done) {
        bar.show(done);
        return true;
    };
    if (lazy.stored ? !lazy.stored->read(*top().pixels, lazy.options, lazy.image)
                    : !lazy.image.build(*top().pixels, lazy.options, 0, show)) {
        fail(lazy.image.error());
        return nullptr;
    }
    const pimg::Hierarchy& hierarchy = lazy.image.hierarchy();
    stats.add(top().name, lazy.image);
    say(format("{}: {} {} vertices, {} splits, {:.2f} s", top().name, lazy.stored ? "read" : "built",
               hierarchy.vertices(), hierarchy.levels(), lazy.image.stats().simplify_seconds));
    return &lazy.image;
}

bool Session::filter(const Filter& run, Meaning meaning)
{
    const pimg::ProgressiveImage* source = hierarchy_of_top();
    if (!source)
        return false;
    const StageTimer timer(stats, Stage::filter);
    auto result = std::make_shared<OIIO::ImageBuf>();
    if (!run(*result, *source))
        return fail(result->has_error() ? result->geterror() : "failed");

    Picture picture = top();
    picture.pixels = result;
    picture.hierarchy = std::make_shared<LazyHierarchy>();
    // What was asked of the first build holds for the next, but for the colour space: the result states its own.
    picture.hierarchy->options = top().hierarchy->options;
    picture.hierarchy->options.incolorspace.clear();
    if (meaning == Meaning::display_linear)
        picture.linear_light = true;
    picture.labels = result->spec().format == OIIO::TypeUInt32 && result->spec().find_attribute(pimg::kLabelCount);
    say(format("{}: filtered, {:.3f} s", picture.name, timer.seconds()));
    top() = picture;
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
    const auto run = [&](OIIO::ImageBuf& dst, const pimg::ProgressiveImage& src) {
        return iba::hdr_compress(dst, src, options);
    };
    return filter(run, Meaning::display_linear);
}

bool Session::change_pixels(const PixelOperation& run)
{
    const StageTimer timer(stats, Stage::filter);
    auto result = std::make_shared<OIIO::ImageBuf>();
    if (!run(*result, *top().pixels))
        return fail(result->has_error() ? result->geterror() : "failed");
    auto hierarchy = std::make_shared<LazyHierarchy>();
    hierarchy->options = top().hierarchy->options;
    top().pixels = result;
    top().hierarchy = hierarchy;
    return true;
}

}  // namespace pimgtool
