// SPDX-License-Identifier: BSD-3-Clause
#include "ops/painting/painting.h"

#include <algorithm>
#include <cmath>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>
#include <pimg/detail/safe_file.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr float kUnitsToAStop = 255.0f / 6.0f;
constexpr float kMostStopsOfColour = 3.0f;  ///< most that a channel may differ from the luminance

/// How many units of eye_channels() are one unit of the stored samples.
float stored_scale(const ProgressiveImage::Data& data)
{
    if (data.whole_numbers)
        return 256.0f;
    std::vector<float> magnitudes;
    magnitudes.reserve(data.spec.image_pixels());
    const float* p = static_cast<const float*>(data.source.localpixels());
    for (std::size_t i = 0; i < data.spec.image_pixels(); ++i, p += data.source.nchannels())
        magnitudes.push_back(std::fabs(p[data.colour.channel(0)]));
    const float most = MagnitudeHistogram(magnitudes).quantile(0.999);
    return most > 0.0f ? 256.0f / most : 1.0f;
}

/// Logarithms of the channels, each at most kMostStopsOfColour from the luminance. The luminance is that of the guide,
/// where pixels without a logarithm have been replaced.
OwnedChannels log_channels(const ProgressiveImage::Data& data, const LogLuminance& luminance,
                           const ParallelFor& parallel)
{
    const int width = data.source.spec().width, height = data.source.spec().height;
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    OwnedChannels picture { width, height, Channels(3, std::vector<float>(pixels)) };
    for_rows(parallel, 0, height, [&](int y) {
        const std::size_t first = std::size_t(y) * std::size_t(width);
        std::vector<float> rgb(3 * std::size_t(width));
        linear_pixels(data.source, data.colour, Index(first), std::size_t(width), rgb.data());
        for (std::size_t x = 0; x < std::size_t(width); ++x) {
            const float stops = luminance.guide.samples[first + x] / kUnitsPerStop;
            const float light = data.colour.luminance(&rgb[3 * x]);
            for (std::size_t c = 0; c < 3; ++c) {
                const float ratio = light > 0.0f ? rgb[3 * x + c] / light : 1.0f;
                const float tint = ratio > 0.0f ? float(elementary::log2(double(ratio))) : -kMostStopsOfColour;
                picture.channels[c][first + x] =
                    kUnitsToAStop * (stops + std::clamp(tint, -kMostStopsOfColour, kMostStopsOfColour));
            }
        }
    });
    return picture;
}

void to_mesh_size(const Hierarchy& hierarchy, OwnedChannels& picture)
{
    for (std::vector<float>& channel : picture.channels)
        channel = to_mesh_pixels(hierarchy, channel.data());
    picture.width = hierarchy.mesh_width();
    picture.height = hierarchy.mesh_height();
}

}  // namespace

ChannelsView OwnedChannels::view() const
{
    ChannelsView picture { width, height, {} };
    for (const std::vector<float>& channel : channels)
        picture.channels.push_back(channel.data());
    return picture;
}

OwnedChannels stored_channels(const ProgressiveImage::Data& data)
{
    OwnedChannels picture { data.spec.width, data.spec.height, {} };
    for (int c = 0; c < data.colour.count(); ++c)
        picture.channels.push_back(channel_samples(data, data.colour.channel(c)));
    to_mesh_size(data.hierarchy, picture);
    return picture;
}

bool eye_channels(ProgressiveImage::Data& data, const ParallelFor& parallel, OwnedChannels& picture, std::string& error)
{
    if (data.stats.guide == "log") {
        const LogBands* bands = data.log_bands(parallel, error);
        if (bands == nullptr)
            return false;
        picture = log_channels(data, bands->luminance, parallel);
        to_mesh_size(data.hierarchy, picture);
        return true;
    }
    picture = stored_channels(data);
    const float scale = stored_scale(data);
    for (std::vector<float>& channel : picture.channels)
        for (float& sample : channel)
            sample = std::clamp(sample * scale, -1024.0f, 1024.0f);
    return true;
}

std::vector<float> darkness(const ProgressiveImage::Data& data, const OwnedChannels& eye)
{
    const std::size_t pixels = eye.channels[0].size();
    std::vector<float> tones(pixels, 0.0f);
    const std::array<float, 3>& weights = data.colour.weights();
    for (std::size_t c = 0; c < eye.channels.size(); ++c) {
        const float weight = eye.channels.size() == 3 ? weights[c] : 1.0f / float(eye.channels.size());
        for (std::size_t i = 0; i < pixels; ++i)
            tones[i] += weight * eye.channels[c][i];
    }
    // Stored samples have a black and a white. Logarithms have none, so that the picture's quantiles 1 % and 99 % take
    // their place.
    float black = 0.0f, white = 255.0f;
    if (data.stats.guide == "log") {
        std::vector<float> sorted = tones;
        const auto place = [&](double q) {
            return sorted.begin() + std::ptrdiff_t(q * double(pixels - 1));
        };
        std::nth_element(sorted.begin(), place(0.01), sorted.end());
        black = *place(0.01);
        std::nth_element(sorted.begin(), place(0.99), sorted.end());
        white = *place(0.99);
        // What has less than a stop of contrast is drawn in middle tones: nothing says that it is dark.
        const float missing = std::max(0.0f, kUnitsToAStop - (white - black));
        black -= 0.5f * missing;
        white += 0.5f * missing;
    }
    for (float& tone : tones)
        tone = std::clamp((white - tone) / (white - black), 0.0f, 1.0f);
    return tones;
}

bool parse_colour(const std::string& text, int channels, std::vector<float>& values)
{
    values.clear();
    if (text == "black" || text == "white" || text == "grey" || text == "gray") {
        values.assign(std::size_t(channels), text == "black" ? 0.0f : text == "white" ? 1.0f : 0.5f);
        return true;
    }
    for (const std::string& word : OIIO::Strutil::splits(text, ",")) {
        if (!OIIO::Strutil::string_is_float(word))
            return false;
        values.push_back(OIIO::Strutil::stof(word));
        if (!std::isfinite(values.back()))
            return false;
    }
    if (values.size() == 1)
        values.resize(std::size_t(channels), values[0]);
    return !values.empty() && int(values.size()) >= channels;
}

bool read_picture(const std::string& filename, OIIO::ImageBuf& picture, std::string& error)
{
    picture.reset(filename);
    if (picture.read(0, 0, true, OIIO::TypeDesc::FLOAT) && picture.spec().image_pixels() > 0 && !picture.deep())
        return true;
    const std::string reason = picture.geterror();
    error = "cannot read \"" + filename + "\"" + (reason.empty() ? "" : ": " + reason);
    return false;
}

bool check_strokes_name(const std::string& filename, std::string& error)
{
    const std::string extension = OIIO::Strutil::lower(OIIO::Filesystem::extension(filename));
    if (filename.empty() || extension == ".svg" || extension == ".json")
        return true;
    error = "strokes: \"" + filename + "\": expected FILE.svg or FILE.json";
    return false;
}

bool write_strokes(const std::string& filename, const Strokes& strokes, const ShownColours& colours, float opacity,
                   const std::string& ground, std::string& error)
{
    if (filename.empty())
        return true;
    const bool svg = OIIO::Strutil::iends_with(filename, ".svg");
    const std::string text =
        svg ? strokes_to_svg(strokes, colours, opacity, ground) : strokes_to_json(strokes, colours, opacity);
    std::string why;
    if (write_whole_file(filename, text, why))
        return true;
    error = "strokes: cannot write \"" + filename + "\": " + why;
    return false;
}

}  // namespace PIMG_ABI
}  // namespace pimg
