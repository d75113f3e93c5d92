// SPDX-License-Identifier: BSD-3-Clause
// Strokes to pixels. The canvas is cut into tiles, and every tile paints the strokes that touch it in their order. For
// each pixel of the tile a stroke finds the nearest point of its middle line, that is how far along the pixel is and
// how far across; then it looks up the brush there and blends.
#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>
#include <pimg/paint.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sketch.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kTile = 64;      ///< pixels; the four arrays of floats of a tile take 64 kB
constexpr float kFar = 1e30f;  ///< beyond any distance

/// Shares of the canvas showing through that count as a gap in a stroke, which stays, and as a hole, which is filled;
/// between them it is filled in part. When they were chosen, no pixel kept more than 14 % of a coloured canvas.
constexpr float kGap = 0.1f, kHole = 0.3f;

/// Thickness of the paint, in pixels, of a stroke one pixel wide; it grows as the root of the width. Chosen by eye.
/// More gives a stronger relief.
constexpr float kThickness = 0.6f;

/// Pixels [x0, x1) x [y0, y1).
struct Box {
    int x0, y0, x1, y1;
    bool empty() const { return x0 >= x1 || y0 >= y1; }
};

Box around(Vec2 a, Vec2 b, float reach)
{
    return { int(std::ceil(std::min(a.x, b.x) - reach)), int(std::ceil(std::min(a.y, b.y) - reach)),
             int(std::floor(std::max(a.x, b.x) + reach)) + 1, int(std::floor(std::max(a.y, b.y) + reach)) + 1 };
}

Box intersection(Box a, Box b)
{
    return { std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1) };
}

Box united(Box a, Box b)
{
    return { std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1) };
}

/// How far from the middle line paint may lie; half a pixel more than the brush for anti-aliasing, and
/// the corners of square ends.
float reach_of(const Stroke& stroke)
{
    return 0.7072f * stroke.width + 1.0f;
}

/// Factors on the channels of a stroke's colour: red, green and blue, if there are three.
using Tint = std::array<float, 3>;

/// Share of white from which changes of brightness are shares of it. Below, they are as large as there, since equal
/// differences of encoded samples look about equal. More makes shadows livelier.
constexpr float kMiddle = 0.45f;
/// The most by which the shares of random changes and of relief grow in the dark, so that black stays black. More relief
/// makes strokes look as if they ran across the edges: measured as alignment, see docs/internals.md.
constexpr float kMostChanged = 3.0f, kMostRaised = 1.7f;

/// Factor, at most `most`, on a change of brightness where the channels' mean is `value`. White is 0 if it is not known.
float lifted(float value, float white, float most)
{
    return white > 0.0f ? std::clamp(kMiddle * white / std::max(value, 1e-6f * white), 1.0f, most) : 1.0f;
}

/// A random change of brightness and, if there are colours, of warmth: what red gains, blue loses.
Tint tint_of(const Stroke& stroke, float most, bool coloured)
{
    constexpr float kWarmth = 0.6f;  // of the change of brightness; by eye, more looks garish
    const float light = 1.0f + most * signed_unit(scramble(stroke.variation + 3));
    const float warm = coloured ? kWarmth * most * signed_unit(scramble(stroke.variation + 8)) : 0.0f;
    return { light * (1.0f + warm), light, light * (1.0f - warm) };
}

/// Height of the tooth of the canvas at a pixel, 0..1: threads some two pixels wide, crossed and uneven. By eye.
float tooth_at(int x, int y)
{
    constexpr float kThread = 0.42f;  // cycles per pixel
    const auto bits = [](int a, int b) {
        return signed_unit(scramble(std::uint32_t(a) + scramble(std::uint32_t(b) + 91u)));
    };
    const float knot = 0.5f * (bits(x, y) + 0.5f * (bits(x / 2, y / 2) + bits(x / 5, y / 5)));
    const float weave = std::fabs(2.0f * (kThread * float(x + y) - std::floor(kThread * float(x + y))) - 1.0f);
    return std::clamp(0.5f + 0.55f * knot + 0.3f * (weave - 0.5f), 0.0f, 1.0f);
}

