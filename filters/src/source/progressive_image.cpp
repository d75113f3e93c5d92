// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/progressive_image.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>
#include <pimg/threads.h>

#include "base/float_copy.h"
#include "source/gains/contrast_envelope.h"
#include "source/lab.h"
#include "source/progressive_image_data.h"
#include "source/to_picture.h"
#include "source/wrap/latitude.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// What collapses cost that mesh=auto leaves to bisection: that of a pixel which is 2 codes of an 8-bit picture from what
/// its neighbours predict; in log luminance, a unit. Higher limits build faster, but cost quality (docs/internals.md).
float bisection_limit(const std::string& guide)
{
    return guide == "log" ? 8.0f : 32.0f;
}

/// Seconds since the last call.
class Stopwatch {
public:
    double lap()
    {
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double>(now - std::exchange(m_start, now)).count();
    }

private:
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

/// Samples of one channel, one per mesh pixel, times 2^-exponent.
std::vector<float> mesh_samples(const ProgressiveImage::Data& data, int channel, int exponent)
{
    std::vector<float> samples = channel_samples(data, channel);
    scale_by_power(-exponent, samples);
    return to_mesh_pixels(data.hierarchy, samples.data());
}

/// Brightness of an image file of the picture's size, with margins: the mean of its colour channels.
bool read_control_map(const std::string& filename, const Wrap& wrap, std::vector<float>& map, std::string& error)
{
    OIIO::ImageBuf file(filename);
    if (!file.read(0, 0, true, OIIO::TypeDesc::FLOAT)) {
        error = "control=\"" + filename + "\": expected gradient, curvature or an image file: " + file.geterror();
        return false;
    }
    const OIIO::ImageSpec& spec = file.spec();
    if (spec.width != wrap.width || spec.height != wrap.height) {
        error = "control=\"" + filename + "\": expected an image of the picture's size";
        return false;
    }
    const int colours = std::min(spec.nchannels, 3);
    map.resize(spec.image_pixels());
    const float* p = static_cast<const float*>(file.localpixels());
    for (float& value : map) {
        value = 0.0f;
        for (int c = 0; c < colours; ++c)
            value += p[c];
        p += spec.nchannels;
    }
    map = with_margins(wrap, std::move(map));
    return true;
}

/// One positive factor per guide channel from "1,0.5,0.5"; nothing from "".
bool parse_weights(const std::string& text, std::size_t channels, std::vector<float>& weights, std::string& error)
{
    for (const std::string& word : OIIO::Strutil::splits(text, ",")) {
        const float weight = OIIO::Strutil::string_is_float(word) ? OIIO::Strutil::stof(word) : 0.0f;
        if (weight > 0.0f && std::isfinite(weight))
            weights.push_back(weight);
    }
    const std::size_t given = text.empty() ? 0 : 1 + std::size_t(std::count(text.begin(), text.end(), ','));
    if (given == weights.size() && (given == 0 || given == channels))
        return true;
    error = format("weights=\"{}\": expected {} number{} above 0, one for each channel of the guide", text, channels,
                   channels == 1 ? "" : "s");
    return false;
}

std::size_t bytes(const Bands& bands)
{
    return (bands.base.capacity() + bands.residual.capacity()) * sizeof(float)
        + bands.details.capacity() * sizeof(Detail);
}

}  // namespace

std::vector<float> channel_samples(const ProgressiveImage::Data& data, int channel)
{
    const float* p = static_cast<const float*>(data.source.localpixels()) + channel;
    std::vector<float> samples(data.spec.image_pixels());
    for (float& sample : samples) {
        sample = *p;
        p += data.source.nchannels();
    }
    return samples;
}

