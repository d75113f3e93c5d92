// SPDX-License-Identifier: BSD-3-Clause
#include "studio.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <new>
#include <thread>

#include <pimg/detail/format.h>

namespace pimgview {

namespace {

using pimg::format;

/// The visible part with a margin, which may come into view next.
Region with_margin(const Region& visible, const DocumentState& document)
{
    const int dx = (visible.x1 - visible.x0) / 4, dy = (visible.y1 - visible.y0) / 4;
    return { std::max(0, visible.x0 - dx), std::max(0, visible.y0 - dy), std::min(document.width, visible.x1 + dx),
             std::min(document.height, visible.y1 + dy) };
}

int built_count(const DocumentState& document)
{
    return int(
        std::count_if(document.rungs.begin(), document.rungs.end(), [](const Rung& rung) { return rung.image; }));
}

bool filters(const FilterStack& stack)
{
    return std::any_of(stack.items.begin(), stack.items.end(), [](const StackItem& item) { return item.on; });
}

Rendering source_of(const DocumentState& document, const Rung& rung)
{
    Rendering source;
    source.pixels = rung.pixels;
    source.factor = rung.factor;
    source.linear_light = document.linear_light;
    source.layer = document.build.layer;
    return source;
}

/// The side, in pixels of a rung, of the square that a texel is the mean of.
int reduction(double scale, int factor)
{
    int reduce = 1;
    while (double(factor) * reduce * 2 <= scale)
        reduce *= 2;
    return reduce;
}

}  // namespace

Studio::Studio(std::function<void()> changed) : m_changed(changed), m_document(std::move(changed)) { }

Studio::~Studio() = default;

/// The rung for pictures that are to come quickly: the coarsest that has a pixel for each of the screen's. If its filters
/// would take longer than a thirtieth of a second, its pixels may be half as large again.
const Rung* Studio::quick_rung(const DocumentState& document, double scale) const
{
    constexpr double kSlow = 1.0 / 30.0, kCoarser = 1.5;
    const double at_least = std::max(1.0, scale);
    const Rung* rung = built_rung(document, at_least);
    if (rung == nullptr || m_seconds_per_pixel * double(rung->pixels->spec().image_pixels()) < kSlow)
        return rung;
    return built_rung(document, kCoarser * at_least);
}

bool Studio::is_served(const Wanted& wanted, const DocumentState& document) const
{
    const Wanted& before = m_request.wanted;
    return m_request.document.version == document.version && m_rungs_built == built_count(document)
        && m_request.document.rungs.size() == document.rungs.size()
        && m_request.document.rungs[0].pixels == document.rungs[0].pixels && m_request.region.contains(wanted.visible)
        && reduction(before.scale, 1) == reduction(wanted.scale, 1) && before.stack == wanted.stack
        && before.dragging == wanted.dragging && (before.source || !wanted.source) && (before.scopes || !wanted.scopes);
}

void Studio::want(const Wanted& asked)
{
    const DocumentState document = m_document.state();
    if (!document.has_picture())
        return;
    Wanted wanted = asked;
    bool changes = false;
    if (wanted.visible.empty())
        wanted.visible = { 0, 0, document.width, document.height };
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        if (is_served(wanted, document))
            return;
        changes = m_request.wanted.stack != wanted.stack || m_request.document.version != document.version;
        m_request = { wanted, document, with_margin(wanted.visible, document), m_request.serial + 1 };
        m_rungs_built = built_count(document);
    }
    const Rung* finest = built_rung(document, 0.0);
    const Rung* fitting = quick_rung(document, wanted.scale);
    // A smaller copy comes first if there is one and the finest takes long, that is with filters.
    const bool both = finest != fitting && filters(wanted.stack);
    if (wanted.dragging || both)
        post(m_quick, m_quick_renderer, true, false);  // one after the other, or dragging would show nothing
    if (!wanted.dragging)
        post(m_full, m_full_renderer, false, changes);
    else if (changes)
        m_full.cancel();
}

