// SPDX-License-Identifier: BSD-3-Clause
#include "gain_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <pimg/detail/rec709.h>

#include "linear_axis.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// The weights of luminance in maps of one channel. All primaries of displays are near to those of Rec. 709.
constexpr const std::array<float, 3>& kLuminance = elementary::kRec709Weights;

/// The share of pixels that may be brighter than the headroom says: they are lamps and glints.
constexpr double kHeadroomQuantile = 0.999;

/// A rendition that is nowhere brighter than SDR white needs some headroom all the same, for a weight to be defined.
constexpr double kLeastHeadroom = 0.05;

/// What scale=0 tries first, and the miss() with which it goes on to 1. JPEG adds about 0.02 stops; 0.1 is the goal.
constexpr int kUsualScale = 2;
constexpr double kMostMissed = 0.08;

/// The share of the least gains that a map does not reach.
constexpr double kGivenUp = 0.001;

constexpr double kOffset = GainChannel {}.base_offset;

double positive(float sample)
{
    return sample > 0.0f ? double(sample) : 0.0;  // false for NaN
}

double luminance(const float* rgb)
{
    return kLuminance[0] * positive(rgb[0]) + kLuminance[1] * positive(rgb[1]) + kLuminance[2] * positive(rgb[2]);
}

using Stops = std::vector<std::vector<double>>;  ///< one field for each channel of a map

/// Stops from base to rendition at every pixel.
Stops gains(const Light& base, const Light& rendition, int channels)
{
    const std::size_t pixels = base.rgb.size() / 3;
    Stops stops;
    stops.resize(std::size_t(channels), std::vector<double>(pixels));
    for (int c = 0; c < channels; ++c)
        for (std::size_t i = 0; i < pixels; ++i) {
            const float* from = &base.rgb[3 * i];
            const float* to = &rendition.rgb[3 * i];
            const double low = channels == 1 ? luminance(from) : positive(from[c]);
            const double high = channels == 1 ? luminance(to) : positive(to[c]);
            stops[std::size_t(c)][i] = elementary::log2((high + kOffset) / (low + kOffset));
        }
    return stops;
}

/// Luminance and offset of a pixel of the base to which gains are applied.
double lit(const float* base, const Stops& stops, std::size_t pixel)
{
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
        sum += double(kLuminance[c]) * (positive(base[c]) + kOffset)
            * elementary::exp2(stops[stops.size() == 1 ? 0 : c][pixel]);
    return sum;
}

/// Stops that the brightest pixels are above SDR white.
double headroom_of(const Light& rendition)
{
    std::vector<float> most(rendition.rgb.size() / 3);
    for (std::size_t i = 0; i < most.size(); ++i)
        most[i] = float(std::max({ positive(rendition.rgb[3 * i]), positive(rendition.rgb[3 * i + 1]),
                                   positive(rendition.rgb[3 * i + 2]) }));
    const auto place = most.begin() + std::ptrdiff_t(kHeadroomQuantile * double(most.size() - 1));
    std::nth_element(most.begin(), place, most.end());
    return *place > 1.0f ? std::max(elementary::log2(double(*place)), kLeastHeadroom) : kLeastHeadroom;
}

/// Values of a coarse grid that, interpolated, come closest to `fine`.
std::vector<double> fit(const std::vector<double>& fine, const LinearAxis& across, const LinearAxis& down)
{
    const std::size_t width = std::size_t(across.fine()), height = std::size_t(down.fine());
    const std::size_t columns = std::size_t(across.coarse()), rows = std::size_t(down.coarse());
    std::vector<double> narrow(columns * height), result(columns * rows);
    for (std::size_t y = 0; y < height; ++y)
        across.fit(&fine[y * width], 1, &narrow[y * columns], 1);
    for (std::size_t x = 0; x < columns; ++x)
        down.fit(&narrow[x], columns, &result[x], columns);
    return result;
}

