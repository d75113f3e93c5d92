// SPDX-License-Identifier: BSD-3-Clause
#include "source/guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <pimg/detail/parallel.h>

#include "source/samples/ringing.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Quantiles and factors that limit the range of luminance in a guide. They are relative to the picture, so that a
/// scaled picture gives the same guide; and they are quantiles, so that no single pixel moves them.
constexpr double kFloorQuantile = 0.001;  ///< black is a stop below this quantile ...
constexpr float kFloorBelowQuantile = 0.5f;
constexpr float kFloorBelowMiddle = 0x1p-16f;  ///< ... but no more than 16 stops below the median
constexpr double kCeilingQuantile = 0.9995;
constexpr float kCeilingAbove = 0x1p8f;  ///< light sources may be 8 stops above that quantile
constexpr double kHotQuantile = 0.999;   ///< a hot pixel is above this quantile ...
constexpr float kHotRatio = 0x1p10f;     ///< ... and 10 stops above all its neighbours

const float* pixel(const OIIO::ImageBuf& picture, int x, int y)
{
    const OIIO::ImageSpec& spec = picture.spec();
    return static_cast<const float*>(picture.pixeladdr(spec.x + x, spec.y + y, spec.z));
}

/// Where red, green and blue come from; the first channel stands in for those that are missing.
std::array<int, 3> rgb_channels(const Colour& colour)
{
    const int first = colour.channel(0);
    return { first, colour.count() > 1 ? colour.channel(1) : first, colour.count() > 2 ? colour.channel(2) : first };
}

/// Calls body(neighbour) for the up to eight pixels around pixel i.
template<class Body>
void for_each_neighbour(int width, int height, Index i, Body&& body)
{
    const int x = int(i % Index(width)), y = int(i / Index(width));
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, height - 1); ++ny)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, width - 1); ++nx)
            if (nx != x || ny != y)
                body(Index(ny) * Index(width) + Index(nx));
}

}  // namespace

void fill_holes(Raster& raster, const std::vector<Index>& holes)
{
    enum State : unsigned char { known, unknown, queued };
    if (holes.empty())
        return;
    std::vector<unsigned char> state(raster.samples.size(), known);
    for (Index i : holes) {
        state[i] = unknown;
        raster.samples[i] = 0.0f;
    }
    // Layer by layer: the values of a layer depend on earlier layers only, so the order of its pixels does not matter.
    std::vector<Index> layer, next;
    const auto touches_known = [&](Index i) {
        bool found = false;
        for_each_neighbour(raster.width, raster.height, i, [&](Index n) { found = found || state[n] == known; });
        return found;
    };
    std::copy_if(holes.begin(), holes.end(), std::back_inserter(layer), touches_known);
    while (!layer.empty()) {
        for (Index i : layer)
            state[i] = queued;
        for (Index i : layer) {
            double sum = 0.0;
            int count = 0;
            for_each_neighbour(raster.width, raster.height, i, [&](Index n) {
                if (state[n] == known) {
                    sum += double(raster.samples[n]);
                    ++count;
                }
            });
            raster.samples[i] = float(sum / count);
        }
        next.clear();
        for (Index i : layer) {
            state[i] = known;
            for_each_neighbour(raster.width, raster.height, i, [&](Index n) {
                if (state[n] == unknown) {
                    state[n] = queued;
                    next.push_back(n);
                }
            });
        }
        layer.swap(next);
    }
}

std::vector<SpecialSample> repair(OIIO::ImageBuf& picture, const Colour& colour, const ParallelFor& parallel)
{
    const OIIO::ImageSpec spec = picture.spec();
    std::vector<std::vector<SpecialSample>> found(std::size_t(spec.height));
    for_rows(parallel, 0, spec.height, [&](int y) {
        const float* samples = pixel(picture, 0, y);
        for (int x = 0; x < spec.width; ++x, samples += spec.nchannels)
            for (int i = 0; i < colour.count(); ++i) {
                const float value = samples[colour.channel(i)];
                if (!std::isfinite(value))
                    found[std::size_t(y)].push_back(
                        { Index(y) * Index(spec.width) + Index(x), colour.channel(i), value });
            }
    });
    std::vector<SpecialSample> specials;
    for (const auto& row : found)
        specials.insert(specials.end(), row.begin(), row.end());
    for (int i = 0; i < colour.count() && !specials.empty(); ++i) {
        std::vector<Index> holes;
        for (const SpecialSample& s : specials)
            if (s.channel == colour.channel(i))
                holes.push_back(s.pixel);
        if (holes.empty())
            continue;
        Raster raster { spec.width, spec.height, std::vector<float>(spec.image_pixels()) };
        for (Index p = 0; p < Index(raster.samples.size()); ++p)
            raster.samples[p] =
                pixel(picture, int(p % Index(spec.width)), int(p / Index(spec.width)))[colour.channel(i)];
        fill_holes(raster, holes);
        for (Index p : holes)
            const_cast<float*>(pixel(picture, int(p % Index(spec.width)),
                                     int(p / Index(spec.width))))[colour.channel(i)] = raster.samples[p];
    }
    return specials;
}