/// Keeps paint on its side of an edge.
class EdgeStop {
public:
    EdgeStop(const Strokes& strokes, const StrokePaintOptions& options)
        : m_picture(*options.edges, options.parallel),
          m_least(kAcross * options.crossing),
          m_shades(stroke_colours(strokes, *options.edges, *options.edges, options.parallel))
    {
        m_shades.resize(std::min(m_shades.size(), std::tuple_size<Shade>::value));
    }

    Shade shade(Index stroke) const
    {
        Shade shade {};
        for (std::size_t c = 0; c < m_shades.size(); ++c)
            shade[c] = m_shades[c][stroke];
        return shade;
    }

    /// Share of a pixel that paint of this shade may cover: 1 on its own side of the edge, 1/2 half way across.
    float share(const Shade& shade, int x, int y) const
    {
        const float off = m_picture.distance(m_picture.pixel(x, y), shade);
        if (off <= kSurely * m_least)
            return 1.0f;
        return std::clamp(0.5f + kSharpness * (0.5f - off / std::max(m_picture.contrast(x, y), m_least)), 0.0f, 1.0f);
    }

private:
    static constexpr float kAcross = 2.5f;  ///< least difference, in crossings, that stops paint fully; by eye
    static constexpr float kSharpness =
        2.0f;                               ///< makes up for the smoothing of edges; softer spills more (internals.md)
    static constexpr float kSurely = 0.2f;  ///< share of m_least below which the sum in share() is 1 in any case

    ShadePicture m_picture;
    float m_least;
    std::vector<std::vector<float>> m_shades;
};

class TilePainter {
public:
    TilePainter(Box tile, const Brush& brush, const StrokePaintOptions& options, const EdgeStop* stop, Canvas& canvas)
        : m_tile(tile),
          m_brush(brush),
          m_options(options),
          m_stop(stop),
          m_canvas(canvas)
    {
        std::fill(std::begin(m_distance), std::end(m_distance), kFar);
        std::fill(std::begin(m_bare), std::end(m_bare), 1.0f);
        if (brush.tooth() > 0.0f)
            m_tooth.resize(std::size_t(kTile) * kTile);
        for (std::size_t i = 0; i < m_tooth.size(); ++i)
            m_tooth[i] = tooth_at(tile.x0 + int(i) % kTile, tile.y0 + int(i) / kTile);
    }

    void paint(const Strokes& strokes, Index i, const std::vector<std::vector<float>>& colours);

    /// After all strokes: shows the ground where there is too little paint.
    void fill_holes();

private:
    void measure(Vec2 a, Vec2 b, float start, bool first, bool last, Box box);
    void look_up(const Stroke& stroke, float length, Box box);
    void rest_on_tooth(Box box);
    void stop_at_edges(const Shade& shade, Box box);
    void note_cover(Box box);
    void blend(const std::vector<std::vector<float>>& colours, Index i, const Tint& tint, float thickness, Box box);
    int slot(int x, int y) const { return (y - m_tile.y0) * kTile + (x - m_tile.x0); }

    Box m_tile;
    const Brush& m_brush;
    const StrokePaintOptions& m_options;
    const EdgeStop* m_stop;
    Canvas& m_canvas;
    // Per pixel of the tile: at first the squared distance from the middle line and the place along and across it;
    // then, see look_up(), alpha and height of the paint.
    float m_distance[kTile * kTile], m_along[kTile * kTile], m_across[kTile * kTile];
    float m_bare[kTile * kTile];  ///< share of the canvas that opaque strokes would leave
    std::vector<float> m_tooth;   ///< of the canvas; empty: the brush reaches all of it
};

