// SPDX-License-Identifier: BSD-3-Clause
// HDR compression (paper, section 5.1):
//   log luminance ──gains──▶ compressed ──exposure──▶ display luminance ──colour ratio──▶ display RGB
#include <pimg/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "contrast_envelope.h"
#include "display_fit.h"
#include "image_filter.h"
#include "overview.h"

namespace pimg {
namespace ImageBufAlgo {

namespace {

/// log2 of the luminance at guide value 0 after compression: the base is scaled about luminance 1.
float compressed_reference(const HdrCompressOptions& options, float reference)
{
    return options.s0 * std::log2(reference);
}

DetailGain gain_of(const HdrCompressOptions& options)
{
    return { options.s0, options.beta, options.dmax * kUnitsPerStop };
}

/// Fills in what is 0 and not found from dmax alone.
void find_exposure(const Overview& overview, float reference, HdrCompressOptions& options)
{
    std::vector<float> envelope, values(overview.hierarchy.vertices());
    if (options.coherence > 0.0f)
        envelope = contrast_envelope(overview.hierarchy, overview.bands, options.coherence,
                                     range_of(options) * kUnitsPerStop);
    compress(overview.hierarchy, overview.bands, gain_of(options), envelope.empty() ? nullptr : &envelope,
             values.data());
    const std::vector<float> cells = to_picture(overview.hierarchy, values.data());
    const float dark = compressed_reference(options, reference);
    std::vector<float> stops;
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (overview.lit[i])
            stops.push_back(cells[i] / kUnitsPerStop + dark);
    find_exposure(std::move(stops), dark, options);
}

/// An Overview is asked for only if there is something to find.
template<class GetOverview>
bool resolve(HdrCompressOptions& options, float reference, GetOverview&& get_overview)
{
    const bool exposed = !options.fit || (options.key > 0.0f && options.white > 0.0f);
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
    const LogLuminance* luminance = nullptr;
    Scratch samples;
};

bool compress_luminance(ProgressiveImage::Data& data, const ParallelFor& parallel, Compressed& c, std::string& error)
{
    const LogBands* log = data.log_bands(parallel, error);
    if (log == nullptr)
        return false;
    HdrCompressOptions& options = c.options;
    c.luminance = &log->luminance;
    if (!resolve(options, log->luminance.reference, [&] { return data.overview(parallel, error); }))
        return false;
    const DetailGain gain = gain_of(options);
    Scratch scratch(data, data.hierarchy.vertices());
    std::vector<float>& values = *scratch;
    std::shared_ptr<const std::vector<float>> envelope;
    if (options.coherence > 0.0f)
        envelope = data.envelope(options.coherence, range_of(options) * kUnitsPerStop);
    compress(data.hierarchy, *log->bands, gain, envelope.get(), values.data());
    scatter(data.hierarchy, values.data(), (*c.samples).data(), parallel);
    crop_to_picture(data.hierarchy, *c.samples);
    compress_residual(data.hierarchy, *log->bands, gain, options.coherence, log->luminance.guide.samples, *c.samples);
    return true;
}

/// Colour of one pixel at another luminance.
class Recolour {
public:
    Recolour(const Colour& colour, const HdrCompressOptions& options)
        : m_colour(colour),
          m_saturation(options.saturation),
          m_fit(options.fit),
          m_shoulder(options.fit ? shoulder_white(options) : 1.0f)
    {
    }

    /// `scale`: compressed over scene luminance, in display units if fitted.
    void operator()(float* rgb, float scale) const
    {
        const float luminance = std::min(m_colour.luminance(rgb), std::numeric_limits<float>::max());
        if (m_saturation != 1.0f && luminance > 0.0f)
            saturate(rgb, luminance);
        if (!m_fit) {
            for (int i = 0; i < 3; ++i)
                rgb[i] *= scale;
        } else if (luminance > 0.0f) {
            const float y = m_shoulder(luminance * scale);
            const float ratio = y / luminance;
            for (int i = 0; i < 3; ++i)
                rgb[i] = (luminance > 1e30f ? rgb[i] / luminance * y : rgb[i] * ratio);
            into_gamut(rgb, y);
        } else {
            rgb[0] = rgb[1] = rgb[2] = 0.0f;
        }
    }

private:
    void saturate(float* rgb, float luminance) const
    {
        for (int i = 0; i < 3; ++i)
            rgb[i] = std::copysign(luminance * std::pow(std::fabs(rgb[i] / luminance), m_saturation), rgb[i]);
    }

    /// Mixes in as much of grey `y` as brings all channels into 0..1: that keeps hue and luminance.
    static void into_gamut(float* rgb, float y)
    {
        const float least = std::min({ rgb[0], rgb[1], rgb[2] }), most = std::max({ rgb[0], rgb[1], rgb[2] });
        if (least >= 0.0f && most <= 1.0f)
            return;
        float share = 1.0f;
        if (most > 1.0f)
            share = (1.0f - y) / (most - y);
        if (least < 0.0f)
            share = std::min(share, y / (y - least));
        for (int i = 0; i < 3; ++i)
            rgb[i] = std::clamp(y + share * (rgb[i] - y), 0.0f, 1.0f);
    }