/// Lowest bits of a float that a bin ignores: five of the mantissa's 23 bits are kept.
constexpr int kDropped = 18;

MagnitudeHistogram::MagnitudeHistogram(const std::vector<float>& values) : m_bins(1u << (31 - kDropped))
{
    for (float value : values) {
        if (!(value > 0.0f))
            continue;
        std::uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        ++m_bins[bits >> kDropped];
        ++m_count;
    }
}

float MagnitudeHistogram::quantile(double q) const
{
    const double wanted = q * double(m_count);
    double before = 0.0;
    for (std::uint32_t bin = 0; bin < m_bins.size(); ++bin) {
        if (m_bins[bin] > 0 && before + m_bins[bin] >= wanted) {
            const double within = std::min((wanted - before) / m_bins[bin], 0.999);
            const std::uint32_t bits = (bin << kDropped) + std::uint32_t(within * (1u << kDropped));
            float value;
            std::memcpy(&value, &bits, sizeof value);
            return value;
        }
        before += m_bins[bin];
    }
    return 0.0f;
}

namespace {

/// Calls body(alpha, triple) for the pixels that are neither transparent nor opaque, if colours are associated with
/// alpha.
template<class Body>
void for_soft_pixels(const OIIO::ImageBuf& picture, const Colour& colour, Index first, std::size_t count, float* rgb,
                     Body&& body)
{
    const std::size_t channels = std::size_t(picture.nchannels());
    if (colour.alpha() < 0 || picture.spec().get_int_attribute("oiio:UnassociatedAlpha") != 0)
        return;
    const float* alpha = static_cast<const float*>(picture.localpixels()) + first * channels + colour.alpha();
    for (std::size_t i = 0; i < count; ++i, alpha += channels)
        if (*alpha >= kLeastAlpha && *alpha < 1.0f)
            body(*alpha, rgb + 3 * i);
}

}  // namespace

void linear_pixels(const OIIO::ImageBuf& picture, const Colour& colour, Index first, std::size_t count, float* rgb)
{
    const std::size_t channels = std::size_t(picture.nchannels());
    const auto [r, g, b] = rgb_channels(colour);
    const float* p = static_cast<const float*>(picture.localpixels()) + first * channels;
    for (std::size_t i = 0; i < count; ++i, p += channels) {
        rgb[3 * i] = p[r];
        rgb[3 * i + 1] = p[g];
        rgb[3 * i + 2] = p[b];
    }
    for_soft_pixels(picture, colour, first, count, rgb, [](float alpha, float* pixel) {
        for (int c = 0; c < 3; ++c)
            pixel[c] /= alpha;
    });
    colour.decode(rgb, count);
}

void associate_pixels(const OIIO::ImageBuf& picture, const Colour& colour, Index first, std::size_t count, float* rgb)
{
    for_soft_pixels(picture, colour, first, count, rgb, [](float alpha, float* pixel) {
        for (int c = 0; c < 3; ++c)
            pixel[c] *= alpha;
    });
}

namespace {

/// Luminance of every pixel. Pixels that have none, being negative, are listed in `holes`.
Raster linear_luminance(const OIIO::ImageBuf& picture, const Colour& colour, const ParallelFor& parallel,
                        std::vector<Index>& holes)
{
    const OIIO::ImageSpec& spec = picture.spec();
    Raster y_raster { spec.width, spec.height, std::vector<float>(spec.image_pixels()) };
    const Index width = Index(spec.width);
    std::vector<std::vector<Index>> found(std::size_t(spec.height));
    for_rows(parallel, 0, spec.height, [&](int y) {
        std::vector<float> rgb(3 * std::size_t(width));
        linear_pixels(picture, colour, Index(y) * width, width, rgb.data());
        for (Index x = 0; x < width; ++x) {
            const float* p = &rgb[3 * x];
            const float luminance = std::min(colour.luminance(p), std::numeric_limits<float>::max());
            y_raster.samples[Index(y) * width + x] = luminance;
            if (luminance <= 0.0f && std::min({ p[0], p[1], p[2] }) < 0.0f)
                found[std::size_t(y)].push_back(Index(y) * width + x);
        }
    });
    for (const auto& row : found)
        holes.insert(holes.end(), row.begin(), row.end());
    return y_raster;
}

/// Adds single pixels that outshine everything around them: their light says nothing about the scene.
void find_hot_pixels(const Raster& y_raster, float least, float floor, std::vector<Index>& holes)
{
    for (Index i = 0; i < Index(y_raster.samples.size()); ++i) {
        if (y_raster.samples[i] < least)
            continue;
        float brightest = floor;
        for_each_neighbour(y_raster.width, y_raster.height, i,
                           [&](Index n) { brightest = std::max(brightest, y_raster.samples[n]); });
        if (y_raster.samples[i] / brightest > kHotRatio)
            holes.push_back(i);
    }
}

}  // namespace

