// SPDX-License-Identifier: BSD-3-Clause
#include "session/stack.h"

#include <cstdio>

#include <OpenImageIO/filesystem.h>
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

std::string describe(const OIIO::ImageSpec& stored)
{
    pimg::Colour colour;
    std::string error;
    const std::string meaning =
        pimg::Colour::resolve(stored, "", colour, error) ? "taken as " + colour.description() : error;
    return format("{} x {}, {} channel{}, {}, {}", stored.width, stored.height, stored.nchannels,
                  stored.nchannels == 1 ? "" : "s", stored.format.c_str(), meaning);
}

bool same_options(const pimg::BuildOptions& a, const pimg::BuildOptions& b)
{
    for (const pimg::Option<pimg::BuildOptions>& option : pimg::option_table<pimg::BuildOptions>())
        if (pimg::get_option(a, option) != pimg::get_option(b, option))
            return false;
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

    Picture picture;
    picture.name = filename;
    picture.stored = pixel_types(stored);
    picture.linear_light = holds_linear_light(stored);
    picture.pixels = pixels;
    picture.hierarchy = std::make_shared<LazyHierarchy>();
    if (pimg::io::file_of(filename) == filename)
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
        say(format("{}: only the first of {} images is used", filename, pixels->nsubimages()));
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
    if (picture.labels) {
        out.types = { OIIO::TypeUnknown, {} };
        out.encode_srgb = false;
    }
    if (output.type != OIIO::TypeUnknown)
        out.types = { output.type, {} };
    ProgressBar bar(label("writing", filename));
    std::string summary, error;
    if (!write_picture(
            out, filename, [&](float done) { bar.show(done); }, summary, error))
        return fail(format("cannot write \"{}\": {}", filename, error));
    // What will be read under this name is the new file.
    m_kept.erase(filename);
    OIIO::ImageCache::create(true)->invalidate(OIIO::ustring(filename), true);
    say(format("{}: wrote {}, {:.2f} s", filename, summary, timer.seconds()));
    return true;
}

bool Session::build(const pimg::BuildOptions& options)
{
    // Copies made earlier keep theirs.
    if (!same_options(top().hierarchy->options, options))
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
        if (!median_light(*top().pixels, top().hierarchy->options.incolorspace, light, m_error))
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
