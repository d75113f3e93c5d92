// SPDX-License-Identifier: BSD-3-Clause
#include "render/frame.h"

#include <algorithm>
#include <cmath>

#include <OpenImageIO/strutil.h>

#include <pimg/colour.h>
#include <pimg/display.h>
#include <pimg/threads.h>

namespace pimgview {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;

/// A rectangle in pixels of a rendering.
struct Window {
    int x0, y0, x1, y1;
    int width() const { return x1 - x0; }
};

/// All samples of a window as floats: the rendering's own where they are floats already.
class Samples {
public:
    Samples(const ImageBuf& pixels, const Window& window) : m_channels(std::size_t(pixels.nchannels()))
    {
        const ImageSpec& spec = pixels.spec();
        const void* local = pixels.localpixels();
        if (local != nullptr && spec.format == OIIO::TypeFloat) {
            m_stride = std::size_t(spec.width) * m_channels;
            m_first = static_cast<const float*>(local) + std::size_t(window.y0) * m_stride
                + std::size_t(window.x0) * m_channels;
            return;
        }
        m_stride = std::size_t(window.width()) * m_channels;
        m_copy.resize(m_stride * std::size_t(window.y1 - window.y0));
        const OIIO::ROI roi(spec.x + window.x0, spec.x + window.x1, spec.y + window.y0, spec.y + window.y1, spec.z,
                            spec.z + 1, 0, spec.nchannels);
        if (spec.format == OIIO::TypeUInt32 && local != nullptr)
            copy_numbers(static_cast<const std::uint32_t*>(local), spec, window);
        else
            pixels.get_pixels(roi, OIIO::TypeFloat, m_copy.data());
        m_first = m_copy.data();
    }

    const float* at(int x, int y) const { return m_first + std::size_t(y) * m_stride + std::size_t(x) * m_channels; }

private:
    /// Copies labels as the whole numbers that they are; OpenImageIO would scale them to 0..1.
    void copy_numbers(const std::uint32_t* numbers, const ImageSpec& spec, const Window& window)
    {
        float* to = m_copy.data();
        for (int y = window.y0; y < window.y1; ++y)
            for (std::size_t i = 0; i < m_stride; ++i)
                *to++ = float(
                    numbers[(std::size_t(y) * std::size_t(spec.width) + std::size_t(window.x0)) * m_channels + i]);
    }

    std::size_t m_channels, m_stride = 0;
    const float* m_first = nullptr;
    std::vector<float> m_copy;
};

/// A colour for a number, such that neighbouring numbers differ: the golden angle between their hues.
void label_colour(float label, float* rgb)
{
    constexpr double kGolden = 0.61803398875;
    const double hue = 6.0 * std::fmod(double(label) * kGolden, 1.0);
    for (int c = 0; c < 3; ++c) {
        const double distance = std::fabs(std::fmod(hue + 6.0 - 2.0 * c + 3.0, 6.0) - 3.0);
        rgb[c] = float(0.25 + 0.65 * std::clamp(2.0 - distance, 0.0, 1.0));
    }
}

bool is_srgb(const std::string& name)
{
    return OIIO::Strutil::iequals(name, "sRGB") || name.empty();
}

/// How the colours of a rendering are to be read.
struct Reading {
    pimg::Colour colour;
    bool known = false, grey = true, labels = false, decode = false;
    int channels[3] = { 0, 0, 0 };
    Light light;

    explicit Reading(const Rendering& rendering)
    {
        std::string error;
        const ImageSpec& spec = rendering.pixels->spec();
        labels = rendering.labels;
        known = pimg::Colour::resolve(spec, "", rendering.layer, colour, error);
        grey = !known || colour.count() < 3;
        for (int c = 0; c < 3 && known; ++c)
            channels[c] = colour.channel(grey ? 0 : c);
        light.to_rec709 = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
        light.encoded = labels || (known ? colour.encoded() : !rendering.linear_light);
        if (labels || !known)
            return;
        light.space = colour.config_name();
        if (light.encoded && !is_srgb(colour.config_name())) {
            decode = true;
            light.encoded = false;
            light.space.clear();
        }
        for (int c = 0; c < 3 && !light.encoded; ++c) {
            float rgb[3] = { float(c == 0), float(c == 1), float(c == 2) };
            colour.to_rec709(rgb, 1);
            for (int row = 0; row < 3; ++row)
                light.to_rec709[std::size_t(3 * row + c)] = rgb[row];
        }
    }

