// SPDX-License-Identifier: BSD-3-Clause
// Painterly rendering (paper, section 5.2).
#include <pimg/imagebufalgo.h>

#include <algorithm>
#include <cmath>

#include <OpenImageIO/imagebufalgo.h>

#include <pimg/detail/format.h>
#include <pimg/detail/oiio_compat.h>
#include <pimg/display.h>
#include <pimg/paint.h>

#include "frame/image_filter.h"
#include "ops/painting/painting.h"
#include "ops/painting/wrapped_marks.h"

namespace pimg {
inline namespace PIMG_ABI {
namespace ImageBufAlgo {

namespace {

/// What the options name, read from files, and the canvas.
struct Studio {
    Brush brush;
    OwnedChannels canvas;         ///< mesh-sized
    bool on_the_picture = false;  ///< the canvas is the source itself
    std::vector<float> detail;    ///< mesh-sized, or empty
    std::vector<float> alpha;     ///< of the picture, mesh-sized; empty if it is opaque
    std::vector<float> cover;     ///< alpha of the canvas; empty if the picture is opaque
};

/// Reads a picture of any size and resizes it to the mesh's pixels.
bool fitted(const std::string& filename, const ProgressiveImage::Data& data, int channels, OwnedChannels& picture,
            std::string& error)
{
    ImageBuf file, resized;
    if (!read_picture(filename, file, error))
        return false;
    OIIO::ImageSpec spec(data.picture.width, data.picture.height, file.nchannels(), OIIO::TypeDesc::FLOAT);
    resized.reset(spec);
    file.set_origin(0, 0);
    file.set_full(0, file.spec().width, 0, file.spec().height, 0, 1);
    if (!resize_picture(resized, file, "", resized.roi(), 1)) {
        error = "\"" + filename + "\": " + resized.geterror();
        return false;
    }
    picture.width = data.hierarchy.mesh_width();
    picture.height = data.hierarchy.mesh_height();
    for (int c = 0; c < channels; ++c) {
        std::vector<float> samples(spec.image_pixels());
        const int from = std::min(c, file.nchannels() - 1);
        resized.get_pixels(OIIO::ROI(0, spec.width, 0, spec.height, 0, 1, from, from + 1), OIIO::TypeDesc::FLOAT,
                           samples.data());
        for (float& sample : samples)
            sample = std::isfinite(sample) ? sample : 0.0f;
        samples = with_margins(data.wrap, std::move(samples));
        picture.channels.push_back(to_mesh_pixels(data.hierarchy, samples.data()));
    }
    return true;
}

bool load_brush(const std::string& name, Brush& brush, std::string& error)
{
    brush = Brush::named(name);
    if (!brush.empty())
        return true;
    ImageBuf file;
    if (!read_picture(name, file, error)) {
        error = "brush: expected " + std::string(Brush::names()) + " or a picture; " + error;
        return false;
    }
    const OIIO::ImageSpec& spec = file.spec();
    std::vector<float> alpha(spec.image_pixels()), height(alpha.size());
    const int channel = spec.alpha_channel;
    const auto read = [&](int c, std::vector<float>& samples) {
        OIIO::ROI roi = file.roi();
        roi.chbegin = c;
        roi.chend = c + 1;
        file.get_pixels(roi, OIIO::TypeDesc::FLOAT, samples.data());
    };
    // Alpha says where the paint is, and grey how thick it is; without alpha, grey says both.
    read(channel == 0 && spec.nchannels > 1 ? 1 : 0, height);
    if (channel >= 0)
        read(channel, alpha);
    brush = Brush::from_picture(spec.width, spec.height, channel >= 0 ? alpha.data() : nullptr, height.data());
    return true;
}

bool is_source(const std::string& canvas)
{
    return canvas.empty() || canvas == "source";
}

bool load_canvas(const PaintOptions& options, const ProgressiveImage::Data& data, Studio& studio, std::string& error)
{
    studio.on_the_picture = is_source(options.canvas);
    std::vector<float> colour;
    if (studio.on_the_picture) {
        studio.canvas = stored_channels(data);
    } else if (parse_colour(options.canvas, data.colour.count(), colour)) {
        studio.canvas = { data.hierarchy.mesh_width(), data.hierarchy.mesh_height(), {} };
        for (int c = 0; c < data.colour.count(); ++c)
            studio.canvas.channels.emplace_back(data.hierarchy.mesh_pixels(), colour[std::size_t(c)]);
    } else if (!fitted(options.canvas, data, data.colour.count(), studio.canvas, error)) {
        error = "canvas: expected source, a colour, such as white or 0.9,0.8,0.7, or a picture; " + error;
        return false;
    }
    return true;
}

bool load(const PaintOptions& options, const ProgressiveImage::Data& data, Studio& studio, std::string& error)
{
    if (!check_strokes_name(options.strokes, error) || !load_brush(options.brush, studio.brush, error)
        || !load_canvas(options, data, studio, error))
        return false;
    const std::vector<float> alpha = alpha_of(data);
    if (std::any_of(alpha.begin(), alpha.end(), [](float a) { return a < 1.0f; })) {
        studio.alpha = to_mesh_pixels(data.hierarchy, alpha.data());
        studio.cover = studio.on_the_picture ? studio.alpha : std::vector<float>(studio.alpha.size(), 1.0f);
    }
    OwnedChannels detail;
    if (!options.detail.empty()) {
        if (!fitted(options.detail, data, 1, detail, error)) {
            error = "detail: " + error;
            return false;
        }
        studio.detail = std::move(detail.channels[0]);
    }
    return true;
}

/// The options with what the style gives, and with sizes in pixels.
bool resolve(const PaintOptions& given, const OIIO::ImageSpec& picture, PaintOptions& options, std::string& error)
{
    options = with_style(given);
    const float diagonal = std::hypot(float(picture.width), float(picture.height));
    const auto pixels = [&](float size) {
        return std::max(1.0f, size < 1.0f ? size * diagonal : size);
    };
    const bool comparable = (options.min < 1.0f) == (options.max < 1.0f);
    if (comparable && options.max < options.min) {
        error = format("max: {} is below min, {}", options.max, options.min);
        return false;
    }
    // If one is in pixels and the other a share, it depends on the picture which is larger. The one given counts.
    const bool min_counts = given.min >= 0.0f;
    options.min = pixels(options.min);
    options.max = pixels(options.max);
    (min_counts ? options.max : options.min) =
        min_counts ? std::max(options.max, options.min) : std::min(options.max, options.min);
    return true;
}

StrokeOptions stroke_options(const PaintOptions& options, const Studio& studio, const ParallelFor& parallel)
{
    StrokeOptions strokes;
    strokes.min = options.min;
    strokes.max = options.max;
    strokes.detail = studio.detail.empty() ? nullptr : studio.detail.data();
    strokes.length = options.length;
    strokes.tolerance = options.tolerance;
    strokes.cover = options.cover;
    strokes.jitter_angle = options.jitter_angle;
    strokes.jitter_size = options.jitter_size;
    strokes.seed = std::uint32_t(options.seed);
    strokes.parallel = parallel;
    return strokes;
}

/// Converts colours for a file, which has them encoded for a display.
ShownColours shown(ShownColours colours, const ProgressiveImage::Data& data)
{
    colours.resize(std::size_t(data.colour.count()));  // without alpha
    if (!data.colour.encoded())
        for (std::vector<float>& channel : colours) {
            for (float& value : channel)
                value = value > 0.0f ? std::min(value, 1.0f) : 0.0f;
            srgb_in_place(channel.data(), channel.size());
        }
    return colours;
}

/// Gives the paint the picture's alpha. Strokes reach beyond soft edges, or bring transparent paint into opaque parts.
/// So alpha is divided out of the paint, and its colour multiplied by the alpha of the pixel. Where there is next to no
/// paint, the picture stays.
void apply_alpha(const ProgressiveImage::Data& data, const OwnedChannels& picture, Studio& studio)
{
    constexpr float kLeastCover = 1e-3f;  // less paint than that is not seen, and dividing by it would amplify errors
    for (std::size_t c = 0; c < picture.channels.size(); ++c)
        for (std::size_t i = 0; i < studio.alpha.size(); ++i) {
            float& sample = studio.canvas.channels[c][i];
            const float alpha = studio.alpha[i], cover = studio.cover[i];
            if (alpha <= 0.0f)
                sample = 0.0f;
            else if (cover < kLeastCover)
                sample = picture.channels[c][i];
            else if (cover != alpha)
                sample *= alpha / cover;
            if (data.whole_numbers)  // the grain of the paint must not leave the range of associated colours
                sample = std::min(sample, std::max(alpha, picture.channels[c][i]));
        }
}

/// Gradients, in 8-bit steps per pixel, that give strokes no direction. With half of it, strokes in flat places turn with the
/// noise, and a painting changes by a tenth more with it (docs/internals.md).
constexpr float kNoise = 8.0f;

/// Paints on studio.canvas.
bool paint_canvas(ProgressiveImage::Data& data, const PaintOptions& options, const ParallelFor& parallel,
                  Studio& studio, std::string& error)
{
    OwnedChannels eye;
    if (!eye_channels(data, parallel, eye, error))
        return false;
    const ChannelsView guides = eye.view();
    const DirectionField field(guides, parallel, kNoise);
    const StrokeOptions planning = stroke_options(options, studio, parallel);
    Strokes strokes;
    const Status status = plan_strokes(data.hierarchy, guides, field, planning, strokes);
    error = status.error();
    if (!status)
        return false;
    const OwnedChannels picture = stored_channels(data);
    ChannelsView ground = picture.view();
    if (!studio.alpha.empty())
        ground.channels.push_back(studio.alpha.data());
    ShownColours colours = stroke_colours(strokes, ground, guides, parallel);
    wrap_strokes(data.wrap, options.max, strokes, colours);
    if (!write_strokes(options.strokes, without_margins(data.wrap, strokes), shown(colours, data), options.opacity, "",
                       error))
        return false;

    std::vector<float> relief(options.impasto > 0.0f ? data.hierarchy.mesh_pixels() : 0, 0.0f);
    Canvas canvas { studio.canvas.width, studio.canvas.height, {} };
    canvas.relief = relief.empty() ? nullptr : relief.data();
    canvas.alpha = studio.cover.empty() ? nullptr : studio.cover.data();
    for (std::vector<float>& channel : studio.canvas.channels)
        canvas.channels.push_back(channel.data());
    StrokePaintOptions settings;
    settings.opacity = options.opacity;
    settings.jitter_colour = options.jitter_colour;
    settings.edges = &guides;
    settings.crossing = planning.crossing;
    settings.white = data.colour.encoded() ? 1.0f : 0.0f;
    settings.ground = studio.on_the_picture || options.cover < 1.0f ? nullptr : &ground;
    settings.parallel = parallel;
    paint_strokes(strokes, colours, studio.brush, settings, canvas);
    light_relief(canvas, options.impasto, parallel, settings.white);
    if (options.opacity > 0.0f || !studio.on_the_picture)
        apply_alpha(data, picture, studio);
    for (std::vector<float>& channel : studio.canvas.channels) {
        crop_to_picture(data.hierarchy, channel);
        if (data.spec.format == OIIO::TypeDesc::HALF)  // the grain of the paint must not make infinity of the largest
            for (float& value : channel)
                value = std::clamp(value, -65504.0f, 65504.0f);
    }
    return true;
}

}  // namespace

bool on_hierarchy::paint(ImageBuf& dst, const ProgressiveImage& src, const PaintOptions& given, ROI roi, int nthreads)
{
    const auto make = [&](ProgressiveImage::Data& data, const ParallelFor& parallel, PictureResult& result,
                          std::string& error) {
        Studio studio;
        PaintOptions options;
        if (!resolve(given, data.picture, options, error) || !load(options, data, studio, error)
            || !paint_canvas(data, options, parallel, studio, error))
            return false;
        const bool untouched = options.opacity == 0.0f && studio.on_the_picture;
        result = { std::move(studio.canvas.channels), untouched ? Specials::restored : Specials::replaced, Seams::cut };
        return true;
    };
    return filter_picture({ dst, src, roi, nthreads }, given, ResultType::as_source, make);
}

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
