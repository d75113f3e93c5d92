// SPDX-License-Identifier: BSD-3-Clause
// Pen and ink (paper, section 7).
#include <pimg/imagebufalgo.h>

#include <algorithm>
#include <cmath>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/rec709.h>
#include <pimg/detail/safe_file.h>
#include <pimg/drawing_file.h>
#include <pimg/ink.h>

#include "frame/image_filter.h"
#include "ops/painting/painting.h"
#include "ops/painting/wrapped_marks.h"
#include "source/lab.h"

namespace pimg {
inline namespace PIMG_ABI {
namespace ImageBufAlgo {

namespace {

/// Number of regions from whose colours the inks are chosen. Chosen by eye; more would only take time.
constexpr Index kRegions = 400;

/// Largest ratio of the picture's longer side to the width of the pen: time and memory grow as its square.
constexpr double kMostPens = 4000.0;

/// Least width in pixels of a pen that is given in millimetres. Finer pens would have nothing to draw on small
/// pictures.
constexpr float kFinestPen = 0.5f;

/// A picture with what drawing it needs, over the mesh's pixels.
struct Sitter {
    std::vector<float> lightness;
    OwnedChannels eye;
    std::vector<std::uint8_t> ink_of;
    InkPicture picture;
};

/// L* of a grey value encoded in sRGB.
float lightness_of_grey(float v)
{
    return elementary::lightness(float(elementary::srgb_decoded(double(v))));
}

/// L* of every mesh pixel on white paper. Transparent pixels are as light as the paper.
std::vector<float> lightness(const ProgressiveImage::Data& data, const OwnedChannels& eye, const Channels& lab)
{
    std::vector<float> tones;
    if (data.colour.encoded()) {
        tones = to_mesh_pixels(data.hierarchy, lab[0].data());
    } else {
        tones = darkness(data, eye);
        for (float& tone : tones)
            tone = lightness_of_grey(1.0f - tone);
    }
    const std::vector<float> alpha = alpha_of(data);
    if (!alpha.empty()) {
        const std::vector<float> cover = to_mesh_pixels(data.hierarchy, alpha.data());
        for (std::size_t i = 0; i < tones.size(); ++i)
            tones[i] += 100.0f * (1.0f - std::clamp(cover[i], 0.0f, 1.0f));
    }
    return tones;
}

/// Chooses inks from the colours of the picture's regions.
bool fill_inkwells(ProgressiveImage::Data& data, const InkOptions& options, const Channels& lab,
                   const ParallelFor& parallel, Sitter& sitter, std::string& error)
{
    const Index count = Index(std::min<std::size_t>(kRegions, data.picture.image_pixels()));
    const auto tree = data.region_tree(count, parallel, error);
    if (tree == nullptr)
        return false;
    const std::vector<Index> labels = tree->labels(count);
    std::vector<RegionColour> regions(count, RegionColour { {}, 0.0f });
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<float> samples = without_margins(data.wrap, lab[c]);
        const std::vector<float> means = label_means(labels, count, samples.data());
        for (Index i = 0; i < count; ++i)
            regions[i].lab[c] = means[i];
    }
    for (const Index label : labels)
        regions[label].area += 1.0f;
    const InkChoice choice = choose_inks(regions, options.colours);
    std::vector<float> inks;
    inks.reserve(labels.size());
    for (const Index label : labels)
        inks.push_back(float(choice.ink_of_region[label]));
    inks = with_margins(data.wrap, std::move(inks));
    for (const float ink : to_mesh_pixels(data.hierarchy, inks.data()))
        sitter.ink_of.push_back(std::uint8_t(ink));
    sitter.picture.inks = choice.inks;
    sitter.picture.ink = sitter.ink_of.data();
    return true;
}

bool seat(ProgressiveImage::Data& data, const InkOptions& options, const ParallelFor& parallel, Sitter& sitter,
          std::string& error)
{
    if (!eye_channels(data, parallel, sitter.eye, error))
        return false;
    const bool coloured = options.colours > 1 && data.colour.count() == 3;
    Channels lab;
    if (data.colour.encoded() || coloured)
        lab = lab_channels(data.source, data.colour, parallel);
    sitter.lightness = lightness(data, sitter.eye, lab);
    if (coloured && !fill_inkwells(data, options, lab, parallel, sitter, error))
        return false;
    sitter.picture.width = data.hierarchy.mesh_width();
    sitter.picture.height = data.hierarchy.mesh_height();
    sitter.picture.lightness = sitter.lightness.data();
    sitter.picture.features = sitter.eye.view();
    return true;
}

/// Reads the size of a sheet: a name such as a4, or WxH in millimetres.
bool parse_paper(const std::string& text, Paper& paper, std::string& error)
{
    const std::string name = OIIO::Strutil::lower(text);
    if (name.size() == 2 && name[0] == 'a' && name[1] >= '0' && name[1] <= '6') {
        // ISO 216: each size is half of the one before, rounded down to millimetres.
        int width = 1189, height = 841;
        for (int size = name[1] - '0'; size > 0; --size) {
            const int half = width / 2;
            width = height;
            height = half;
        }
        paper = { double(width), double(height) };
        return true;
    }
    const std::vector<std::string> sides = OIIO::Strutil::splits(name, "x");
    if (sides.size() == 2 && OIIO::Strutil::string_is_float(sides[0]) && OIIO::Strutil::string_is_float(sides[1])) {
        paper = { double(OIIO::Strutil::stof(sides[0])), double(OIIO::Strutil::stof(sides[1])) };
        if (paper.width >= 1.0 && paper.height >= 1.0 && paper.width <= 1e5 && paper.height <= 1e5)
            return true;
    }
    error = "paper=\"" + text + "\": expected a0 to a6, or two sides of 1 to 100000 mm, such as 300x200";
    return false;
}

/// The width of the pen in pixels.
bool find_pen(const InkOptions& options, const ProgressiveImage::Data& data, Paper& paper, float& pen,
              std::string& error)
{
    Drawing sheet;
    sheet.width = data.wrap ? data.wrap.width : data.hierarchy.mesh_width();
    sheet.height = data.wrap ? data.wrap.height : data.hierarchy.mesh_height();
    const double scale = millimetres_per_pixel(sheet, paper);
    pen = options.width > 0.0f ? options.width : std::max(kFinestPen, float(double(options.pen) / scale));
    if (double(pen) * kMostPens >= double(std::max(sheet.width, sheet.height)))
        return true;
    error = format("{}: expected a pen of at least 1/{} of the picture's longer side",
                   options.width > 0.0f ? "width" : "pen", int(kMostPens));
    return false;
}

InkStyle style_of(const std::string& name)
{
    return name == "stipple" ? InkStyle::stipple : name == "contour" ? InkStyle::contour : InkStyle::hatch;
}

bool write_drawing(const InkOptions& options, const Drawing& drawing, const Paper& paper, float pen, std::string& error)
{
    if (options.strokes.empty())
        return true;
    const std::string text = !OIIO::Strutil::iends_with(options.strokes, ".svg") ? drawing_to_json(drawing)
        : options.sort                                                           ? drawing_to_plot(drawing, paper, pen)
                                                                                 : drawing_to_svg(drawing, paper);
    std::string why;
    if (write_whole_file(options.strokes, text, why))
        return true;
    error = "strokes: cannot write \"" + options.strokes + "\": " + why;
    return false;
}

/// The value of every ink in a channel of the result.
std::vector<std::vector<float>> ink_values(const ProgressiveImage::Data& data, const Drawing& drawing)
{
    std::vector<std::vector<float>> values(std::size_t(data.colour.count()));
    for (std::size_t c = 0; c < values.size(); ++c)
        for (const std::array<float, 3>& ink : drawing.inks) {
            const float v = ink[std::min<std::size_t>(c, 2)];
            values[c].push_back(data.colour.encoded() ? v : float(elementary::srgb_decoded(double(v))));
        }
    return values;
}

/// Draws the lines on white paper, mesh-sized, and writes the file that the options ask for.
bool draw(ProgressiveImage::Data& data, const InkOptions& options, const ParallelFor& parallel, Channels& paper,
          std::string& error)
{
    Paper sheet;
    PenOptions settings;
    Sitter sitter;
    if (!check_strokes_name(options.strokes, error) || !parse_paper(options.paper, sheet, error)
        || !find_pen(options, data, sheet, settings.width, error) || !seat(data, options, parallel, sitter, error))
        return false;
    settings.length = options.length;
    settings.density = options.density;
    settings.outline = options.outline;
    settings.cross = options.cross;
    settings.seed = std::uint32_t(options.seed);
    settings.style = style_of(options.style);
    settings.spacing = options.spacing;
    settings.detail = options.detail;
    settings.light = options.light;
    settings.parallel = parallel;
    Drawing drawing;
    draw_ink(sitter.picture, settings, drawing);
    drawing = wrapped_drawing(data.wrap, drawing);
    if (options.sort)
        sort_lines(drawing);
    if (!write_drawing(options, drawing, sheet, settings.width, error))
        return false;
    Canvas canvas { drawing.width, drawing.height, {}, nullptr };
    paper.assign(std::size_t(data.colour.count()),
                 std::vector<float>(std::size_t(drawing.width) * std::size_t(drawing.height), 1.0f));
    for (std::vector<float>& channel : paper)
        canvas.channels.push_back(channel.data());
    render_drawing(drawing, ink_values(data, drawing), canvas, parallel);
    for (std::vector<float>& channel : paper)
        channel = with_margins(data.wrap, std::move(channel));
    return true;
}

}  // namespace

bool on_hierarchy::ink(ImageBuf& dst, const ProgressiveImage& src, const InkOptions& options, ROI roi, int nthreads)
{
    const auto make = [&](ProgressiveImage::Data& data, const ParallelFor& parallel, PictureResult& result,
                          std::string& error) {
        Channels paper;
        if (!draw(data, options, parallel, paper, error))
            return false;
        result = drawn_result(data, std::move(paper));
        return true;
    };
    return filter_picture({ dst, src, roi, nthreads }, options, ResultType::as_source, make);
}

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
