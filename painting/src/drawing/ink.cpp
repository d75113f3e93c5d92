// SPDX-License-Identifier: BSD-3-Clause
// Plans a drawing on a grid of its own, two cells to a pen, so that it does not depend on the picture's resolution:
//
//     channels -> study -> outlines -------------------------+--> widths that match the tone --> drawing
//     lightness less what outlines cover -> hatching or dots -+
#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>
#include <pimg/ink.h>

#include <algorithm>
#include <cmath>

#include "drawing/at_once.h"
#include "drawing/hatching.h"
#include "drawing/outlines.h"
#include "drawing/raster_ops.h"
#include "drawing/stipple.h"
#include "drawing/study.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// Chosen by eye unless said otherwise; after each number stands what more of it does.
constexpr float kCellsPerPen = 2.0f;  ///< more: finer outlines, and more time
constexpr float kMostCells = 6.7e7f;  ///< of the grid: 8192 squared; beyond, cells are larger
constexpr float kDarkest = 0.05f;     ///< L* / 100 of the darkest tone that is wanted; less: clogged shadows
constexpr float kLightest = 0.04f;    ///< cover that is left white; more: larger white areas
constexpr float kOneWay = 0.45f;      ///< cover up to which one direction does; more: crossing starts later
constexpr float kBelowCross = 0.35f;  ///< share of the cover beyond it that the first direction takes
constexpr float kMostOfOne = 0.7f, kMostAlone = 0.92f;  ///< most of one direction, with and without a second
constexpr float kMostAcross = 0.85f;                    ///< most of the second; more: darker shadows
constexpr float kLeastAcross = 0.06f;
constexpr float kCrossing = 68.0f;      ///< degrees between the two directions
constexpr float kUnderOutlines = 0.8f;  ///< share of what outlines cover that hatching spares
constexpr float kFinest =
    0.5f;  ///< blur in cells of what outlines are found in; more: pictures of fewer pixels give the same
constexpr float kTone = 1.0f;       ///< blur in pens of the tones that distances follow; widths follow the rest
constexpr float kStop = 0.4f;       ///< cover by outlines at which hatching ends
constexpr float kHalo = 0.6f;       ///< how far in pens an outline keeps dark hatching away; more: clearer outlines
constexpr float kHaloStop = 0.12f;  ///< cover, blurred by as much, at which dark hatching ends
constexpr float kHaloFrom = 0.15f, kHaloFull = 0.4f;  ///< cover by hatching from which it does so, and fully
constexpr float kHighlight = 0.3f;                    ///< cover by highlights at which hatching ends
constexpr float kHighKey = 0.68f;  ///< L* / 100 that half of the paper reaches with all the light there is
constexpr int kRounds = 3;         ///< of matching the tone; measured: a fourth changes the error by 1 % of it
constexpr float kSeen = 1.6f;      ///< standard deviation of the blur of matching, in distances of lines
constexpr float kThinner = 0.6f, kThicker = 1.6f;     ///< factors on a width in a round
constexpr float kThinnest = 0.55f, kThickest = 1.8f;  ///< widths in pens
constexpr float kTolerance = 0.06f;                   ///< of leaving out points, in pens: not seen in print

/// The picture on the grid.
struct Plate {
    int width = 0, height = 0;
    float pen = kCellsPerPen;
    Study study;
    Raster tone;                       ///< wanted L* / 100
    std::vector<std::uint8_t> ink_of;  ///< of each cell; empty: the first
    std::vector<float> lightness;      ///< L* / 100 of the inks
};

std::vector<Raster> on_grid(const ChannelsView& picture, int width, int height, const ParallelFor& parallel)
{
    std::vector<Raster> channels;
    for (const float* samples : picture.channels)
        channels.push_back(
            blurred(resampled(samples, picture.width, picture.height, width, height, parallel), kFinest, parallel));
    return channels;
}

