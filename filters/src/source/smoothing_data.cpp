// SPDX-License-Identifier: BSD-3-Clause
#include "source/smoothing_data.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "source/progressive_image_data.h"
#include "source/to_picture.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Defaults of `strength`: of the range of a picture from an integer format, and in stops. Chosen by eye; more smooths
/// more away.
constexpr float kDefaultStrength = 0.03f;
constexpr float kDefaultStops = 0.3f;

/// Contrast that is texture where zones of exposure are told apart. Less, and the leaves of a shaded tree are of several
/// zones; more, and edges of ten times the light have a halo when their dark side is raised by two stops: 0.3, 0.9 and
/// 6.3 % of their height for 0.5, 1 and 2 stops.
constexpr float kTexture = 0.7f * kUnitsPerStop;

/// Unit of the logarithm over the median magnitude: 10 stops below it. Chosen by eye; less keeps the contrast of what is
/// nearly black, and its noise.
constexpr float kUnitBelowMiddle = 0x1p-10f;
constexpr float kLargest = 0x1p100f;  ///< sums and squares of larger samples are scaled down
constexpr float kSteep = 0x1p12f;     ///< ratio to the unit above which a^2 + 1 is a^2 in a float

SignedLog find_scale(const Channels& samples)
{
    std::vector<float> magnitudes;
    for (const std::vector<float>& channel : samples)
        magnitudes.insert(magnitudes.end(), channel.begin(), channel.end());
    for (float& m : magnitudes)
        m = std::fabs(m);
    const float middle = MagnitudeHistogram(magnitudes).quantile(0.5);
    return SignedLog(std::max(middle, 0x1p-100f) * kUnitBelowMiddle);
}

int find_exponent(const Channels& samples)
{
    for (const std::vector<float>& channel : samples)
        if (std::any_of(channel.begin(), channel.end(), [](float v) { return std::fabs(v) > kLargest; }))
            return 30;
    return 0;
}

}  // namespace

// asinh(x / 2u) / ln 2 = log2(a + sqrt(a^2 + 1)) for a = x / 2u > 0.
void SignedLog::to_log(float* values, std::size_t count) const
{
    std::vector<float> magnitudes(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float a = std::min(0.5f * std::fabs(values[i]) / m_unit, 0x1p126f);
        magnitudes[i] = a > kSteep ? 2.0f * a : a + std::sqrt(a * a + 1.0f);
    }
    log2_in_place(magnitudes.data(), count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = std::copysign(magnitudes[i], values[i]);
}

void SignedLog::from_log(float* values, std::size_t count) const
{
    std::vector<float> powers(values, values + count);
    for (float& p : powers)
        p = std::fabs(p);
    exp2_in_place(powers.data(), count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = std::copysign(m_unit * (powers[i] - 1.0f / powers[i]), values[i]);
}

Channels source_channels(const ProgressiveImage::Data& data)
{
    Channels samples;
    for (int c = 0; c < data.colour.count(); ++c)
        samples.push_back(channel_samples(data, data.colour.channel(c)));
    return samples;
}

SmoothingData prepare_smoothing(const ProgressiveImage::Data& data, bool log)
{
    SmoothingData result;
    Channels samples = source_channels(data);
    result.log = log;
    if (log)
        result.scale = find_scale(samples);
    else
        result.exponent = find_exponent(samples);
    for (std::vector<float>& channel : samples) {
        if (log)
            result.scale.to_log(channel.data(), channel.size());
        else if (result.exponent != 0)
            for (float& sample : channel)
                sample = std::ldexp(sample, -result.exponent);
    }
    result.noise = noise_level(samples, data.spec.width, data.spec.height);
    for (std::vector<float>& channel : samples)
        channel = to_mesh_pixels(data.hierarchy, channel.data());
    result.source = analyse_for_smoothing(data.hierarchy, std::move(samples));
    return result;
}

std::vector<float> without_texture(const Hierarchy& hierarchy, const LogLuminance& luminance,
                                   const ParallelFor& parallel)
{
    const SmoothingSource source =
        analyse_for_smoothing(hierarchy, { to_mesh_pixels(hierarchy, luminance.guide.samples.data()) });
    SmoothingOptions options;
    options.strength = kTexture;
    options.parallel = parallel;
    Channels result;
    smooth(hierarchy, source, options, result);
    crop_to_picture(hierarchy, result[0]);
    return std::move(result[0]);
}

float find_strength(const StrengthOptions& options, const SmoothingData& smoothing)
{
    if (options.noise >= 0.0f)
        return options.noise * smoothing.noise;
    if (options.strength >= 0.0f)
        return std::ldexp(options.strength, -smoothing.exponent);
    return smoothing.log ? kDefaultStops : std::ldexp(kDefaultStrength, -smoothing.exponent);
}

void to_picture(const Hierarchy& hierarchy, const SmoothingData& smoothing, Channels& results)
{
    for (std::vector<float>& samples : results) {
        crop_to_picture(hierarchy, samples);
        if (smoothing.log)
            smoothing.scale.from_log(samples.data(), samples.size());
        else
            scale_by_power(smoothing.exponent, samples);
    }
}

}  // namespace PIMG_ABI
}  // namespace pimg
