// SPDX-License-Identifier: BSD-3-Clause
#include "render/document.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/sysutil.h>

#include <pimg/colour.h>
#include <pimg/detail/format.h>
#include <pimg/detail/retuning.h>
#include <pimg/filter_table.h>
#include <pimg/threads.h>

#include "render/glimpse.h"
#include "session/colour.h"
#include "session/input.h"
#include "session/pimg_file.h"

namespace pimgview {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using pimg::format;

constexpr double kQuickPixels = 0.3e6;  ///< built in a quarter of a second, filtered thirty times a second and more

double seconds_now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// One row of means over blocks of factor x factor pixels; the last row and column of blocks may be narrower. NaN does
/// not count.
void reduce_row(const std::vector<float>& source, const ImageSpec& from, int factor, int y, float* row, int width)
{
    const int channels = from.nchannels;
    const int y_end = std::min((y + 1) * factor, from.height);
    for (int x = 0; x < width; ++x)
        for (int c = 0; c < channels; ++c) {
            double sum = 0.0;
            int count = 0;
            for (int v = y * factor; v < y_end; ++v)
                for (int u = x * factor; u < std::min((x + 1) * factor, from.width); ++u) {
                    const float sample =
                        source[(std::size_t(v) * std::size_t(from.width) + std::size_t(u)) * std::size_t(channels)
                               + std::size_t(c)];
                    if (std::isfinite(sample)) {
                        sum += double(sample);
                        ++count;
                    }
                }
            row[x * channels + c] = count > 0 ? float(sum / count) : 0.0f;
        }
}

/// The layers of a part, in the order of its channels, whose channels can be a picture.
std::vector<std::string> layers_of(const ImageSpec& spec)
{
    std::vector<std::string> layers;
    for (const std::string& channel : spec.channelnames) {
        const std::string layer = channel.substr(0, channel.rfind('.') == channel.npos ? 0 : channel.rfind('.'));
        pimg::Colour colour;
        std::string error;
        if (!layer.empty() && std::find(layers.begin(), layers.end(), layer) == layers.end()
            && pimg::Colour::resolve(spec, "", layer, colour, error))
            layers.push_back(layer);
    }
    return layers;
}

void drop_glimpse(std::vector<Rung>& rungs)
{
    rungs.erase(std::remove_if(rungs.begin(), rungs.end(), [](const Rung& rung) { return rung.glimpse; }), rungs.end());
}

}  // namespace

OIIO::ImageBuf reduced(const ImageBuf& pixels, int factor)
{
    ImageSpec spec = pixels.spec();
    const ImageSpec from = spec;
    std::vector<float> source(from.image_pixels() * std::size_t(from.nchannels));
    pixels.get_pixels(pixels.roi(), OIIO::TypeFloat, source.data());
    spec.width = (from.width + factor - 1) / factor;
    spec.height = (from.height + factor - 1) / factor;
    spec.x = spec.y = spec.full_x = spec.full_y = 0;
    spec.full_width = spec.width;
    spec.full_height = spec.height;
    std::vector<float> means(spec.image_pixels() * std::size_t(spec.nchannels));
    pimg::pool_loop(0)(std::size_t(spec.height), [&](std::size_t y) {
        reduce_row(source, from, factor, int(y), &means[y * std::size_t(spec.width) * std::size_t(spec.nchannels)],
                   spec.width);
    });
    ImageBuf result(spec);
    result.set_pixels(result.roi(), OIIO::TypeFloat, means.data());
    return result;
}

std::vector<int> smaller_factors(int width, int height)
{
    constexpr double kWindow = 1.5e6;  // of 1920 x 1200 with panels beside the picture, at most
    std::vector<int> factors;
    for (const double most : { kWindow, kQuickPixels }) {
        const int factor = int(std::ceil(std::sqrt(double(width) * height / most)));
        if (factor > 1 && (factors.empty() || factor > factors.back()) && width / factor > 1 && height / factor > 1)
            factors.push_back(factor);
    }
    return factors;
}

double build_bytes(double pixels)
{
    constexpr double kBytesPerPixel = 300.0;  // measured: 270 more for each pixel from 1 to 8 megapixels, at the peak
    return kBytesPerPixel * pixels;
}

double most_bytes()
{
    return 0.75 * double(OIIO::Sysutil::physical_memory());
}