/// Measures the pixels that are nearer to the segment a -> b than to those before. m_across receives the square of the
/// distance across, with a sign for the side. The first and the last segment go on beyond their ends.
void TilePainter::measure(Vec2 a, Vec2 b, float start, bool first, bool last, Box box)
{
    const float dx = b.x - a.x, dy = b.y - a.y;
    const float length = std::sqrt(dx * dx + dy * dy), inverse = 1.0f / std::max(length, 1e-6f);
    const float tx = dx * inverse, ty = dy * inverse;
    const float from = first ? -kFar : 0.0f, to = last ? kFar : length;
    for (int y = box.y0; y < box.y1; ++y) {
        const float py = float(y) - a.y;
        const int row = slot(box.x0, y);
        float *distance = m_distance + row, *along = m_along + row, *across = m_across + row;
        for (int k = 0; k < box.x1 - box.x0; ++k) {
            const float px = float(box.x0 + k) - a.x;
            const float s = px * tx + py * ty, v = py * tx - px * ty;
            const float on = std::min(std::max(s, from), to), off = s - on;
            // Beyond the ends only the distance at right angles to the line counts: the brush has the shape of the
            // ends.
            const float d = v * v + off * off;
            const bool nearer = d < distance[k];
            distance[k] = nearer ? d : distance[k];
            along[k] = nearer ? start + on : along[k];
            across[k] = nearer ? std::copysign(d, v) : across[k];
        }
    }
}

/// Replaces places by what the brush has there: alpha in m_along, and for the relief also in m_distance, which stays
/// kFar where there is no paint; height in m_across.
void TilePainter::look_up(const Stroke& stroke, float length, Box box)
{
    const float half = 0.5f * stroke.width, total = length + stroke.width, per_width = 1.0f / stroke.width;
    const Brush::Mask mask = m_brush.mask(stroke.width, stroke.variation);
    const float opacity = m_options.opacity * stroke.opacity;
    // The ends keep their shape; only what is longer than two widths is stretched.
    const float zone = m_brush.stretched() ? 0.25f * total : std::min(stroke.width, 0.5f * total);
    const float per_zone = 0.25f / zone, per_middle = total > 2.0f * zone ? 0.5f / (total - 2.0f * zone) : 0.0f;
    for (int y = box.y0; y < box.y1; ++y) {
        const int row = slot(box.x0, y);
        float *distance = m_distance + row, *along = m_along + row, *across = m_across + row;
        for (int k = 0; k < box.x1 - box.x0; ++k) {
            if (distance[k] >= kFar)
                continue;
            const float s = along[k] + half, v = std::copysign(std::sqrt(std::fabs(across[k])), across[k]);
            const float inside = std::min(std::min(s, total - s), half - std::fabs(v)) + 0.5f;
            if (inside <= 0.0f) {
                distance[k] = kFar;
                continue;
            }
            const float u = s < zone ? s * per_zone
                : s <= total - zone  ? 0.25f + (s - zone) * per_middle
                                     : 1.0f - (total - s) * per_zone;
            const Paint paint = mask.at(u, v * per_width + 0.5f);
            along[k] = paint.alpha * std::min(inside, 1.0f) * opacity;
            across[k] = paint.height;
            distance[k] = along[k];
        }
    }
}

/// Leaves thin paint on the raised parts of the canvas only.
void TilePainter::rest_on_tooth(Box box)
{
    // By eye. More of the first leaves more canvas bare, more of the second makes harder grains.
    constexpr float kPress = 1.15f, kGrip = 5.0f;
    const float deep = m_brush.tooth();
    for (int y = box.y0; y < box.y1; ++y) {
        const int row = slot(box.x0, y);
        for (int k = row; k < row + box.x1 - box.x0; ++k)
            if (m_distance[k] < kFar) {
                // Tooth higher than this takes paint. Pressing harder reaches deeper.
                const float least = deep * (kPress - m_along[k]);
                m_along[k] *= std::clamp(0.5f + kGrip * (m_tooth[std::size_t(k)] - least), 0.0f, 1.0f);
                m_distance[k] = m_along[k];
            }
    }
}

void TilePainter::stop_at_edges(const Shade& shade, Box box)
{
    for (int y = box.y0; y < box.y1; ++y) {
        const int row = slot(box.x0, y);
        for (int k = 0; k < box.x1 - box.x0; ++k)
            if (m_distance[row + k] < kFar && m_along[row + k] > 0.0f) {
                // The thickness of the paint reaches a little beyond its colour, so that there are no pits along edges.
                const float share = m_stop->share(shade, box.x0 + k, y);
                m_along[row + k] *= share;
                m_distance[row + k] *= 0.5f + 0.5f * share;
            }
    }
}

