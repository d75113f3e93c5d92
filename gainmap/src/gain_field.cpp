// SPDX-License-Identifier: BSD-3-Clause
#include "gain_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <pimg/detail/rec709.h>

#include "linear_axis.h"

namespace pimg {

namespace {

/// The weights of luminance in maps of one channel. All primaries of displays are near to those of Rec. 709.
constexpr const std::array<float, 3>& kLuminance = elementary::kRec709Weights;

/// The share of pixels that may be brighter than the headroom says: they are lamps and glints.
constexpr double kHeadroomQuantile = 0.999;

/// A rendition that is nowhere brighter than SDR white needs some headroom all the same, for a weight to be defined.
constexpr double kLeastHeadroom = 0.05;

constexpr double kOffset = GainChannel {}.base_offset;

double positive(float sample)
{
    return sample > 0.0f ? double(sample) : 0.0;  // false for NaN
}

double luminance(const float* rgb)
{
    return kLuminance[0] * positive(rgb[0]) + kLuminance[1] * positive(rgb[1]) + kLuminance[2] * positive(rgb[2]);
}

/// Stops from base to rendition at every pixel, for one channel of a map.
std::vector<double> gains(const Light& base, const Light& rendition, int channel, int channels)
{
    std::vector<double> stops(base.rgb.size() / 3);
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const float* from = &base.rgb[3 * i];
        const float* to = &rendition.rgb[3 * i];
        const double low = channels == 1 ? luminance(from) : positive(from[channel]);
        const double high = channels == 1 ? luminance(to) : positive(to[channel]);
        stops[i] = elementary::log2((high + kOffset) / (low + kOffset));
    }
    return stops;
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

}  // namespace

GainMap make_gain_map(const Light& base, const Light& rendition, const GainMapOptions& options)
{
    const LinearAxis across(base.width, options.scale), down(base.height, options.scale);
    GainMap map;
    map.metadata.alternate_headroom = headroom_of(rendition);
    map.pixels.reset(OIIO::ImageSpec(across.coarse(), down.coarse(), options.channels, OIIO::TypeFloat));
    std::vector<std::vector<double>> stops;
    GainChannel range;
    for (int c = 0; c < options.channels; ++c) {
        stops.push_back(fit(gains(base, rendition, c, options.channels), across, down));
        const auto [least, most] = std::minmax_element(stops.back().begin(), stops.back().end());
        range.min = c == 0 ? *least : std::min(range.min, *least);
        range.max = c == 0 ? *most : std::max(range.max, *most);
    }
    map.metadata.channel.fill(range);
    float* sample = static_cast<float*>(map.pixels.localpixels());
    for (std::size_t i = 0; i < stops[0].size(); ++i)
        for (const std::vector<double>& of_channel : stops)
            *sample++ = range.max > range.min ? float((of_channel[i] - range.min) / (range.max - range.min)) : 0.0f;
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

}  // namespace pimg