std::size_t DocumentState::memory() const
{
    std::size_t bytes = 0;
    for (const Rung& rung : rungs) {
        bytes += rung.pixels->spec().image_bytes();
        bytes += rung.image ? rung.image->memory() : 0;
    }
    return bytes;
}

Document::Document(std::function<void()> changed) : m_changed(std::move(changed)) { }

DocumentState Document::state() const
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    return m_state;
}

bool Document::current(int version) const
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    return m_state.version == version;
}

void Document::update(int version, const std::function<void(DocumentState&)>& change)
{
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        if (m_state.version != version)
            return;
        change(m_state);
    }
    m_changed();
}

void Document::fail(int version, const std::string& error)
{
    std::string line = error;
    std::replace(line.begin(), line.end(), '\n', ' ');
    update(version, [&](DocumentState& state) {
        state.error = pimg::one_line(line);
        state.activity.clear();
    });
}

void Document::open(const std::string& filename, const std::string& part, const pimg::OptionTexts& build)
{
    begin(filename, part, build, false);
}

void Document::rebuild(const pimg::OptionTexts& build)
{
    const DocumentState now = state();
    begin(now.filename, now.part, build, now.is_read());
}

void Document::begin(const std::string& filename, const std::string& part, const pimg::OptionTexts& texts, bool again)
{
    m_worker.cancel();
    int version = 0;
    std::string error;
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        DocumentState next;
        next.filename = filename;
        next.part = part;
        next.version = version = m_state.version + 1;
        if (again) {
            next.rungs = m_state.rungs;
            next.parts = m_state.parts;
            next.layers = m_state.layers;
            next.stored = m_state.stored;
            next.linear_light = m_state.linear_light;
            next.read_seconds = m_state.read_seconds;
            next.width = m_state.width;
            next.height = m_state.height;
            next.turned = m_state.turned;
            for (Rung& rung : next.rungs)
                rung.image = nullptr;
            drop_glimpse(next.rungs);
        }
        next.activity = again ? "building" : "reading";
        pimg::set_options(next.build, texts, error);
        m_state = std::move(next);
    }
    if (!error.empty()) {
        fail(version, "--build: " + error);
        return;
    }
    m_worker.post([this, version, again](const std::atomic<bool>& stop) {
        try {
            if (again || read(version, stop))
                build(version, stop);
        } catch (const std::bad_alloc&) {
            fail(version, "not enough memory");
        } catch (const std::exception& exception) {
            fail(version, exception.what());
        }
    });
}

/// Shows what can be had of the file at once, if the format has something, and lets filters work on it.
void Document::show_glimpse(int version, const std::atomic<bool>& stop)
{
    const double begun = seconds_now();
    const DocumentState now = state();
    const Glimpse look = glimpse(now.filename, now.part, GlimpseSize { kQuickPixels });
    if (look.bytes > most_bytes())
        throw std::runtime_error(format("\"{}\" takes {:.1f} GB of memory: expected at most {:.1f}, three quarters of "
                                        "the machine's",
                                        now.filename, look.bytes / 1e9, most_bytes() / 1e9));
    update(version, [&](DocumentState& state) {
        state.parts = look.parts;
        if (!look.pixels)
            return;
        state.width = look.stored.width;
        state.height = look.stored.height;
        state.rungs = { { look.factor, look.pixels, nullptr, true } };
        state.linear_light = pimgtool::holds_linear_light(look.stored);
    });
    if (look.pixels && build_rung(version, 0, stop))
        update(version, [&](DocumentState& state) { state.first_build_seconds = seconds_now() - begun; });
}

bool Document::read(int version, const std::atomic<bool>& stop)
{
    const double begun = seconds_now();
    const std::string filename = state().filename;
    if (!OIIO::Filesystem::exists(pimg::io::file_of(filename))) {
        fail(version, format("cannot read \"{}\": no such file", filename));
        return false;
    }
    if (OIIO::Filesystem::is_directory(filename)) {
        fail(version, format("cannot read \"{}\": expected a folder with pictures", filename));
        return false;
    }
    show_glimpse(version, stop);
    pimgtool::InputOptions options;
    options.part = state().part;
    options.keeps_parts = false;
    pimgtool::InputFile file;
    std::string error;
    const auto progress = [&](float done) {
        update(version, [&](DocumentState& state) {
            state.activity = "reading";
            state.progress = done;
        });
    };
    if (stop || !current(version))
        return false;
    progress(0.0f);
    if (!pimgtool::read_file(filename, options, progress, file, error)) {
        fail(version, format("cannot read \"{}\": {}", filename, error));
        return false;
    }
    const pimgtool::InputPart& part = file.parts[0];
    const ImageSpec& spec = part.pixels->spec();
    if (part.pixels->deep() || spec.depth > 1) {
        fail(version,
             format("cannot show \"{}\": it is {}, expected a flat picture", filename,
                    part.pixels->deep() ? "deep" : "a volume"));
        return false;
    }
    show_read(version, part, seconds_now() - begun);
    return true;
}