void TilePainter::blend(const std::vector<std::vector<float>>& colours, Index i, const Tint& tint, float thickness,
                        Box box)
{
    const float grain = m_brush.grain();
    for (int y = box.y0; y < box.y1; ++y) {
        const int row = slot(box.x0, y), columns = box.x1 - box.x0;
        float* distance = m_distance + row;
        const float *alpha = m_along + row, *height = m_across + row;
        const std::size_t at = std::size_t(y) * std::size_t(m_canvas.width) + std::size_t(box.x0);
        for (std::size_t c = 0; c < m_canvas.channels.size(); ++c) {
            const float colour = tint[std::min<std::size_t>(c, 2)] * colours[c][i];
            float* out = m_canvas.channels[c] + at;
            for (int k = 0; k < columns; ++k) {
                const float shade = colour * (1.0f + grain * (height[k] - 0.5f));
                const float mixed = out[k] + alpha[k] * (shade - out[k]);
                out[k] = distance[k] < kFar ? mixed : out[k];
            }
        }
        if (m_canvas.alpha)
            for (int k = 0; k < columns; ++k) {
                float& out = m_canvas.alpha[at + std::size_t(k)];
                const float mixed = out + alpha[k] * (colours[m_canvas.channels.size()][i] - out);
                out = distance[k] < kFar ? mixed : out;
            }
        if (m_canvas.relief)
            for (int k = 0; k < columns; ++k) {
                float& out = m_canvas.relief[at + std::size_t(k)];
                const float mixed = out + distance[k] * (thickness * height[k] - out);
                out = distance[k] < kFar ? mixed : out;
            }
        std::fill(distance, distance + columns, kFar);
    }
}

void TilePainter::note_cover(Box box)
{
    const float per_opacity = 1.0f / m_options.opacity;
    for (int y = box.y0; y < box.y1; ++y) {
        const int row = slot(box.x0, y);
        for (int k = 0; k < box.x1 - box.x0; ++k)
            if (m_distance[row + k] < kFar)
                m_bare[row + k] *= 1.0f - m_along[row + k] * per_opacity;
    }
}

void TilePainter::fill_holes()
{
    for (int y = m_tile.y0; y < m_tile.y1; ++y)
        for (int x = m_tile.x0; x < m_tile.x1; ++x) {
            const float hole = (m_bare[slot(x, y)] - kGap) / (kHole - kGap);
            if (hole <= 0.0f)
                continue;
            const float alpha = m_options.opacity * std::min(hole, 1.0f);
            const std::size_t at = std::size_t(y) * std::size_t(m_canvas.width) + std::size_t(x);
            for (std::size_t c = 0; c < m_canvas.channels.size(); ++c)
                m_canvas.channels[c][at] += alpha * (m_options.ground->channels[c][at] - m_canvas.channels[c][at]);
            if (m_canvas.alpha)
                m_canvas.alpha[at] +=
                    alpha * (m_options.ground->channels[m_canvas.channels.size()][at] - m_canvas.alpha[at]);
        }
}

void TilePainter::paint(const Strokes& strokes, Index i, const std::vector<std::vector<float>>& colours)
{
    const Stroke& stroke = strokes.strokes[i];
    const Vec2* p = strokes.begin(stroke);
    const float reach = reach_of(stroke), side = 0.5f * stroke.width + 1.0f;
    Box touched { m_tile.x1, m_tile.y1, m_tile.x0, m_tile.y0 };
    float length = 0.0f;
    for (Index k = 0; k + 1 < stroke.count; ++k) {
        const bool is_end = k == 0 || k + 2 == stroke.count;
        const Box box = intersection(around(p[k], p[k + 1], is_end ? reach : side), m_tile);
        if (!box.empty()) {
            measure(p[k], p[k + 1], length, k == 0, k + 2 == stroke.count, box);
            touched = united(touched, box);
        }
        length +=
            std::sqrt((p[k + 1].x - p[k].x) * (p[k + 1].x - p[k].x) + (p[k + 1].y - p[k].y) * (p[k + 1].y - p[k].y));
    }
    if (touched.empty())
        return;
    look_up(stroke, length, touched);
    if (!m_tooth.empty())
        rest_on_tooth(touched);
    if (m_stop)
        stop_at_edges(m_stop->shade(i), touched);
    if (m_options.ground)
        note_cover(touched);
    float mean = 0.0f;
    for (std::size_t c = 0; c < m_canvas.channels.size(); ++c)
        mean += colours[c][i] / float(m_canvas.channels.size());
    const float jitter = std::min(1.0f, m_options.jitter_colour * lifted(mean, m_options.white, kMostChanged));
    const Tint tint = tint_of(stroke, jitter, m_canvas.channels.size() > 2);
    blend(colours, i, tint, kThickness * std::sqrt(stroke.width), touched);
}

}  // namespace