Stops fit(const Stops& fine, const LinearAxis& across, const LinearAxis& down)
{
    Stops result;
    for (const std::vector<double>& channel : fine)
        result.push_back(fit(channel, across, down));
    return result;
}

/// A coarse grid interpolated to the size of the picture, as decoders do it.
std::vector<double> enlarge(const std::vector<double>& grid, const LinearAxis& across, const LinearAxis& down)
{
    std::vector<double> fine;
    fine.reserve(std::size_t(across.fine()) * std::size_t(down.fine()));
    for (int y = 0; y < down.fine(); ++y) {
        const LinearAxis::Place v = down.place(y);
        const double* upper = &grid[std::size_t(v.first) * std::size_t(across.coarse())];
        const double* lower = &grid[std::size_t(v.second) * std::size_t(across.coarse())];
        for (int x = 0; x < across.fine(); ++x) {
            const LinearAxis::Place u = across.place(x);
            const double above = (1.0 - u.share) * upper[u.first] + u.share * upper[u.second];
            const double below = (1.0 - u.share) * lower[u.first] + u.share * lower[u.second];
            fine.push_back((1.0 - v.share) * above + v.share * below);
        }
    }
    return fine;
}

/// The means of squares of two by two pixels: what an encoder of JPEG keeps of colour.
std::vector<double> halve(const std::vector<double>& fine, int width, int height)
{
    std::vector<double> result;
    for (int y = 0; y < height; y += 2)
        for (int x = 0; x < width; x += 2) {
            const int right = std::min(x + 1, width - 1), below = std::min(y + 1, height - 1);
            const auto at = [&](int i, int j) {
                return fine[std::size_t(j) * std::size_t(width) + std::size_t(i)];
            };
            result.push_back(0.25 * (at(x, y) + at(right, y) + at(x, below) + at(right, below)));
        }
    return result;
}

/// Gains whose colour has half the resolution, as the map's JPEG stream will have it. What that does to the luminance of
/// the rendition is put right in the part that all channels share, which keeps its resolution.
void soften_colour(const Light& base, const Light& rendition, Stops& stops)
{
    const LinearAxis across(base.width, 2), down(base.height, 2);
    const Stops common = gains(base, rendition, 1);
    for (std::vector<double>& channel : stops) {
        for (std::size_t i = 0; i < channel.size(); ++i)
            channel[i] -= common[0][i];
        channel = enlarge(halve(channel, base.width, base.height), across, down);
    }
    for (std::size_t i = 0; i < common[0].size(); ++i) {
        const double wanted = luminance(&rendition.rgb[3 * i]) + kOffset;
        const double shared = elementary::log2(wanted / lit(&base.rgb[3 * i], stops, i));
        for (std::vector<double>& channel : stops)
            channel[i] += shared;
    }
}

/// How far the rendition that a map makes is from the intended one: the 95th percentile of the luminances' difference in
/// stops. Luminances below the offset are black to the eye, and count as the offset.
double miss(const Light& base, const Light& rendition, Stops stops, const LinearAxis& across, const LinearAxis& down)
{
    for (std::vector<double>& channel : stops)
        channel = enlarge(channel, across, down);
    std::vector<float> apart(base.rgb.size() / 3);
    for (std::size_t i = 0; i < apart.size(); ++i) {
        const double made = std::max(lit(&base.rgb[3 * i], stops, i) - kOffset, kOffset);
        apart[i] = float(std::fabs(elementary::log2(made / std::max(luminance(&rendition.rgb[3 * i]), kOffset))));
    }
    const auto place = apart.begin() + std::ptrdiff_t(0.95 * double(apart.size() - 1));
    std::nth_element(apart.begin(), place, apart.end());
    return *place;
}