/// Shows what was read, and makes its smaller copies. A glimpse that filters work on stays last until another can take
/// its place.
void Document::show_read(int version, const pimgtool::InputPart& part, double seconds)
{
    const ImageSpec& spec = part.pixels->spec();
    const std::vector<std::string> layers = layers_of(spec);
    update(version, [&](DocumentState& state) {
        state.layers = layers;
        state.width = spec.width;
        state.height = spec.height;
        state.rungs.insert(state.rungs.begin(), { 1, part.pixels, nullptr, false });
        if (state.rungs.back().glimpse && !state.rungs.back().image)
            state.rungs.pop_back();
        state.stored = { part.stored.format, part.stored.channelformats };
        state.linear_light = pimgtool::holds_linear_light(part.stored);
        state.turned = part.turned;
        state.read_seconds = seconds;
    });
    for (const int factor : smaller_factors(spec.width, spec.height)) {
        const auto smaller = std::make_shared<ImageBuf>(reduced(*part.pixels, factor));
        update(version, [&](DocumentState& state) {
            const auto end = state.rungs.end() - (state.rungs.back().glimpse ? 1 : 0);
            state.rungs.insert(end, { factor, smaller, nullptr, false });
        });
    }
}

void Document::build(int version, const std::atomic<bool>& stop)
{
    const double begun = seconds_now();
    const std::vector<Rung> rungs = state().rungs;
    const auto count =
        std::size_t(std::count_if(rungs.begin(), rungs.end(), [](const Rung& rung) { return !rung.glimpse; }));
    // The smallest first, so that sliders can be moved soon.
    for (std::size_t i = count; i-- > 0;) {
        if (stop || !current(version) || !build_rung(version, i, stop))
            return;
        update(version, [&](DocumentState& state) {
            drop_glimpse(state.rungs);
            const double seconds = state.read_seconds + seconds_now() - begun;
            if (state.first_build_seconds == 0.0)
                state.first_build_seconds = seconds;
            state.built_seconds = seconds;
        });
    }
    update(version, [](DocumentState& state) { state.activity.clear(); });
}

bool Document::build_rung(int version, std::size_t index, const std::atomic<bool>& stop)
{
    const DocumentState now = state();
    const Rung rung = now.rungs[index];
    const double pixels = double(rung.pixels->spec().image_pixels());
    if (rung.factor == 1 && now.rungs.size() > 1 && build_bytes(pixels) > most_bytes()) {
        fail(version,
             format("not enough memory to build {:.0f} megapixels: filters work on a smaller copy", pixels / 1e6));
        return false;
    }
    const std::string activity = rung.factor == 1 ? "building" : format("building a copy at 1/{}", rung.factor);
    update(version, [&](DocumentState& state) {
        state.activity = activity;
        state.progress = 0.0f;
    });
    auto image = std::make_shared<pimg::ProgressiveImage>();
    const auto stored = rung.factor == 1 && !now.turned && pimg::io::file_of(now.filename) == now.filename
        ? pimgtool::StoredHierarchy::open(now.filename, rung.pixels->spec())
        : nullptr;
    const auto progress = [&](float done) {
        update(version, [&](DocumentState& state) { state.progress = done; });
        return !stop && current(version);
    };
    const bool usual = pimg::same_options(now.build, pimg::BuildOptions());
    const bool done = stored && usual ? stored->read(*rung.pixels, now.build, *image)
                                      : image->build(*rung.pixels, now.build, 0, progress);
    if (!done) {
        if (!stop && current(version))
            fail(version, image->error());
        return false;
    }
    pimg::expect_retunes(*image);
    update(version, [&](DocumentState& state) { state.rungs[index].image = image; });
    return true;
}

}  // namespace pimgview
