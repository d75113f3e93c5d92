// SPDX-License-Identifier: BSD-3-Clause
#include "ops/scene_light.h"

#include <algorithm>
#include <vector>

#include <pimg/display.h>

#include "colour/layers.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

void stops_of(const LightGain& gain, Index first, std::size_t count, float* stops)
{
    for (std::size_t i = 0; i < count; ++i)
        stops[i] =
            gain.slope * gain.compressed[first + Index(i)] - gain.guide[first + Index(i)] / kUnitsPerStop + gain.offset;
}

/// Multiplies rows of light.
class Lighter {
public:
    Lighter(const ProgressiveImage::Data& data, const LightGain& gain, bool all_light) : m_data(data), m_gain(gain)
    {
        for (int i = 0; i < data.colour.count(); ++i)
            m_channels.push_back(data.colour.channel(i));
        for (int c = 0; all_light && c < data.spec.nchannels; ++c)
            if (!data.colour.is_colour(c) && holds_light(data.spec, c))
                m_channels.push_back(c);
    }

    void render(Index first, std::size_t count, float* row) const
    {
        std::vector<float> factors(count);
        stops_of(m_gain, first, count, factors.data());
        exp2_in_place(factors.data(), count);
        if (m_data.colour.encoded())
            decode(first, count, row);
        const auto channels = std::size_t(m_data.spec.nchannels);
        for (const int c : m_channels)
            for (std::size_t i = 0; i < count; ++i)
                row[i * channels + std::size_t(c)] *= factors[i];
        for_specials(m_data, first, count, [&](const SpecialSample& s) {
            row[std::size_t(s.pixel - first) * channels + std::size_t(s.channel)] = s.value;
        });
    }

private:
    void decode(Index first, std::size_t count, float* row) const
    {
        std::vector<float> rgb(3 * count);
        linear_pixels(m_data.source, m_data.colour, first, count, rgb.data());
        associate_pixels(m_data.source, m_data.colour, first, count, rgb.data());
        for (int c = 0; c < m_data.colour.count(); ++c)
            for (std::size_t i = 0; i < count; ++i)
                row[i * std::size_t(m_data.spec.nchannels) + std::size_t(m_data.colour.channel(c))] =
                    rgb[3 * i + std::size_t(c)];
    }

    const ProgressiveImage::Data& m_data;
    LightGain m_gain;
    std::vector<int> m_channels;
};

Index first_of(const ProgressiveImage::Data& data, const RowSpan& span)
{
    const OIIO::ImageSpec& spec = data.source.spec();
    return Index(span.y - spec.y) * Index(spec.width) + Index(span.xbegin - spec.x);
}

}  // namespace

void write_gain(OIIO::ImageBuf& dst, const ProgressiveImage::Data& data, const OIIO::ROI& roi,
                const ParallelFor& parallel, const LightGain& gain)
{
    write_rows(dst, data, roi, parallel, [&](const RowSpan& span, float* row) {
        std::vector<float> stops(span.width());
        stops_of(gain, first_of(data, span), stops.size(), stops.data());
        for (std::size_t i = 0; i < stops.size(); ++i)
            row[i * std::size_t(data.source.nchannels())] = stops[i];
    });
    declare_space(dst.specmod(), "");
}

void write_scene_light(OIIO::ImageBuf& dst, const ProgressiveImage::Data& data, const OIIO::ROI& roi,
                       const ParallelFor& parallel, const LightGain& gain, bool all_light)
{
    const Lighter lighter(data, gain, all_light);
    write_rows(dst, data, roi, parallel,
               [&](const RowSpan& span, float* row) { lighter.render(first_of(data, span), span.width(), row); });
}

}  // namespace PIMG_ABI
}  // namespace pimg