/// The range of all channels. The least of the gains are given up: they stand where the base's compression brightened a
/// dark colour, and would cost all others half of their steps.
GainChannel range_of(const Stops& stops)
{
    std::vector<double> all;
    for (const std::vector<double>& channel : stops)
        all.insert(all.end(), channel.begin(), channel.end());
    GainChannel range;
    range.max = *std::max_element(all.begin(), all.end());
    const auto place = all.begin() + std::ptrdiff_t(kGivenUp * double(all.size() - 1));
    std::nth_element(all.begin(), place, all.end());
    range.min = *place;
    return range;
}

GainMap map_of(const Stops& stops, int width, int height)
{
    GainMap map;
    const GainChannel range = range_of(stops);
    map.metadata.channel.fill(range);
    map.pixels.reset(OIIO::ImageSpec(width, height, int(stops.size()), OIIO::TypeFloat));
    float* sample = static_cast<float*>(map.pixels.localpixels());
    for (std::size_t i = 0; i < stops[0].size(); ++i)
        for (const std::vector<double>& channel : stops)
            *sample++ =
                range.max > range.min ? float(std::max(channel[i] - range.min, 0.0) / (range.max - range.min)) : 0.0f;
    return map;
}

}  // namespace

GainMap make_gain_map(const Light& base, const Light& rendition, const GainMapOptions& options)
{
    int scale = options.scale == 0 ? kUsualScale : options.scale;
    Stops fine = gains(base, rendition, options.channels);
    Stops fitted;
    if (scale > 1) {
        const LinearAxis across(base.width, scale), down(base.height, scale);
        fitted = fit(fine, across, down);
        if (options.scale == 0 && miss(base, rendition, fitted, across, down) > kMostMissed)
            scale = 1;
    }
    if (scale == 1) {
        fitted = std::move(fine);
        if (options.channels == 3)
            soften_colour(base, rendition, fitted);
    }
    GainMap map = map_of(fitted, (base.width + scale - 1) / scale, (base.height + scale - 1) / scale);
    map.half_colour = scale == 1;
    map.metadata.alternate_headroom = headroom_of(rendition);
    return map;
}

void apply_gain_map(const OIIO::ImageBuf& map, const GainMetadata& metadata, double headroom, Light& light)
{
    const double room = metadata.alternate_headroom - metadata.base_headroom;
    const double weight = headroom < 0.0 ? 1.0 : std::clamp((headroom - metadata.base_headroom) / room, 0.0, 1.0);
    const LinearAxis across = LinearAxis::between(light.width, map.spec().width);
    const LinearAxis down = LinearAxis::between(light.height, map.spec().height);
    const int channels = map.nchannels() >= 3 ? 3 : 1;
    const std::size_t step = std::size_t(map.nchannels()), row = step * std::size_t(map.spec().width);
    const float* samples = static_cast<const float*>(map.localpixels());
    for (int y = 0; y < light.height; ++y) {
        const LinearAxis::Place v = down.place(y);
        for (int x = 0; x < light.width; ++x) {
            const LinearAxis::Place u = across.place(x);
            float* pixel = &light.rgb[3 * (std::size_t(y) * std::size_t(light.width) + std::size_t(x))];
            double gain = 0.0;
            for (int c = 0; c < 3; ++c) {
                const GainChannel& channel = metadata.channel[std::size_t(c)];
                const float* at = samples + std::size_t(channels == 1 ? 0 : c);
                const auto sample = [&](int i, int j) {
                    return at[std::size_t(j) * row + std::size_t(i) * step];
                };
                const double upper = (1.0 - u.share) * sample(u.first, v.first) + u.share * sample(u.second, v.first);
                const double lower = (1.0 - u.share) * sample(u.first, v.second) + u.share * sample(u.second, v.second);
                const double value = (1.0 - v.share) * upper + v.share * lower;
                const double linear = channel.gamma == 1.0 ? value : elementary::power(value, 1.0 / channel.gamma);
                gain = elementary::exp2(weight * (channel.min + (channel.max - channel.min) * linear));
                pixel[c] = float((double(pixel[c]) + channel.base_offset) * gain - channel.alternate_offset);
            }
        }
    }
}

}  // namespace PIMG_ABI
}  // namespace pimg