void Studio::post(Worker& worker, Renderer& renderer, bool quick, bool at_once)
{
    Request request;
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        request = m_request;
    }
    const auto job = [this, request, quick, &renderer](const std::atomic<bool>& stop) {
        std::string error;
        try {
            make(request, renderer, quick, stop);
            return;
        } catch (const std::bad_alloc&) {
            error = "not enough memory";
        } catch (const std::exception& exception) {
            error = exception.what();
        }
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_error = error;
        m_error_serial = request.serial;
    };
    worker.post(job, at_once);
}

/// The picture as it is, if nothing of the file has been shown: the first filter may take a while.
void Studio::show_source_first(const Request& request)
{
    const std::shared_ptr<const Shown> before = this->shown();
    if (before && before->document == request.document.version)
        return;
    const Rung& rung = request.document.rungs[0];
    auto shown = std::make_shared<Shown>();
    shown->source = shown->result = source_of(request.document, rung);
    const int reduce = reduction(std::max(1.0, request.wanted.scale), rung.factor);
    shown->frame = std::make_shared<Frame>(make_frame(shown->result, request.region, reduce));
    shown->document = request.document.version;
    shown->width = request.document.width;
    shown->height = request.document.height;
    shown->serial = request.serial;
    publish(shown);
}

void Studio::make(const Request& request, Renderer& renderer, bool quick, const std::atomic<bool>& stop)
{
    const auto begun = std::chrono::steady_clock::now();
    const bool filtered = filters(request.wanted.stack);
    const double scale = std::max(1.0, request.wanted.scale);
    const Rung* rung = quick ? quick_rung(request.document, scale) : built_rung(request.document, 0.0);
    FilterStack stack = request.wanted.stack;
    if (rung == nullptr || !filtered) {
        rung = &request.document.rungs[0];
        stack.items.clear();
    }
    if (filtered && request.wanted.playing && rung == &request.document.rungs[0] && !rung->image
        && !request.document.finished())
        return;
    if (!stack.items.empty() && !request.wanted.playing)
        show_source_first(request);
    auto shown = std::make_shared<Shown>();
    shown->result = renderer.render(request.document, *rung, stack, stop);
    if (!shown->result.pixels && stop)
        return;
    if (!shown->result.pixels) {
        {
            const std::lock_guard<std::mutex> lock(m_mutex);
            m_error = shown->result.error;
            m_error_serial = request.serial;
        }
        m_changed();
        return;
    }
    constexpr double kMade = 1e-3;  // in less time results are found, not made
    if (filtered && shown->result.seconds > kMade)
        m_seconds_per_pixel = shown->result.seconds / double(rung->pixels->spec().image_pixels());
    const int reduce = reduction(scale, rung->factor);
    shown->frame = std::make_shared<Frame>(make_frame(shown->result, request.region, reduce));
    shown->source = source_of(request.document, *rung);
    shown->final = !quick;
    shown->filtered = !filtered || !stack.items.empty();
    shown->document = request.document.version;
    shown->width = request.document.width;
    shown->height = request.document.height;
    shown->serial = request.serial;
    add_source(request, *shown);
    if (rung->image)
        add_overlays(request, *rung, *shown);
    shown->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    count_memory(request, *shown, quick);
    publish(shown);
}

void Studio::count_memory(const Request& request, const Shown& shown, bool quick)
{
    const auto bytes_of = [](const std::shared_ptr<const Frame>& frame) {
        return frame ? frame->rgb.size() * sizeof(float) : 0;
    };
    m_document_bytes = request.document.memory() + bytes_of(shown.frame) + bytes_of(shown.source_frame);
    m_renderer_bytes[quick ? 1 : 0] = (quick ? m_quick_renderer : m_full_renderer).memory();
}

void Studio::add_source(const Request& request, Shown& shown) const
{
    constexpr int kColumns = 256;  // of the waveform: about the width of its panel
    if (request.wanted.source) {
        const std::shared_ptr<const Shown> before = this->shown();
        const bool same = before && before->source_frame && before->source.pixels == shown.source.pixels
            && before->source_frame->width == shown.frame->width && before->source_frame->height == shown.frame->height
            && before->source_frame->region.contains(shown.frame->region);
        const int reduce = shown.frame->step / shown.result.factor;
        shown.source_frame = same ? before->source_frame
                                  : std::make_shared<Frame>(make_frame(shown.source, shown.frame->region, reduce));
    }
    if (request.wanted.scopes) {
        shown.histogram = histogram_of(shown.result);
        shown.source_histogram = histogram_of(shown.source);
        shown.waveform = waveform_of(shown.result, kColumns);
        shown.has_scopes = true;
    }
}