void paint_strokes(const Strokes& strokes, const std::vector<std::vector<float>>& colours, const Brush& brush,
                   const StrokePaintOptions& options, Canvas& canvas)
{
    if (brush.empty() || options.opacity <= 0.0f)
        return;
    const int columns = (canvas.width + kTile - 1) / kTile, rows = (canvas.height + kTile - 1) / kTile;
    std::vector<std::vector<Index>> of_tile(std::size_t(columns) * std::size_t(rows));
    for (Index i = 0; i < Index(strokes.strokes.size()); ++i) {
        stop_point();
        const Stroke& stroke = strokes.strokes[i];
        const Vec2* p = strokes.begin(stroke);
        Box box = around(p[0], p[1], reach_of(stroke));
        for (Index k = 1; k + 1 < stroke.count; ++k)
            box = united(box, around(p[k], p[k + 1], reach_of(stroke)));
        box = intersection(box, { 0, 0, canvas.width, canvas.height });
        for (int y = box.y0 / kTile; !box.empty() && y <= (box.y1 - 1) / kTile; ++y)
            for (int x = box.x0 / kTile; x <= (box.x1 - 1) / kTile; ++x)
                of_tile[std::size_t(y) * std::size_t(columns) + std::size_t(x)].push_back(i);
    }
    std::optional<EdgeStop> stop;
    if (options.edges)
        stop.emplace(strokes, options);
    run(options.parallel, of_tile.size(), [&](std::size_t t) {
        const int x = int(t % std::size_t(columns)) * kTile, y = int(t / std::size_t(columns)) * kTile;
        const Box tile { x, y, std::min(x + kTile, canvas.width), std::min(y + kTile, canvas.height) };
        TilePainter painter(tile, brush, options, stop ? &*stop : nullptr, canvas);
        for (Index i : of_tile[t]) {
            stop_point();
            painter.paint(strokes, i, colours);
        }
        if (options.ground)
            painter.fill_holes();
    });
}

void light_relief(Canvas& canvas, float strength, const ParallelFor& parallel, float white)
{
    if (!canvas.relief || strength <= 0.0f)
        return;
    constexpr int kRows = 32;
    // Slope at which the light has changed by 0.7 of what it changes by at most. By eye; more: only steep paint is lit.
    constexpr float kSlope = 0.5f;
    constexpr float kMostLit = 0.9f;        // paint in the shadow of paint is never quite black
    constexpr float kRootOfHalf = 0.7071f;  // the light comes from the upper left, at 45 degrees
    const int w = canvas.width, h = canvas.height;
    run(parallel, std::size_t(h + kRows - 1) / kRows, [&](std::size_t block) {
        for (int y = int(block) * kRows; y < std::min(h, int(block + 1) * kRows); ++y) {
            const float* here = canvas.relief + std::size_t(y) * std::size_t(w);
            const float *above = y > 0 ? here - w : here, *below = y + 1 < h ? here + w : here;
            for (int x = 0; x < w; ++x) {
                const float gx = 0.5f * (here[std::min(x + 1, w - 1)] - here[std::max(x - 1, 0)]);
                const float gy = 0.5f * (below[x] - above[x]);
                const float slope = kRootOfHalf * (gx + gy);  // above 0 where the paint faces the light
                const std::size_t at = std::size_t(y) * std::size_t(w) + std::size_t(x);
                float mean = 0.0f;
                for (const float* channel : canvas.channels)
                    mean += channel[at] / float(canvas.channels.size());
                const float most = std::min(kMostLit, 0.5f * strength * lifted(mean, white, kMostRaised));
                const float light = 1.0f + most * slope / std::sqrt(kSlope * kSlope + slope * slope);
                for (float* channel : canvas.channels)
                    channel[at] *= light;
            }
        }
    });
}

}  // namespace PIMG_ABI
}  // namespace pimg