    void take(const float* samples, float* rgb) const
    {
        if (labels)
            label_colour(samples[0], rgb);
        else
            for (int c = 0; c < 3; ++c)
                rgb[c] = samples[channels[c]];
    }
};

/// One row of a frame: the means of `reduce` rows of the window.
void fill_row(const Samples& samples, const Reading& reading, const Window& window, int reduce, int y, Frame& frame)
{
    float* out = &frame.rgb[3 * std::size_t(y) * std::size_t(frame.width)];
    const int rows = window.y1 - window.y0;
    for (int x = 0; x < frame.width; ++x, out += 3) {
        if (reduce == 1) {
            reading.take(samples.at(x, y), out);
            continue;
        }
        float sum[3] = { 0, 0, 0 };
        int count = 0;
        for (int v = y * reduce; v < std::min((y + 1) * reduce, rows); ++v)
            for (int u = x * reduce; u < std::min((x + 1) * reduce, window.width()); ++u, ++count) {
                float rgb[3];
                reading.take(samples.at(u, v), rgb);
                for (int c = 0; c < 3; ++c)
                    sum[c] += rgb[c];
            }
        for (int c = 0; c < 3; ++c)
            out[c] = sum[c] / float(count);
    }
    if (reading.decode)
        reading.colour.decode(&frame.rgb[3 * std::size_t(y) * std::size_t(frame.width)], std::size_t(frame.width));
}

}  // namespace

Frame make_frame(const Rendering& rendering, const Region& region, int reduce)
{
    Frame frame;
    const ImageSpec& spec = rendering.pixels->spec();
    frame.step = rendering.factor * reduce;
    const auto down = [&](int v) {
        return std::max(0, v / frame.step * reduce);
    };
    const auto up = [&](int v, int most) {
        return std::min(most, (v + frame.step - 1) / frame.step * reduce);
    };
    const Window window = { down(region.x0), down(region.y0), up(region.x1, spec.width), up(region.y1, spec.height) };
    if (window.x1 <= window.x0 || window.y1 <= window.y0)
        return frame;
    frame.width = (window.width() + reduce - 1) / reduce;
    frame.height = (window.y1 - window.y0 + reduce - 1) / reduce;
    frame.region = { window.x0 * rendering.factor, window.y0 * rendering.factor,
                     window.x0 * rendering.factor + frame.width * frame.step,
                     window.y0 * rendering.factor + frame.height * frame.step };
    frame.rgb.resize(3 * std::size_t(frame.width) * std::size_t(frame.height));
    const Samples samples(*rendering.pixels, window);
    const Reading reading(rendering);
    frame.light = reading.light;
    pimg::pool_loop(0)(std::size_t(frame.height),
                       [&](std::size_t y) { fill_row(samples, reading, window, reduce, int(y), frame); });
    return frame;
}

bool pixel_at(const Rendering& rendering, int x, int y, PixelValue& value)
{
    const ImageSpec& spec = rendering.pixels->spec();
    const int u = x / rendering.factor, v = y / rendering.factor;
    if (x < 0 || y < 0 || u >= spec.width || v >= spec.height)
        return false;
    const Samples samples(*rendering.pixels, { u, v, u + 1, v + 1 });
    value.samples.assign(samples.at(0, 0), samples.at(0, 0) + spec.nchannels);
    const Reading reading(rendering);
    float rgb[3];
    reading.take(value.samples.data(), rgb);
    float shown[3] = { rgb[0], rgb[1], rgb[2] };
    if (reading.known && reading.colour.encoded() && !reading.labels)
        reading.colour.decode(rgb, 1);
    value.luminance = reading.known && !reading.grey ? double(reading.colour.luminance(rgb)) : double(rgb[0]);
    if (rendering.linear_light && !reading.light.encoded) {
        reading.colour.to_rec709(shown, 1);
        pimg::srgb_in_place(shown, 3);
    }
    for (int c = 0; c < 3; ++c)
        value.codes[std::size_t(c)] = int(std::lround(255.0f * std::clamp(shown[c], 0.0f, 1.0f)));
    return true;
}

}  // namespace pimgview