void Studio::add_overlays(const Request& request, const Rung& rung, Shown& shown) const
{
    constexpr pimg::Index kUsual = 2000;  // enough to show what pieces are, in a picture of any size
    const pimg::Index vertices = request.wanted.mesh > 0 ? request.wanted.mesh : kUsual;
    const std::shared_ptr<const Shown> before = this->shown();
    if (request.wanted.mesh > 0) {
        const bool same = before && before->mesh && before->mesh->image == rung.image
            && before->mesh->vertices == vertices && before->mesh->region.contains(request.region)
            && !before->mesh->too_many;
        shown.mesh = same ? before->mesh
                          : std::make_shared<MeshLines>(mesh_lines(rung.image, vertices, rung.factor, request.region));
    }
    if (request.wanted.pieces) {
        const PieceMap* known = before ? before->pieces.get() : nullptr;
        const bool same = known != nullptr && known->image == rung.image && known->vertices == vertices;
        shown.pieces = same ? before->pieces : piece_map(rung.image, vertices, rung.factor, known);
    }
}

void Studio::publish(std::shared_ptr<Shown> shown)
{
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        const bool older = m_shown
            && (m_shown->document > shown->document || m_shown->serial > shown->serial
                || (m_shown->serial == shown->serial && m_shown->final));
        if (older)
            return;
        m_shown = std::move(shown);
        m_error.clear();
    }
    m_changed();
}

std::shared_ptr<const Shown> Studio::shown() const
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    return m_shown;
}

std::string Studio::error() const
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    return m_error;
}

bool Studio::has_current() const
{
    const int version = m_document.state().version;
    const std::shared_ptr<const Shown> newest = shown();
    return newest && newest->document == version && newest->filtered;
}

bool Studio::settled() const
{
    const DocumentState document = m_document.state();
    const std::lock_guard<std::mutex> lock(m_mutex);
    if (!document.finished() || m_save.busy)
        return false;
    if (!document.has_picture())
        return true;
    const bool current = m_request.document.version == document.version && m_rungs_built == built_count(document)
        && m_request.document.rungs[0].pixels == document.rungs[0].pixels;
    const bool made = m_shown && m_shown->serial == m_request.serial && m_shown->final;
    const bool failed = !m_error.empty() && m_error_serial == m_request.serial;
    return current && (made || failed);
}

void Studio::save(const FilterStack& stack, const std::string& filename)
{
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_save = { true, false, format("saving {} ...", filename) };
    }
    m_saver.post([this, stack, filename](const std::atomic<bool>& stop) {
        const DocumentState document = m_document.state();
        std::string summary, error;
        bool saved = false;
        try {
            if (!document.is_read() || !document.rungs[0].image)
                error = "the picture is still being built: expected its end before saving";
            else
                saved = pimgview::save(document, stack, filename, stop, summary, error);
        } catch (const std::exception& exception) {
            error = exception.what();
        }
        {
            const std::lock_guard<std::mutex> lock(m_mutex);
            std::error_code unknown;  // then the path is empty, and the name says what can be said
            const std::string path = std::filesystem::absolute(filename, unknown).string();
            m_save = { false, !saved, saved ? format("saved {}: {}", unknown ? filename : path, summary) : error };
        }
        m_changed();
    });
}

SaveState Studio::saving() const
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    return m_save;
}

void Studio::forget_saved()
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    if (!m_save.busy)
        m_save = {};
}

bool Studio::stop()
{
    m_document.cancel();
    for (Worker* worker : { &m_quick, &m_full, &m_saver })
        worker->cancel();
    const auto idle = [this] {
        return m_quick.idle() && m_full.idle() && m_saver.idle() && m_document.idle();
    };
    for (int wait = 0; wait < 20 && !idle(); ++wait)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return idle();
}

}  // namespace pimgview
