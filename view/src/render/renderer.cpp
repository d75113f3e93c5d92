// SPDX-License-Identifier: BSD-3-Clause
#include "render/renderer.h"

#include <chrono>
#include <exception>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/stop.h>
#include <pimg/labels.h>

#include "session/pimg_file.h"
#include "state/command_line.h"

namespace pimgview {

namespace {

using OIIO::ImageBuf;
using pimg::format;

/// Options of building for a result: as for its source, but for the colour space, which the result states itself.
pimg::BuildOptions options_of_next(pimg::BuildOptions options)
{
    options.incolorspace.clear();
    return options;
}

std::shared_ptr<const pimg::ProgressiveImage> build(const ImageBuf& pixels, const pimg::BuildOptions& options,
                                                    const std::atomic<bool>& stop, std::string& error)
{
    auto image = std::make_shared<pimg::ProgressiveImage>();
    if (image->build(pixels, options, 0, [&](float) { return !stop; }))
        return image;
    error = stop ? "stopped" : image->error();
    return nullptr;
}

}  // namespace

bool Renderer::is_too_much(const DocumentState& document, const ImageBuf& next) const
{
    return double(document.memory() + memory()) + build_bytes(double(next.spec().image_pixels())) > most_bytes();
}

bool Renderer::apply(const StackItem& item, Stage& stage, const Rendering& before, const pimg::ProgressiveImage& image,
                     const std::atomic<bool>& stop)
{
    const pimg::StopScope scope([&stop] { return !stop; });
    pimg::BoundFilter filter;
    std::string error;
    auto result = std::make_shared<ImageBuf>();
    const pimg::OptionTexts texts = m_writes ? item.texts : for_looking(item, before.factor);
    if (!item.filter->bind(texts, filter, error))
        stage.result.error = format("{}: {}", item.filter->command, error);
    else if (!filter(*result, image, {}, 0))
        stage.result.error =
            format("{}: {}", item.filter->command, result->has_error() ? result->geterror() : "failed");
    if (stop)
        stage.result.error = "stopped";
    if (!stage.result.error.empty())
        return false;
    stage.result.pixels = result;
    stage.result.factor = before.factor;
    stage.result.layer = before.layer;
    stage.result.linear_light = before.linear_light || filter.output == pimg::FilterOutput::light;
    stage.result.labels =
        result->spec().format == OIIO::TypeUInt32 && result->spec().find_attribute(pimg::kLabelCount) != nullptr;
    return true;
}

Rendering Renderer::render(const DocumentState& document, const Rung& rung, const FilterStack& stack,
                           const std::atomic<bool>& stop)
{
    const auto begun = std::chrono::steady_clock::now();
    if (m_source != rung.pixels || m_version != document.version)
        m_stages.clear();
    m_source = rung.pixels;
    m_version = document.version;
    Rendering source;
    source.pixels = rung.pixels;
    source.factor = rung.factor;
    source.linear_light = document.linear_light;
    source.layer = document.build.layer;
    const Rendering* before = &source;
    std::shared_ptr<const pimg::ProgressiveImage> image = rung.image;
    std::size_t at = 0;
    m_stages.reserve(stack.items.size());
    for (const StackItem& item : stack.items) {
        if (!item.on)
            continue;
        const std::string argument = arguments_of({ {}, {}, { item } })[0];
        if (at == m_stages.size() || m_stages[at].argument != argument) {
            m_stages.resize(at);
            Stage stage { argument, {}, nullptr };
            if (at > 0 && !m_stages[at - 1].image && is_too_much(document, *rung.pixels)) {
                stage.result.error = format("{}: not enough memory for one more filter: expected fewer", argument);
                return stage.result;
            }
            if (at > 0 && !m_stages[at - 1].image)
                m_stages[at - 1].image =
                    build(*before->pixels, options_of_next(document.build), stop, stage.result.error);
            image = at > 0 ? m_stages[at - 1].image : image;
            if (!image || !apply(item, stage, *before, *image, stop))
                return stage.result;
            m_stages.push_back(std::move(stage));
        }
        before = &m_stages[at++].result;
    }
    m_stages.resize(at);
    Rendering result = *before;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return result;
}

std::size_t Renderer::memory() const
{
    std::size_t bytes = 0;
    for (const Stage& stage : m_stages)
        bytes += stage.result.pixels->spec().image_bytes() + (stage.image ? stage.image->memory() : 0);
    return bytes;
}

const Rung* built_rung(const DocumentState& document, double scale)
{
    const Rung* finest = nullptr;
    const Rung* coarsest = nullptr;
    for (const Rung& rung : document.rungs) {
        if (!rung.image)
            continue;
        if (finest == nullptr)
            finest = &rung;
        if (rung.factor <= scale)
            coarsest = &rung;
    }
    return coarsest != nullptr ? coarsest : finest;
}

namespace {

/// The picture as a file; see save().
bool write_result(const DocumentState& document, const Rendering& result, const std::string& filename,
                  const std::atomic<bool>& stop, std::string& summary, std::string& error)
{
    pimg::io::WriteOptions options;
    options.profile = "full";
    std::shared_ptr<const pimg::ProgressiveImage> image;
    if (pimgtool::has_pimg_extension(filename)) {
        image = result.pixels == document.rungs[0].pixels
            ? document.rungs[0].image
            : build(*result.pixels, options_of_next(document.build), stop, error);
        if (!image)
            return false;
        image = std::make_shared<const pimg::ProgressiveImage>(image->unwrapped(*result.pixels));
        if (!image->initialized()) {
            error = image->error();
            return false;
        }
    }
    pimgtool::OutputPicture out {
        *result.pixels, document.stored, result.linear_light, result.labels, image ? &image->hierarchy() : nullptr,
        options
    };
    out.layer = result.layer;
    if (result.labels) {
        out.types = { OIIO::TypeUnknown, {} };
        out.encode_srgb = false;
    }
    std::string warning;
    if (pimgtool::write_picture(out, filename, [](float) {}, { summary, warning, error })) {
        summary += warning.empty() ? "" : "; " + warning;
        return true;
    }
    error = format("cannot write \"{}\": {}", filename, error);
    return false;
}

bool is_for_strokes(const std::string& filename)
{
    const std::string extension = OIIO::Filesystem::extension(filename);
    return OIIO::Strutil::iequals(extension, ".svg") || OIIO::Strutil::iequals(extension, ".json");
}

}  // namespace

bool save(const DocumentState& document, const FilterStack& stack, const std::string& filename,
          const std::atomic<bool>& stop, std::string& summary, std::string& error)
{
    FilterStack all = stack;
    const bool strokes = is_for_strokes(filename);
    if (strokes ? !write_strokes(all, filename, error) : !pimgtool::can_write(filename, error)) {
        error = format("cannot write {}", strokes ? error : format("\"{}\": {}", filename, error));
        return false;
    }
    Renderer renderer(true);
    const Rendering result = renderer.render(document, document.rungs[0], all, stop);
    error = result.error;
    summary = "strokes";
    return result.pixels && (strokes || write_result(document, result, filename, stop, summary, error));
}

}  // namespace pimgview