bool ProgressiveImage::Data::read(const OIIO::ImageBuf& src, std::string& error)
{
    if (!src.initialized()) {
        error = src.has_error() ? src.geterror(false) : "the picture is not initialized";
        return false;
    }
    if (src.deep()) {
        error = "deep images are not supported: expected one sample for each pixel";
        return false;
    }
    picture = src.spec();
    spec = picture;
    if (spec.depth > 1) {
        error = "volumes are not supported: expected a picture of depth 1";
        return false;
    }
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) {
        error = "the picture is empty";
        return false;
    }
    if (!copy_as_float(source, src) || source.localpixels() == nullptr) {
        error = source.has_error() ? source.geterror() : src.geterror(false);
        return false;
    }
    if (!find_wrap(picture, options.wrap, wrap, error))
        return false;
    stats.wrap = name_of(wrap);
    // What the file stored tells an 8-bit picture that was read as float from a scene-referred one.
    OIIO::ImageSpec stored = spec;
    stored.format = src.nativespec().format;
    whole_numbers = !stored.format.is_floating_point();
    stats.guide = !options.guide.empty() ? options.guide : whole_numbers ? "luma" : "log";
    if (!Colour::resolve(stored, options.incolorspace, options.layer, colour, error))
        return false;
    if (wrap) {
        source = padded(source, wrap);
        spec.x = source.spec().x, spec.y = source.spec().y;
        spec.width = wrap.padded_width(), spec.height = wrap.padded_height();
    }
    return true;
}

/// Leaves `mesh` empty if every pixel is to be a vertex.
bool ProgressiveImage::Data::find_initial_mesh(const Guide& guide, const ParallelFor& parallel,
                                               const Progress& progress, InitialMesh& mesh, std::string& error) const
{
    if (options.mesh != "adaptive" || guide.width < 2 || guide.height < 2)
        return true;
    SamplingOptions sampling;
    sampling.density = double(options.density);
    sampling.control = options.control == "curvature" ? Control::curvature : Control::gradient;
    sampling.parallel = parallel;
    if (progress)
        sampling.progress = [&](float) {
            return progress(0.0f);
        };
    std::vector<float> map;
    if (options.control != "gradient" && options.control != "curvature") {
        if (!read_control_map(options.control, wrap, map, error))
            return false;
        sampling.map = map.data();
    }
    const Status status = sample(guide, sampling, mesh);
    error = status.error();
    return status.ok();
}

bool ProgressiveImage::Data::hierarchy_of_guide(const MakeHierarchy& make_hierarchy, const ParallelFor& parallel,
                                                std::string& error)
{
    Stopwatch watch;
    specials = repair(source, colour, parallel);
    std::vector<Raster> channels(1);
    if (stats.guide == "log") {
        m_log = std::make_unique<LogBands>();
        m_log->luminance = log_luminance(source, colour, parallel);
        channels[0] = std::move(m_log->luminance.guide);
    } else if (stats.guide == "lab")
        channels = lab_guide(source, colour, parallel);
    else {
        StoredGuide stored = stored_guide(source, colour, stats.guide == "rgb", whole_numbers, parallel);
        m_guide_scale = stored.scale;
        m_guide_clipped = stored.clipped;
        channels = std::move(stored.channels);
    }
    stats.guide_seconds = watch.lap();

    const Status status = make_hierarchy(channels);
    error = status.error();
    stats.simplify_seconds = watch.lap() - stats.sample_seconds;
    if (m_log != nullptr && status) {
        m_log->luminance.guide = std::move(channels[0]);
        m_log->bands = &guide_bands[0];
    }
    return status.ok();
}

Status ProgressiveImage::Data::simplify_guide(const std::vector<Raster>& channels, const ParallelFor& parallel,
                                              const Progress& progress)
{
    std::string error;
    std::vector<float> weights;
    if (!parse_weights(options.weights, channels.size(), weights, error))
        return Status::failure(error);
    Guide guide { channels[0].width, channels[0].height, {} };
    for (std::size_t i = 0; i < channels.size(); ++i)
        guide.channels.push_back({ channels[i].samples.data(), weights.empty() ? 1.0f : weights[i] });
    if (options.metric != "volume" && options.mesh == "adaptive")
        return Status::failure("metric=" + options.metric + ": expected volume with mesh=adaptive");
    Stopwatch watch;
    SimplifyOptions simplify_options;
    if (!find_initial_mesh(guide, parallel, progress, simplify_options.start, error))
        return Status::failure(error);
    stats.sample_seconds = watch.lap();

    simplify_options.base_faces = Index(options.base);
    if (options.mesh == "auto" && options.metric == "volume")
        simplify_options.bisection = bisection_limit(stats.guide);
    simplify_options.metric = options.metric == "quadric" ? Metric::quadric
        : options.metric == "exact"                       ? Metric::exact
                                                          : Metric::volume;
    simplify_options.parallel = parallel;
    simplify_options.progress = progress;
    return simplify(guide, std::move(simplify_options), hierarchy, guide_bands, &stats.engine);
}