LogLuminance log_luminance(const OIIO::ImageBuf& picture, const Colour& colour, const ParallelFor& parallel)
{
    LogLuminance result;
    std::vector<Index> holes;
    result.guide = linear_luminance(picture, colour, parallel, holes);
    std::vector<float>& samples = result.guide.samples;
    result.filled = find_ringing(picture, colour, result.guide, parallel);
    for (const FilledPixel& filled : result.filled)
        samples[filled.pixel] = colour.luminance(filled.rgb.data());
    holes.erase(std::remove_if(holes.begin(), holes.end(), [&](Index i) { return samples[i] > 0.0f; }), holes.end());
    const MagnitudeHistogram histogram(samples);
    const float middle = histogram.quantile(0.5);
    if (middle == 0.0f) {  // nothing but black
        std::fill(samples.begin(), samples.end(), 0.0f);
        return result;
    }
    int exponent;
    std::frexp(middle, &exponent);
    result.reference = std::ldexp(1.0f, std::max(exponent, -125));
    const float floor = std::max(histogram.quantile(kFloorQuantile) * kFloorBelowQuantile, middle * kFloorBelowMiddle);
    const float ceiling =
        std::min(histogram.quantile(kCeilingQuantile), std::numeric_limits<float>::max() / kCeilingAbove)
        * kCeilingAbove;
    find_hot_pixels(result.guide, std::max(histogram.quantile(kHotQuantile), floor), floor, holes);

    const int width = result.guide.width;
    const auto to_guide = [&](float* values, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i)
            values[i] = std::clamp(values[i], floor, ceiling) / result.reference;
        log2_in_place(values, count);
        for (std::size_t i = 0; i < count; ++i)
            values[i] *= kUnitsPerStop;
    };
    for_rows(parallel, 0, result.guide.height,
             [&](int y) { to_guide(&samples[std::size_t(y) * std::size_t(width)], std::size_t(width)); });
    result.floor = floor;
    to_guide(&result.floor, 1);
    fill_holes(result.guide, holes);
    return result;
}

namespace {

/// Weighted sum of the stored colour samples.
Raster weighted_sum(const OIIO::ImageBuf& picture, const std::array<int, 3>& rgb, const std::array<float, 3>& w,
                    const ParallelFor& parallel)
{
    const OIIO::ImageSpec& spec = picture.spec();
    Raster sum { spec.width, spec.height, std::vector<float>(spec.image_pixels()) };
    for_rows(parallel, 0, spec.height, [&](int y) {
        const float* p = pixel(picture, 0, y);
        float* out = &sum.samples[std::size_t(y) * std::size_t(spec.width)];
        for (int x = 0; x < spec.width; ++x, p += spec.nchannels)
            out[x] = w[0] * p[rgb[0]] + w[1] * p[rgb[1]] + w[2] * p[rgb[2]];
    });
    return sum;
}

/// Power of two that brings most magnitudes to 0..256.
float scale_to_256(const Raster& raster)
{
    std::vector<float> magnitudes(raster.samples);
    for (float& m : magnitudes)
        m = std::fabs(m);
    int exponent;
    std::frexp(std::max(MagnitudeHistogram(magnitudes).quantile(kHotQuantile), 0x1p-100f), &exponent);
    return std::ldexp(1.0f, 8 - exponent);
}

}  // namespace

StoredGuide stored_guide(const OIIO::ImageBuf& picture, const Colour& colour, bool separate, bool whole_numbers,
                         const ParallelFor& parallel)
{
    StoredGuide result;
    const std::array<int, 3> rgb = rgb_channels(colour);
    Raster sum = weighted_sum(picture, rgb, colour.weights(), parallel);
    float limit = std::numeric_limits<float>::max();
    if (!whole_numbers) {  // what is far above the rest must not decide the geometry
        result.scale = scale_to_256(sum);
        limit = 4.0f * 256.0f;
    }
    if (separate)
        for (int i = 0; i < colour.count(); ++i)
            result.channels.push_back(weighted_sum(
                picture, rgb, { i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f }, parallel));
    else
        result.channels.push_back(std::move(sum));
    for (Raster& channel : result.channels)
        for (float& sample : channel.samples) {
            sample *= result.scale;
            result.clipped = result.clipped || std::fabs(sample) > limit;
            sample = std::clamp(sample, -limit, limit);
        }
    return result;
}

}  // namespace PIMG_ABI
}  // namespace pimg