/// Brings tones, 0..1, nearer to those of a drawing that has its lightest place white, and half of the paper light.
void lighten(std::vector<float>& tones, float light)
{
    if (light <= 0.0f)
        return;
    std::vector<float> sorted = tones;
    const auto quantile = [&](double q) {
        const auto place = sorted.begin() + std::ptrdiff_t(q * double(sorted.size() - 1));
        std::nth_element(sorted.begin(), place, sorted.end());
        return *place;
    };
    const float low = quantile(0.02), high = std::max(quantile(0.98), low + 0.05f);
    const float middle = std::clamp((quantile(0.5) - low) / (high - low), 0.05f, 0.95f);
    const double power = std::min(1.0, elementary::log2(double(kHighKey)) / elementary::log2(double(middle)));
    for (float& tone : tones) {
        const float share = std::clamp((tone - low) / (high - low), 0.0f, 1.0f);
        const float lit = share > 0.0f ? float(elementary::power(double(share), power)) : 0.0f;
        tone += light * (std::max(lit, tone) - tone);
    }
}

Plate make_plate(const InkPicture& picture, const PenOptions& options)
{
    const float w = float(picture.width), h = float(picture.height);
    const float scale = std::min(kCellsPerPen / options.width, std::sqrt(kMostCells / (w * h)));
    Plate plate;
    plate.width = std::max(2, int(w * scale + 0.5f));
    plate.height = std::max(2, int(h * scale + 0.5f));
    plate.pen = options.width * scale;
    plate.study = make_study(on_grid(picture.features, plate.width, plate.height, options.parallel), options.parallel);
    plate.tone =
        resampled(picture.lightness, picture.width, picture.height, plate.width, plate.height, options.parallel);
    for (float& tone : plate.tone.samples)
        tone = 0.01f * std::clamp(tone, 0.0f, 100.0f);
    lighten(plate.tone.samples, options.light);
    for (float& tone : plate.tone.samples)
        tone = std::clamp(1.0f - options.density * (1.0f - tone), kDarkest, 1.0f);
    for (const Ink& ink : picture.inks)
        plate.lightness.push_back(0.01f * ink.lightness);
    if (picture.ink)
        for (int y = 0; y < plate.height; ++y)
            for (int x = 0; x < plate.width; ++x) {
                const int from_y = std::min(picture.height - 1, int((float(y) + 0.5f) / scale));
                const int from_x = std::min(picture.width - 1, int((float(x) + 0.5f) / scale));
                plate.ink_of.push_back(
                    picture.ink[std::size_t(from_y) * std::size_t(picture.width) + std::size_t(from_x)]);
            }
    return plate;
}

/// The share of each cell that a drawing covers.
Raster covered(const Drawing& drawing, const Plate& plate, const ParallelFor& parallel)
{
    Raster cover = make_raster(plate.width, plate.height);
    Canvas canvas { plate.width, plate.height, { cover.samples.data() }, nullptr };
    render_drawing(drawing, { std::vector<float>(plate.lightness.size(), 1.0f) }, canvas, parallel);
    return cover;
}

/// L* / 100 of a drawing.
Raster seen(const Drawing& drawing, const Plate& plate, const ParallelFor& parallel)
{
    Raster paper = make_raster(plate.width, plate.height, 1.0f);
    Canvas canvas { plate.width, plate.height, { paper.samples.data() }, nullptr };
    render_drawing(drawing, { plate.lightness }, canvas, parallel);
    return paper;
}

/// The shares of the paper that the two directions of hatching are to cover in addition to the outlines.
struct Covers {
    Raster first, second;
};