/// Of a panorama, what the rows count decides the mesh; the bands are those of the guide itself.
Status ProgressiveImage::Data::build_hierarchy(const std::vector<Raster>& channels, const ParallelFor& parallel,
                                               const Progress& progress)
{
    if (!wrap || wrap.y)
        return simplify_guide(channels, parallel, progress);
    const Status status = simplify_guide(weighted_by_latitude(channels, wrap), parallel, progress);
    if (!status)
        return status;
    std::vector<std::vector<float>> samples;
    std::vector<const float*> pointers;
    samples.reserve(channels.size());
    pointers.reserve(channels.size());
    for (const Raster& channel : channels)
        samples.push_back(to_mesh_pixels(hierarchy, channel.samples.data()));
    for (const std::vector<float>& channel : samples)
        pointers.push_back(channel.data());
    return analyse(hierarchy, pointers, guide_bands, parallel);
}

Status ProgressiveImage::Data::adopt(const std::vector<Raster>& channels, const StoredHierarchy& stored)
{
    Hierarchy shape;
    shape.width = spec.width, shape.height = spec.height;
    std::vector<std::vector<float>> samples;
    std::vector<const float*> pointers;
    samples.reserve(channels.size());
    pointers.reserve(channels.size());
    for (const Raster& channel : channels)
        samples.push_back(to_mesh_pixels(shape, channel.samples.data()));
    for (const std::vector<float>& channel : samples)
        pointers.push_back(channel.data());
    const Status status = stored(pointers, hierarchy, guide_bands);
    if (status
        && (hierarchy.width != spec.width || hierarchy.height != spec.height || guide_bands.size() != channels.size()))
        return Status::failure("the stored hierarchy is not one of this picture");
    return status;
}

const LogBands* ProgressiveImage::Data::log_bands(const ParallelFor& parallel, std::string& error)
{
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    if (m_log != nullptr)
        return m_log.get();
    auto log = std::make_unique<LogBands>();
    log->luminance = log_luminance(source, colour, parallel);
    const std::vector<float> samples = to_mesh_pixels(hierarchy, log->luminance.guide.samples.data());
    std::vector<Bands> bands;
    const Status status = analyse(hierarchy, { samples.data() }, bands, parallel);
    error = status.error();
    if (!status)
        return nullptr;
    m_log_bands = std::move(bands[0]);
    log->bands = &m_log_bands;
    m_log = std::move(log);
    return m_log.get();
}

const NoiseModel& ProgressiveImage::Data::noise(const ParallelFor& parallel)
{
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    if (!m_noise)
        m_noise = estimate_noise(m_log->luminance, parallel);
    return *m_noise;
}

bool ProgressiveImage::Data::are_channels_the_guide() const
{
    return !m_guide_clipped && (stats.guide == "rgb" || (stats.guide == "luma" && colour.count() < 2));
}

