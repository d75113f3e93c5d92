// SPDX-License-Identifier: BSD-3-Clause
// HDR compression (paper, section 5.1):
//   log luminance ──gains──▶ compressed ──exposure──▶ display luminance ──colour ratio──▶ display RGB
#include <pimg/detail/format.h>
#include <pimg/display.h>
#include <pimg/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <OpenImageIO/strutil.h>

#include "frame/image_filter.h"
#include "ops/display_fit.h"
#include "ops/scene_light.h"
#include "ops/zone_curve.h"
#include "source/gains/contrast_envelope.h"
#include "source/overview.h"
#include "source/preview.h"

namespace pimg {
inline namespace PIMG_ABI {
namespace ImageBufAlgo {

namespace {

/// Gain of details that are noise. Chosen so that a noisy dim room shows no more noise beside its relief than the
/// source does: 1.2, where none of the details would be calmed 4.2 (tm_look.py noise).
constexpr float kQuiet = 0.1f;

/// Compressed pictures need less saturation for the same colourfulness (Mantiuk, Tomaszewska and Heidrich, "Color
/// correction for tone mapping", 2009). Their formula is for one contrast of the whole picture; here details keep
/// theirs, and of the compressed base this much is left.
constexpr float kSaturation = 0.9f;

/// log2 of the luminance at guide value 0 after compression: the base is scaled about luminance 1.
float compressed_reference(const HdrCompressOptions& options, float reference)
{
    return options.s0 * std::log2(reference);
}

DetailGain gain_of(const HdrCompressOptions& options)
{
    return { options.s0, options.beta, options.dmax * kUnitsPerStop, options.detail, kQuiet };
}

EnvelopeOptions envelope_of(const HdrCompressOptions& options, const NoiseModel& noise)
{
    return { options.coherence, range_of(options) * kUnitsPerStop,
             options.fit ? noise.times(options.denoise) : NoiseModel(), 0.0f };
}

/// Fills in what is 0 and not found from dmax alone.
void find_exposure(const Overview& overview, float reference, HdrCompressOptions& options)
{
    std::vector<float> values(overview.bands->plan.places()), cells(overview.hierarchy.mesh_pixels());
    const Envelope envelope = contrast_envelope(*overview.bands, envelope_of(options, {}), {});
    compress(*overview.bands, gain_of(options), {}, envelope, {}, values.data());
    overview.bands->plan.scatter(overview.hierarchy, values.data(), cells.data());
    crop_to_picture(overview.hierarchy, cells);
    const float dark = compressed_reference(options, reference);
    CompressedCells stops;
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (overview.lit[i])
            stops.push_back({ cells[i] / kUnitsPerStop + dark, overview.weight[i] });
    find_exposure(std::move(stops), find_scene_key(overview), dark, options);
}

bool raises_zones(const HdrCompressOptions& options)
{
    return !options.zones.empty() || options.shadows != 0.0f || options.midtones != 0.0f || options.highlights != 0.0f;
}

/// Fills in all options that are 0. Calls get_overview() only if they need it.
template<class GetOverview>
bool resolve(HdrCompressOptions& options, float reference, GetOverview&& get_overview)
{
    const bool exposed = !(options.fit || raises_zones(options)) || (options.key > 0.0f && options.white > 0.0f);
    const Overview* overview = exposed && options.dmax > 0.0f ? nullptr : get_overview();
    if (overview == nullptr && !(exposed && options.dmax > 0.0f))
        return false;
    find_compression(overview ? overview->range / kUnitsPerStop : 0.0f, options);
    if (!exposed)
        find_exposure(*overview, reference, options);
    return true;
}

/// The compressed log luminance of every pixel and the options it was made with.
struct Compressed {
    HdrCompressOptions options;  ///< resolved
    ZoneCurve zones;
    const LogLuminance* luminance = nullptr;
    Scratch samples;
    NoiseModel noise;
};

/// Stops of the result to one guide unit of the compressed luminance.
float slope_of(const HdrCompressOptions& options)
{
    return (options.fit ? options.contrast : 1.0f) / kUnitsPerStop;
}

/// log2 of the factor between the source and the result before the tone curve is
///     slope_of() * compressed - guide / kUnitsPerStop + offset_of().
/// For displays, the luminance `key` after compression becomes middle grey; light of a scene keeps its middle grey.
float offset_of(const Compressed& c)
{
    const HdrCompressOptions& options = c.options;
    const float reference = std::log2(c.luminance->reference), grey = std::log2(kMiddleGrey);
    const float compressed = compressed_reference(options, c.luminance->reference);
    const bool is_display = options.output == "display";
    if (!options.fit && is_display)
        return compressed - reference;
    const float becomes_grey = is_display ? std::log2(options.key) : options.s0 * grey;
    const float contrast = slope_of(options) * kUnitsPerStop;
    return contrast * (compressed - becomes_grey) + grey + options.exposure - reference;
}

/// Raises the zones of the compressed picture. `scene` is its log luminance without texture, in guide units, so that texture
/// keeps its contrast where one zone passes into another.
void raise_zones(const std::vector<float>& scene, const ParallelFor& parallel, Compressed& c)
{
    const float reference = std::log2(c.luminance->reference);
    const float grey = std::log2(c.options.key) / c.options.s0;  // what becomes middle grey, before compression
    const float inverse = 1.0f / slope_of(c.options);
    const Raster& guide = c.luminance->guide;
    for_rows(parallel, 0, guide.height, [&](int y) {
        const std::size_t first = std::size_t(y) * std::size_t(guide.width);
        for (std::size_t i = first; i < first + std::size_t(guide.width); ++i)
            (*c.samples)[i] += inverse * c.zones.at(scene[i] / kUnitsPerStop + reference - grey);
    });
}

/// Fills in the samples of `c` by the hierarchy of `data`, whose log luminance is that of `c`.
void compress_details(ProgressiveImage::Data& data, const ParallelFor& parallel, Compressed& c)
{
    const HdrCompressOptions& options = c.options;
    std::string error;
    const LogBands& log = *data.log_bands(parallel, error);  // found before
    const DetailGain gain = gain_of(options);
    EnvelopeOptions how = envelope_of(options, data.noise(parallel));
    const SizeGains sizes { options.fine, options.medium, options.coarse };
    if (!sizes.none())
        how.diagonal = std::hypot(float(data.spec.width), float(data.spec.height));
    const std::shared_ptr<const PlannedBands> planned = data.planned_log_bands(parallel);
    Scratch values(data, planned->plan.places());
    const std::shared_ptr<const Envelope> envelope = data.envelope(planned, how, parallel);
    compress(*planned, gain, sizes, *envelope, parallel, (*values).data());
    planned->plan.scatter(data.hierarchy, (*values).data(), (*c.samples).data(), parallel);
    crop_to_picture(data.hierarchy, *c.samples);
    compress_residual(data.hierarchy, *log.bands, gain, options.coherence, log.luminance.guide.samples, *c.samples);
    if (!c.zones.flat())
        raise_zones(data.luminance_without_texture(parallel), parallel, c);
}

bool compress_luminance(ProgressiveImage::Data& data, const ParallelFor& parallel, Compressed& c, std::string& error)
{
    HdrCompressOptions& options = c.options;
    const LogBands* log = ZoneCurve::make(options, c.zones, error) ? data.log_bands(parallel, error) : nullptr;
    if (log == nullptr)
        return false;
    c.luminance = &log->luminance;
    c.noise = data.noise(parallel).times(options.denoise);
    if (!resolve(options, log->luminance.reference, [&] { return data.overview(parallel, error); }))
        return false;
    if (data.small == nullptr) {
        compress_details(data, parallel, c);
        return true;
    }
    const LogBands& log_of_small = *data.small->log_bands(parallel, error);
    Compressed small {
        options, c.zones, &log_of_small.luminance, { *data.small, data.small->hierarchy.mesh_pixels() }, {}
    };
    compress_details(*data.small, parallel, small);
    // Of the details that the reduced picture lacks, some are noise and some are texture.
    const float usual = std::sqrt(options.s0 * std::max(options.detail, options.s0));
    enlarge(log_of_small.luminance.guide, *small.samples, data.step, log->luminance.guide, usual, parallel, *c.samples);
    return true;
}

/// Makes the rows of the result.
class Renderer {
public:
    Renderer(const ProgressiveImage::Data& data, const Compressed& compressed)
        : m_data(data),
          m_compressed(compressed),
          m_how(how(data.colour, compressed))
    {
        const Colour& colour = data.colour;
        m_in_place = data.spec.nchannels == 3 && colour.count() == 3 && !colour.encoded() && colour.channel(0) == 0
            && colour.channel(1) == 1;
    }

    void render(const RowSpan& span, float* row) const
    {
        const OIIO::ImageSpec& spec = m_data.source.spec();
        const std::size_t count = span.width();
        const Index first = Index(span.y - spec.y) * Index(spec.width) + Index(span.xbegin - spec.x);
        if (m_in_place)
            recolour_pixels(first, count, row);
        else
            for (std::size_t x = 0; x < count; x += kBatch)
                render_batch(first + Index(x), std::min(kBatch, count - x), row + x * std::size_t(spec.nchannels));
        put_back_specials(first, count, row);
    }

private:
    static constexpr std::size_t kBatch = 256;

    static Recolour how(const Colour& colour, const Compressed& compressed)
    {
        const HdrCompressOptions& options = compressed.options;
        const bool converts = options.fit && !colour.has_rec709_primaries();
        return { converts ? Colour().weights() : colour.weights(),
                 slope_of(options),
                 offset_of(compressed),
                 options.saturation * (options.fit ? kSaturation : 1.0f),
                 options.fit,
                 options.fit ? tone_curve(options) : ToneCurve(0.0f, 1.0f, 1.0f),
                 compressed.noise.read,
                 compressed.noise.photon,
                 options.gamut == "p3" };
    }

    const float* compressed(Index pixel) const { return &(*m_compressed.samples)[pixel]; }
    const float* guide(Index pixel) const { return &m_compressed.luminance->guide.samples[pixel]; }

    /// Results for displays are made in Rec. 709, so that they do not depend on the primaries of the source.
    void recolour_pixels(Index first, std::size_t count, float* rgb) const
    {
        if (m_compressed.options.fit) {
            put_in_filled(first, count, rgb);
            m_data.colour.to_rec709(rgb, count);
        }
        recolour(m_how, compressed(first), guide(first), count, rgb);
        if (m_compressed.options.fit)
            m_data.colour.from_rec709(rgb, count);
    }

    /// Gives pixels that are ringing the light around them.
    void put_in_filled(Index first, std::size_t count, float* rgb) const
    {
        const std::vector<FilledPixel>& filled = m_compressed.luminance->filled;
        auto it = std::lower_bound(filled.begin(), filled.end(), first,
                                   [](const FilledPixel& f, Index pixel) { return f.pixel < pixel; });
        for (; it != filled.end() && it->pixel < first + Index(count); ++it)
            std::copy(it->rgb.begin(), it->rgb.end(), rgb + 3 * (it->pixel - first));
    }

    /// Renders pixels whose colours are not three neighbouring linear samples: by way of a buffer.
    void render_batch(Index first, std::size_t count, float* pixels) const
    {
        float rgb[3 * kBatch];
        linear_pixels(m_data.source, m_data.colour, first, count, rgb);
        recolour_pixels(first, count, rgb);
        associate_pixels(m_data.source, m_data.colour, first, count, rgb);
        for (int c = 0; c < m_data.colour.count(); ++c) {
            float* to = pixels + m_data.colour.channel(c);
            for (std::size_t i = 0; i < count; ++i)
                to[i * std::size_t(m_data.spec.nchannels)] = rgb[3 * i + std::size_t(c)];
        }
    }

    /// Handles samples that were not finite. In a result for displays +Inf is white and NaN stays what the pixels
    /// around gave it; in a result in the picture's own units they are what they were.
    void put_back_specials(Index first, std::size_t count, float* row) const
    {
        for_specials(m_data, first, count, [&](const SpecialSample& s) {
            float* pixel = row + std::size_t(s.pixel - first) * std::size_t(m_data.source.nchannels());
            if (!m_compressed.options.fit)
                pixel[s.channel] = s.value;
            else if (s.value > 0.0f) {
                float white[3] = { 1.0f, 1.0f, 1.0f };
                m_data.colour.from_rec709(white, 1);
                for (int c = 0; c < m_data.colour.count(); ++c)
                    pixel[m_data.colour.channel(c)] = white[c];
            }
        });
    }

    const ProgressiveImage::Data& m_data;
    const Compressed& m_compressed;
    Recolour m_how;
    bool m_in_place;  ///< rows of the picture are linear RGB without other channels
};

}  // namespace

bool resolve_hdr_compress(const ProgressiveImage& src, HdrCompressOptions& options, std::string& error, int nthreads)
{
    if (!src.initialized()) {
        error = src.error().empty() ? "the progressive image has not been built" : src.error();
        return false;
    }
    const ParallelFor parallel = pool_loop(nthreads);
    HdrCompressOptions resolved = options;
    const LogBands* log = check_options(options, error) ? src.data()->log_bands(parallel, error) : nullptr;
    if (log == nullptr
        || !resolve(resolved, log->luminance.reference, [&] { return src.data()->overview(parallel, error); }))
        return false;
    options = resolved;
    return true;
}

bool resolve_hdr_compress(const ImageBuf& src, HdrCompressOptions& options, std::string& error,
                          const BuildOptions& build, int nthreads)
{
    ProgressiveImage::Data data;
    data.options = build;
    HdrCompressOptions resolved = options;
    if (!check_options(options, error) || !data.read(src, error))
        return false;
    const ParallelFor parallel = pool_loop(nthreads);
    repair(data.source, data.colour, parallel);
    const LogLuminance luminance = log_luminance(data.source, data.colour, parallel);
    Overview overview;
    const auto look = [&]() -> const Overview* {
        const Status status = look_from_afar(luminance, data.wrap, parallel, overview);
        error = status.error();
        return status ? &overview : nullptr;
    };
    if (!resolve(resolved, luminance.reference, look))
        return false;
    options = resolved;
    return true;
}

namespace {

/// Light that other light is to add up to, and factors on light, are not stored by compressions of OpenEXR that change
/// numbers.
void ask_for_lossless(OIIO::ImageSpec& spec)
{
    const std::string compression = spec.get_string_attribute("compression");
    for (const char* lossy : { "b44", "dwa", "pxr24" })
        if (OIIO::Strutil::istarts_with(compression, lossy))
            spec.attribute("compression", "zip");
}

}  // namespace

bool on_hierarchy::hdr_compress(ImageBuf& dst, const ProgressiveImage& src, const HdrCompressOptions& options, ROI roi,
                                int nthreads)
{
    return run_filter(dst, options, [&] {
        if (options.aovs && options.output != "scene") {
            set_error(dst, "aovs: expected output=scene; what a display shows does not add up");
            return false;
        }
        const bool is_gain = options.output == "gain";
        if (!(is_gain ? prepare_single(dst, src, roi, "gain", OIIO::TypeDesc::FLOAT, Previews::taken)
                      : prepare(dst, src, roi, ResultType::full_float, Previews::taken)))
            return false;
        ProgressiveImage::Data& data = *src.data();
        const ParallelFor parallel = pool_loop(nthreads);
        Compressed compressed { options, {}, nullptr, { data, data.hierarchy.mesh_pixels() }, {} };
        std::string error;
        if (!compress_luminance(data, parallel, compressed, error)) {
            set_error(dst, error);
            return false;
        }
        const LightGain gain { slope_of(compressed.options), offset_of(compressed), (*compressed.samples).data(),
                               compressed.luminance->guide.samples.data() };
        if (options.output != "display")
            ask_for_lossless(dst.specmod());
        if (is_gain) {
            write_gain(dst, data, roi, parallel, gain);
            return true;
        }
        if (options.output == "scene") {
            write_scene_light(dst, data, roi, parallel, gain, options.aovs);
        } else {
            const Renderer renderer(data, compressed);
            write_rows(dst, data, roi, parallel, [&](const RowSpan& span, float* row) { renderer.render(span, row); });
        }
        data.colour.declare_linear(dst.specmod());
        declare_gamut(dst.specmod(), options.output == "display" && options.fit ? options.gamut : "");
        return true;
    });
}

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