Covers find_covers(const Plate& plate, const Raster& outlined, const PenOptions& options)
{
    const Raster around = blurred(outlined, 2.0f * plate.pen, options.parallel);
    const Raster tone = blurred(plate.tone, kTone * plate.pen, options.parallel);
    Covers covers { make_raster(plate.width, plate.height), make_raster(plate.width, plate.height) };
    const bool crossed = options.cross && options.style != InkStyle::stipple;
    for (std::size_t i = 0; i < tone.samples.size(); ++i) {
        const float spared = std::max(0.3f, 1.0f - kUnderOutlines * (1.0f - around.samples[i]));
        const float wanted = std::min(1.0f, tone.samples[i] / spared);
        const float paint = 1.0f - plate.lightness[plate.ink_of.empty() ? 0 : plate.ink_of[i]];
        const float all = (1.0f - wanted) / std::max(paint, 0.05f);
        float& first = covers.first.samples[i];
        first = std::min(all, kMostAlone);
        // The second direction always has the first ink, which is black, and adds the darkness that the first did not
        // reach.
        if (crossed && all > kOneWay) {
            first = std::min(kMostOfOne, kOneWay + kBelowCross * (all - kOneWay));
            covers.second.samples[i] = std::clamp(1.0f - wanted / (1.0f - first * paint), 0.0f, kMostAcross);
        }
    }
    return covers;
}

Drawing empty_drawing(const Plate& plate)
{
    Drawing drawing;
    drawing.width = plate.width;
    drawing.height = plate.height;
    return drawing;
}

/// Adds the lines of one drawing to another of its size.
void append(const Drawing& lines, Drawing& drawing)
{
    for (InkLine line : lines.lines) {
        line.first += Index(drawing.points.size());
        drawing.lines.push_back(line);
    }
    drawing.points.insert(drawing.points.end(), lines.points.begin(), lines.points.end());
}

/// Where hatching ends: at outlines, before them where it is dark, and at what is left white.
Raster find_stops(const Plate& plate, const Raster& cover, const Raster& outlined, const PenOptions& options)
{
    Raster stops = outlined;
    for (float& stop : stops.samples)
        stop = 1.0f - stop;
    const Raster near = blurred(stops, kHalo * plate.pen, options.parallel);
    Drawing lights = empty_drawing(plate);
    if (options.outline > 0.0f)
        add_highlights(plate.study, { plate.pen, 1.0f, options.detail, options.parallel }, lights);
    const Raster lit = covered(lights, plate, options.parallel);
    for (std::size_t i = 0; i < stops.samples.size(); ++i) {
        const float dark = std::clamp((cover.samples[i] - kHaloFrom) / (kHaloFull - kHaloFrom), 0.0f, 1.0f);
        const bool beside = near.samples[i] > kHaloStop + (1.0f - dark);
        stops.samples[i] = stops.samples[i] > kStop || beside || lit.samples[i] > kHighlight ? 1.0f : 0.0f;
    }
    return stops;
}

void hatch(const Plate& plate, const Covers& covers, const Raster& stops, const PenOptions& options, Drawing& drawing)
{
    const FormField field(plate.study.base, options.style == InkStyle::hatch ? 1.2f : 0.12f, options.parallel);
    HatchLayer layer;
    layer.cover = &covers.first;
    layer.stops = &stops;
    layer.ink_of = plate.ink_of.empty() ? nullptr : &plate.ink_of;
    layer.pen = plate.pen;
    layer.spacing = options.spacing;
    layer.length = options.length;
    layer.least = kLightest;
    layer.seed = scramble(options.seed);
    HatchLayer across = layer;
    across.cover = &covers.second;
    across.ink_of = nullptr;
    across.turn = kCrossing * float(elementary::kPi / 180.0);
    across.least = kLeastAcross;
    across.seed = scramble(layer.seed);
    Drawing lines = empty_drawing(plate);
    at_once(
        options.parallel, [&] { add_hatching(field, layer, drawing); }, [&] { add_hatching(field, across, lines); });
    append(lines, drawing);
}