const ChannelBands* ProgressiveImage::Data::channel_bands(const ParallelFor& parallel, std::string& error)
{
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    if (m_channels != nullptr)
        return m_channels.get();
    auto channels = std::make_unique<ChannelBands>();
    if (are_channels_the_guide()) {
        channels->bands = guide_bands;
        channels->exponent = -std::ilogb(m_guide_scale);
    } else {
        const float* p = static_cast<const float*>(source.localpixels());
        float largest = 0.0f;
        for (std::size_t i = 0; i < spec.image_pixels(); ++i, p += spec.nchannels)
            for (int c = 0; c < colour.count(); ++c)
                largest = std::max(largest, std::fabs(p[colour.channel(c)]));
        channels->exponent = largest > 0x1p100f ? 30 : 0;
        std::vector<std::vector<float>> samples;
        std::vector<const float*> pointers;
        samples.reserve(std::size_t(colour.count()));
        pointers.reserve(std::size_t(colour.count()));
        for (int c = 0; c < colour.count(); ++c)
            samples.push_back(mesh_samples(*this, colour.channel(c), channels->exponent));
        for (const std::vector<float>& channel : samples)
            pointers.push_back(channel.data());
        const Status status = analyse(hierarchy, pointers, channels->bands, parallel);
        error = status.error();
        if (!status)
            return nullptr;
    }
    m_channels = std::move(channels);
    return m_channels.get();
}

const std::vector<float>& ProgressiveImage::Data::luminance_without_texture(const ParallelFor& parallel)
{
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    if (m_without_texture.empty())
        m_without_texture = without_texture(hierarchy, m_log->luminance, parallel);
    return m_without_texture;
}

const Overview* ProgressiveImage::Data::overview(const ParallelFor& parallel, std::string& error)
{
    const LogBands* log = log_bands(parallel, error);
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    if (log == nullptr || m_overview != nullptr)
        return m_overview.get();
    auto overview = std::make_unique<Overview>();
    const Status status = look_from_afar(log->luminance, wrap, parallel, *overview);
    error = status.error();
    if (status)
        m_overview = std::move(overview);
    return m_overview.get();
}

std::shared_ptr<const Envelope> ProgressiveImage::Data::envelope(const std::shared_ptr<const PlannedBands>& planned,
                                                                 const EnvelopeOptions& how,
                                                                 const ParallelFor& parallel)
{
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    if (m_envelope_bands != planned || !(m_envelope_options == how)) {
        m_envelope = std::make_shared<const Envelope>(contrast_envelope(*planned, how, parallel));
        m_envelope_bands = planned;
        m_envelope_options = how;
    }
    return m_envelope;
}

std::vector<float> ProgressiveImage::Data::take_scratch()
{
    const std::lock_guard<std::mutex> lock(m_scratch_mutex);
    std::vector<float> scratch;
    if (!m_scratch.empty()) {
        scratch = std::move(m_scratch.back());
        m_scratch.pop_back();
    }
    return scratch;
}

void ProgressiveImage::Data::keep_scratch(std::vector<float>&& scratch)
{
    constexpr std::size_t kKept = 2;
    const std::lock_guard<std::mutex> lock(m_scratch_mutex);
    if (m_scratch.size() < kKept)
        m_scratch.push_back(std::move(scratch));
}

std::size_t ProgressiveImage::Data::memory()
{
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    std::size_t total = spec.image_pixels() * std::size_t(spec.nchannels) * sizeof(float) + hierarchy.memory()
        + bytes(m_log_bands) + specials.capacity() * sizeof(SpecialSample);
    for (const Bands& bands : guide_bands)
        total += bytes(bands);
    if (m_log != nullptr)
        total += m_log->luminance.guide.samples.capacity() * sizeof(float);
    if (m_plan != nullptr)
        total += m_plan->memory();
    if (m_planned_log != nullptr)
        total += m_planned_log->ordered.capacity() * sizeof(Detail);
    if (m_planned_channels != nullptr)
        for (const std::vector<Detail>& details : m_planned_channels->ordered)
            total += details.capacity() * sizeof(Detail);
    if (m_channels != nullptr)
        for (const Bands& bands : m_channels->bands)
            total += bytes(bands);
    for (const std::shared_ptr<SmoothingData>& smoothing : m_smoothing)
        total += smoothing != nullptr ? smoothing->source.memory() : 0;
    if (m_regions != nullptr)
        total += m_regions->memory();
    if (small != nullptr)
        total += small->memory();
    const std::lock_guard<std::mutex> scratch_lock(m_scratch_mutex);
    for (const std::vector<float>& scratch : m_scratch)
        total += scratch.capacity() * sizeof(float);
    if (m_envelope != nullptr)
        total += (m_envelope->contrast.capacity() + m_envelope->visibility.capacity()) * sizeof(float)
            + m_envelope->size.capacity() * sizeof(FeatureSize);
    total += m_without_texture.capacity() * sizeof(float);
    if (m_visibility != nullptr)
        total += m_visibility->capacity() * sizeof(float);
    return total;
}