    const Colour& m_colour;
    float m_saturation;
    bool m_fit;
    Shoulder m_shoulder;
};

/// Makes rows of results.
class Renderer {
public:
    Renderer(const ProgressiveImage::Data& data, const Compressed& compressed)
        : m_data(data),
          m_compressed(compressed),
          m_recolour(data.colour, compressed.options)
    {
        // log2 of what to multiply a pixel by = m_slope * compressed sample - guide sample + m_offset.
        const HdrCompressOptions& options = compressed.options;
        const float reference = std::log2(compressed.luminance->reference);
        const float compressed_ref = compressed_reference(options, compressed.luminance->reference);
        if (options.fit) {
            m_slope = options.contrast / kUnitsPerStop;
            m_offset = options.contrast * (compressed_ref - std::log2(options.key)) + std::log2(kMiddleGrey)
                + options.exposure - reference;
        } else {
            m_slope = 1.0f / kUnitsPerStop;
            m_offset = compressed_ref - reference;
        }
    }

    void render(int y, const OIIO::ROI& roi, float* row) const
    {
        const OIIO::ImageSpec& spec = m_data.source.spec();
        const std::size_t count = std::size_t(roi.width());
        const Index first = Index(y - spec.y) * Index(spec.width) + Index(roi.xbegin - spec.x);
        std::vector<float> scratch(4 * count);
        float *rgb = scratch.data(), *scales = rgb + 3 * count;
        linear_pixels(m_data.source, m_data.colour, first, count, rgb);
        const float* in = &m_compressed.luminance->guide.samples[first];
        const float* out = &(*m_compressed.samples)[first];
        for (std::size_t i = 0; i < count; ++i)
            scales[i] = m_slope * out[i] - in[i] * (1.0f / kUnitsPerStop) + m_offset;
        exp2_in_place(scales, count);
        for (std::size_t i = 0; i < count; ++i)
            m_recolour(rgb + 3 * i, scales[i]);
        for (int c = 0; c < m_data.colour.count(); ++c) {
            float* to = row + m_data.colour.channel(c);
            for (std::size_t i = 0; i < count; ++i)
                to[i * std::size_t(spec.nchannels)] = rgb[3 * i + std::size_t(c)];
        }
        put_back_specials(first, count, row);
    }

private:
    /// As a display shows them: +Inf white; NaN stays what is around it. In the picture's own units: as they were.
    void put_back_specials(Index first, std::size_t count, float* row) const
    {
        for_specials(m_data, first, count, [&](const SpecialSample& s) {
            float* pixel = row + std::size_t(s.pixel - first) * std::size_t(m_data.source.nchannels());
            if (!m_compressed.options.fit)
                pixel[s.channel] = s.value;
            else if (s.value > 0.0f)
                for (int c = 0; c < m_data.colour.count(); ++c)
                    pixel[m_data.colour.channel(c)] = 1.0f;
        });
    }

    const ProgressiveImage::Data& m_data;
    const Compressed& m_compressed;
    Recolour m_recolour;
    float m_slope, m_offset;
};

/// Metadata of what is now linear light.
void declare_linear(ImageBuf& dst, const Colour& colour)
{
    OIIO::ImageSpec& spec = dst.specmod();
    if (!colour.encoded() && spec.find_attribute("oiio:ColorSpace") != nullptr)
        return;
    spec.attribute("oiio:ColorSpace", colour.linear_name());
    for (const char* stale : { "oiio:Gamma", "ICCProfile", "Exif:ColorSpace", "tiff:ColorSpace", "png:gAMA" })
        spec.erase_attribute(stale);
}

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
        const Status status = look_from_afar(luminance, parallel, overview);
        error = status.error();
        return status ? &overview : nullptr;
    };
    if (!resolve(resolved, luminance.reference, look))
        return false;
    options = resolved;
    return true;
}

bool hdr_compress(ImageBuf& dst, const ProgressiveImage& src, const HdrCompressOptions& options, ROI roi, int nthreads)
{
    return run_filter(dst, options, [&] {
        if (!prepare(dst, src, roi, ResultType::full_float))
            return false;
        ProgressiveImage::Data& data = *src.data();
        const ParallelFor parallel = pool_loop(nthreads);
        Compressed compressed { options, nullptr, { data, data.hierarchy.mesh_pixels() } };
        std::string error;
        if (!compress_luminance(data, parallel, compressed, error)) {
            dst.errorfmt("{}", error);
            return false;
        }
        const Renderer renderer(data, compressed);
        write_rows(dst, data, roi, parallel, [&](int y, float* row) { renderer.render(y, roi, row); });
        declare_linear(dst, data.colour);
        return true;
    });
}

bool hdr_compress(ImageBuf& dst, const ImageBuf& src, const HdrCompressOptions& options, ROI roi, int nthreads)
{
    ProgressiveImage progressive;
    return build_source(dst, src, nthreads, progressive) && hdr_compress(dst, progressive, options, roi, nthreads);
}

ImageBuf hdr_compress(const ImageBuf& src, const HdrCompressOptions& options, ROI roi, int nthreads)
{
    return returned("hdr_compress", [&](ImageBuf& dst) { return hdr_compress(dst, src, options, roi, nthreads); });
}

ImageBuf hdr_compress(const ProgressiveImage& src, const HdrCompressOptions& options, ROI roi, int nthreads)
{
    return returned("hdr_compress", [&](ImageBuf& dst) { return hdr_compress(dst, src, options, roi, nthreads); });
}

}  // namespace ImageBufAlgo
}  // namespace pimg