/// Makes lines wider where the drawing is too light and narrower where it is too dark, as seen from some distance.
void match_tone(const Plate& plate, const Drawing& outlines, const PenOptions& options, Drawing& drawing)
{
    const float sigma = kSeen * plate.pen * options.spacing;
    const Raster wanted = blurred(plate.tone, sigma, options.parallel);
    for (int round = 0; round < kRounds; ++round) {
        Drawing both = drawing;
        append(outlines, both);
        const Raster shown = blurred(seen(both, plate, options.parallel), sigma, options.parallel);
        in_batches(options.parallel, drawing.lines.size(), [&](std::size_t i) {
            const InkLine& line = drawing.lines[i];
            InkPoint* p = drawing.begin(line);
            for (Index k = 0; k < line.count; ++k) {
                const std::size_t at = pixel_at(shown, { p[k].x, p[k].y });
                const float is = std::clamp(shown.samples[at], 0.02f, 0.995f);
                const float should = std::clamp(wanted.samples[at], 0.03f, 1.0f);
                const float more = float(elementary::log2(double(should)) / elementary::log2(double(is)));
                // A line covers an area in proportion to its width, a dot one in proportion to the square of it.
                const float factor = std::clamp(line.count > 1 ? more : std::sqrt(more), kThinner, kThicker);
                const float share = line.count > 1 ? taper_at(k, line.count, plate.pen, 1.0f - should) : 1.0f;
                p[k].width =
                    std::clamp(p[k].width * factor, kThinnest * share * plate.pen, kThickest * share * plate.pen);
            }
            for (Index k = 1; k + 1 < line.count; ++k)
                p[k].width = 0.25f * p[k - 1].width + 0.5f * p[k].width + 0.25f * p[k + 1].width;
        });
    }
}

}  // namespace

void draw_ink(const InkPicture& picture, const PenOptions& options, Drawing& drawing)
{
    const Plate plate = make_plate(picture, options);
    drawing = empty_drawing(plate);
    Drawing outlines = drawing;
    if (options.outline > 0.0f)
        add_outlines(plate.study, { plate.pen, options.outline, options.detail, options.parallel }, outlines);
    if (options.density > 0.0f) {
        const Raster outlined = seen(outlines, plate, options.parallel);
        const Covers covers = find_covers(plate, outlined, options);
        if (options.style == InkStyle::stipple)
            add_stipple(covers.first,
                        { plate.pen, kLightest, plate.ink_of.empty() ? nullptr : &plate.ink_of, options.seed },
                        drawing);
        else
            hatch(plate, covers, find_stops(plate, covers.first, outlined, options), options, drawing);
        match_tone(plate, outlines, options, drawing);
    }
    append(outlines, drawing);
    simplify_lines(drawing, kTolerance * plate.pen);
    drawing = resized(drawing, picture.width, picture.height);
    for (const Ink& ink : picture.inks)
        drawing.inks.push_back(ink.colour);
}

Status plan_ink(const Hierarchy&, const float* darkness, const DirectionField& field, const PenOptions& options,
                Strokes& lines)
{
    InkPicture picture;
    picture.width = field.width();
    picture.height = field.height();
    const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
    std::vector<float> lightness(pixels), steps(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const float dark = darkness[i] > 0.0f ? std::min(darkness[i], 1.0f) : 0.0f;
        lightness[i] = 100.0f * (1.0f - dark);
        steps[i] = 255.0f * (1.0f - dark);
    }
    picture.lightness = lightness.data();
    picture.features = { picture.width, picture.height, { steps.data() } };
    Drawing drawing;
    draw_ink(picture, options, drawing);
    lines = {};
    lines.width = drawing.width;
    lines.height = drawing.height;
    for (const InkLine& line : drawing.lines) {
        const InkPoint* p = drawing.begin(line);
        lines.strokes.push_back({ Index(lines.points.size()), std::max<Index>(line.count, 2), options.width, kGhost, 0,
                                  scramble(Index(lines.strokes.size()) + scramble(options.seed)) });
        for (Index k = 0; k < line.count; ++k)
            lines.points.push_back({ p[k].x, p[k].y });
        if (line.count == 1)  // a dot; strokes have two points or more
            lines.points.push_back({ p[0].x + 0.01f, p[0].y });
    }
    return {};
}

}  // namespace PIMG_ABI
}  // namespace pimg