bool ProgressiveImage::build(const OIIO::ImageBuf& src, const BuildOptions& options, int nthreads, Progress progress)
{
    return make(src, options, [&](Data& data, std::string& error) {
        const ParallelFor parallel = pool_loop(nthreads);
        if (options.preview)
            return data.build_preview(parallel, progress, error);
        const auto simplify = [&](const auto& guide) {
            return data.build_hierarchy(guide, parallel, progress);
        };
        return data.hierarchy_of_guide(simplify, parallel, error);
    });
}

bool ProgressiveImage::adopt(const OIIO::ImageBuf& src, const StoredHierarchy& stored, const BuildOptions& options,
                             int nthreads)
{
    return make(src, options, [&](Data& data, std::string& error) {
        const ParallelFor parallel = pool_loop(nthreads);
        if (options.preview)
            return data.build_preview(parallel, {}, error);
        const auto adopt = [&](const auto& guide) {
            return data.wrap ? data.build_hierarchy(guide, parallel, {}) : data.adopt(guide, stored);
        };
        return data.hierarchy_of_guide(adopt, parallel, error);
    });
}

ProgressiveImage ProgressiveImage::unwrapped(const OIIO::ImageBuf& src, int nthreads) const
{
    if (initialized() && m_data->small != nullptr) {
        ProgressiveImage none;
        none.m_error = "preview: expected an image built without it, since a file stores its whole hierarchy";
        return none;
    }
    if (!initialized() || !m_data->wrap)
        return *this;
    BuildOptions options = m_data->options;
    options.wrap = "none";
    ProgressiveImage plain;
    plain.build(src, options, nthreads);
    return plain;
}

bool ProgressiveImage::make(const OIIO::ImageBuf& src, const BuildOptions& options, const MakeHierarchy& make_hierarchy)
{
    m_data.reset();
    m_error.clear();
    try {
        auto data = std::make_shared<Data>();
        data->options = options;
        Stopwatch watch;
        if (check_options(options, m_error) && data->read(src, m_error)) {
            data->stats.read_seconds = watch.lap();
            if (make_hierarchy(*data, m_error))
                m_data = std::move(data);
            if (options.preview && m_data != nullptr)
                m_data->stats.simplify_seconds = watch.lap();
        }
    } catch (const std::bad_alloc&) {
        m_error = "not enough memory";
    } catch (const std::exception& exception) {
        m_error = exception.what();
    }
    if (m_data == nullptr && m_error.empty())
        m_error = "the picture cannot be read";
    return m_data != nullptr;
}

const Hierarchy& ProgressiveImage::hierarchy() const
{
    return m_data->small != nullptr ? m_data->small->hierarchy : m_data->hierarchy;
}
const std::vector<Bands>& ProgressiveImage::guide_bands() const
{
    return m_data->small != nullptr ? m_data->small->guide_bands : m_data->guide_bands;
}
const OIIO::ImageBuf& ProgressiveImage::source() const
{
    return m_data->source;
}
const OIIO::ImageSpec& ProgressiveImage::spec() const
{
    return m_data->picture;
}
const BuildOptions& ProgressiveImage::options() const
{
    return m_data->options;
}
const BuildStats& ProgressiveImage::stats() const
{
    return m_data->stats;
}
std::size_t ProgressiveImage::memory() const
{
    return m_data->memory();
}

}  // namespace PIMG_ABI
}  // namespace pimg
