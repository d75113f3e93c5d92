// SPDX-License-Identifier: BSD-3-Clause
// Evenly spaced streamlines (Jobard and Lefer 1997) whose distance depends on the tone. A raster holds for each pixel
// near a line how far the nearest line is.
#include "drawing/hatching.h"

#include <algorithm>
#include <cmath>

#include <pimg/detail/elementary.h>
#include <pimg/detail/stop.h>

#include "drawing/raster_ops.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// Chosen by eye; after each number stands what more of it does.
constexpr float kFieldCell = 8.0f;   ///< pixels of the picture to one of the field; more: calmer
constexpr float kFieldNoise = 8.0f;  ///< see DirectionField; more: only strong forms turn the lines
constexpr float kFieldSigma = 2.0f;  ///< of the last filter, in pixels of the field; more: calmer
constexpr double kDiagonal = -50.0 * elementary::kPi / 180.0;  ///< the direction in which a right hand hatches
constexpr float kLightest = 0.7f, kDarkest = 1.3f;  ///< widths in pens of lines in the lightest and the darkest tone
constexpr float kCloser = 0.88f;      ///< share of an even distance, to make up for gaps: measured, see internals.md
constexpr float kNarrows = 0.62f;     ///< share of the distance at which a line ends; more: shorter, more even lines
constexpr float kRoom = 0.97f;        ///< share of the distance a new line needs; more: more gaps
constexpr float kLength = 60.0f;      ///< in pens, most
constexpr float kUneven = 0.45f;      ///< largest random change of the length, as a share of it
constexpr float kChanceCell = 8.0f;   ///< side, in pens, of the squares in which random changes are the same
constexpr float kShortest = 2.5f;     ///< in pens
constexpr float kStraight = 0.85f;    ///< cosine of the sharpest turn in a step
constexpr float kTurned = 0.94f;      ///< share of a full turn after which a line ends, so that it does not meet itself
constexpr float kToneChange = 0.45f;  ///< change of the cover at which a line ends; more: lines cross shadows
constexpr float kAnchors = 40.0f;     ///< distance of the first lines in pens; less: steadier, but more seams
constexpr float kTaper = 5.0f;        ///< length of a tapered end in pens
constexpr float kTip = 0.35f, kDarkTip = 0.8f;  ///< width of its tip in light and dark tones

class Streamlines {
public:
    Streamlines(const FormField& field, const HatchLayer& layer, Drawing& drawing)
        : m_field(field),
          m_layer(layer),
          m_cover(*layer.cover),
          m_drawing(drawing),
          m_first(drawing.lines.size()),
          m_distance(make_raster(m_cover.width, m_cover.height, 1e9f))
    {
        const auto [sine, cosine] = elementary::sine_cosine(double(layer.turn));
        m_sine = float(sine);
        m_cosine = float(cosine);
    }

    void fill();

private:
    Vec2 direction(Vec2 p) const
    {
        const Vec2 d = m_field.at(p);
        return { m_cosine * d.x - m_sine * d.y, m_sine * d.x + m_cosine * d.y };
    }
    float width(float cover) const
    {
        return m_layer.pen * (kLightest + (kDarkest - kLightest) * std::min(cover / 0.8f, 1.0f));
    }
    float spacing(std::size_t pixel) const
    {
        const float cover = std::max(m_cover.samples[pixel], 0.02f);
        return std::max(m_layer.spacing * m_layer.pen, kCloser * width(cover) / cover);
    }
    bool is_free(Vec2 p, float share, Index ink) const;
    Index ink_at(Vec2 p) const { return m_layer.ink_of ? (*m_layer.ink_of)[pixel_at(m_cover, p)] : 0; }
    void walk(Vec2 start, int sign, float reach, std::vector<Vec2>& points) const;
    bool grow(Vec2 start, float share);
    void claim(const InkLine& line);
    void grow_beside_lines();

    const FormField& m_field;
    const HatchLayer& m_layer;
    const Raster& m_cover;
    Drawing& m_drawing;
    std::size_t m_first;     ///< line of this layer
    std::size_t m_next = 0;  ///< line whose sides have not been looked at
    float m_sine = 0.0f, m_cosine = 1.0f;
    Raster m_distance;
    std::vector<Vec2> m_back, m_forth;
};

bool Streamlines::is_free(Vec2 p, float share, Index ink) const
{
    if (p.x < 0.0f || p.y < 0.0f || p.x > float(m_cover.width - 1) || p.y > float(m_cover.height - 1))
        return false;
    const std::size_t at = pixel_at(m_cover, p);
    return m_cover.samples[at] >= m_layer.least && !(m_layer.stops->samples[at] > 0.0f)
        && m_distance.samples[at] >= share * spacing(at) && ink_at(p) == ink;
}

void Streamlines::walk(Vec2 start, int sign, float reach, std::vector<Vec2>& points) const
{
    points.clear();
    const float cover = nearest(m_cover, start);
    const Index ink = ink_at(start);
    Vec2 p = start, d = direction(start);
    d = { float(sign) * d.x, float(sign) * d.y };
    float turned = 0.0f;
    for (float done = 0.0f; done < reach; done += 1.0f) {
        Vec2 next = direction({ p.x + 0.5f * d.x, p.y + 0.5f * d.y });
        const float cosine = next.x * d.x + next.y * d.y;
        if (std::fabs(cosine) < kStraight)
            return;
        next = cosine < 0.0f ? Vec2 { -next.x, -next.y } : next;
        turned += std::fabs(d.x * next.y - d.y * next.x);  // the sine, nearly the angle
        if (turned > kTurned * float(elementary::kPi))
            return;
        d = next;
        p = { p.x + d.x, p.y + d.y };
        if (!is_free(p, kNarrows, ink) || std::fabs(nearest(m_cover, p) - cover) > kToneChange)
            return;
        points.push_back(p);
    }
}

bool Streamlines::grow(Vec2 start, float share)
{
    if (!is_free(start, share, ink_at(start)))
        return false;
    // Chance depends on the place, and not on the number of the line, which changes if a line elsewhere is missing.
    const float cell = kChanceCell * m_layer.pen;
    const std::uint32_t chance =
        scramble(std::uint32_t(start.x / cell) + scramble(std::uint32_t(start.y / cell) + scramble(m_layer.seed)));
    const float reach = 0.5f * kLength * m_layer.pen * m_layer.length * (1.0f + kUneven * signed_unit(chance));
    walk(start, 1, reach, m_forth);
    walk(start, -1, reach, m_back);
    const Index count = Index(m_back.size() + m_forth.size() + 1);
    if (float(count) < kShortest * m_layer.pen)
        return false;
    const InkLine line { Index(m_drawing.points.size()), count, ink_at(start) };
    std::reverse(m_back.begin(), m_back.end());
    m_back.push_back(start);
    m_back.insert(m_back.end(), m_forth.begin(), m_forth.end());
    for (Index k = 0; k < count; ++k) {
        const Vec2 p = m_back[k];
        const float cover = nearest(m_cover, p);
        m_drawing.points.push_back({ p.x, p.y, width(cover) * taper_at(k, count, m_layer.pen, cover) });
    }
    m_drawing.lines.push_back(line);
    claim(line);
    return true;
}

/// Notes how far the line is, for all pixels that are nearer to it than the next line may be.
void Streamlines::claim(const InkLine& line)
{
    const int w = m_cover.width, h = m_cover.height;
    for (const InkPoint* p = m_drawing.begin(line); p != m_drawing.begin(line) + line.count; ++p) {
        const float reach = 1.05f * spacing(pixel_at(m_cover, { p->x, p->y }));
        const int x0 = std::max(0, int(p->x - reach)), x1 = std::min(w - 1, int(p->x + reach) + 1);
        const int y0 = std::max(0, int(p->y - reach)), y1 = std::min(h - 1, int(p->y + reach) + 1);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const float dx = float(x) - p->x, dy = float(y) - p->y, square = dx * dx + dy * dy;
                float& least = m_distance.samples[std::size_t(y) * std::size_t(w) + std::size_t(x)];
                if (square < reach * reach && square < least * least)
                    least = std::sqrt(square);
            }
    }
}

void Streamlines::grow_beside_lines()
{
    for (; m_first + m_next < m_drawing.lines.size(); ++m_next) {
        stop_point();
        const InkLine line = m_drawing.lines[m_first + m_next];
        const Index step = Index(std::max(1.0f, m_layer.pen));
        for (Index k = 0; k < line.count; k += step) {
            const Vec2 p { m_drawing.begin(line)[k].x, m_drawing.begin(line)[k].y };
            const Vec2 d = direction(p);
            const float off = spacing(pixel_at(m_cover, p));
            grow({ p.x - off * d.y, p.y + off * d.x }, kRoom);
            grow({ p.x + off * d.y, p.y - off * d.x }, kRoom);
        }
    }
}

/// First lines at fixed places, which are the same at every resolution of the picture; then lines beside lines until
/// there is no more room; then a line wherever there is still room.
void Streamlines::fill()
{
    constexpr int kStep = 2;
    const float pitch = kAnchors * m_layer.pen;
    for (float y = 0.5f * pitch; y < float(m_cover.height); y += pitch) {
        stop_point();
        for (float x = 0.5f * pitch; x < float(m_cover.width); x += pitch)
            grow({ x, y }, 1.0f);
    }
    grow_beside_lines();
    for (int y = 0; y < m_cover.height; y += kStep) {
        stop_point();
        for (int x = 0; x < m_cover.width; x += kStep)
            if (grow({ float(x), float(y) }, 1.0f))
                grow_beside_lines();
    }
}

}  // namespace

FormField::FormField(const std::vector<Raster>& base, float calm, const ParallelFor& parallel)
{
    const int w = base[0].width, h = base[0].height;
    const int columns = std::max(2, int(float(w) / kFieldCell)), rows = std::max(2, int(float(h) / kFieldCell));
    std::vector<Raster> small;
    small.reserve(base.size());
    ChannelsView view { columns, rows, {} };
    for (const Raster& channel : base)
        small.push_back(resampled(channel.samples.data(), w, h, columns, rows, parallel));
    for (const Raster& channel : small)
        view.channels.push_back(channel.samples.data());
    const DirectionField field(view, parallel, kFieldNoise);
    const auto [sine, cosine] = elementary::sine_cosine(kDiagonal);
    m_scale = { float(columns) / float(w), float(rows) / float(h) };
    m_cosine = m_sine = make_raster(columns, rows);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const Vec2 p { float(x), float(y) }, d = field.at(p);
            const float clear = field.certainty(p);
            const std::size_t at = pixel_at(m_cosine, p);
            m_cosine.samples[at] = clear * (d.x * d.x - d.y * d.y) + calm * float(cosine * cosine - sine * sine);
            m_sine.samples[at] = clear * 2.0f * d.x * d.y + calm * float(2.0 * sine * cosine);
        }
    m_cosine = blurred(m_cosine, kFieldSigma, parallel);
    m_sine = blurred(m_sine, kFieldSigma, parallel);
}

Vec2 FormField::at(Vec2 p) const
{
    const Vec2 q { (p.x + 0.5f) * m_scale.x - 0.5f, (p.y + 0.5f) * m_scale.y - 0.5f };
    return half_angle(between(m_cosine, q), between(m_sine, q));
}

void add_hatching(const FormField& field, const HatchLayer& layer, Drawing& drawing)
{
    Streamlines(field, layer, drawing).fill();
}

float taper_at(Index k, Index count, float pen, float cover)
{
    const float tip = kTip + (kDarkTip - kTip) * std::clamp(2.0f * cover - 0.5f, 0.0f, 1.0f);
    const float length = std::min(kTaper * pen, 0.45f * float(count));
    const float share = (float(std::min(k, count - 1 - k)) + 0.5f) / length;
    return tip + (1.0f - tip) * std::min(1.0f, share);
}

}  // namespace PIMG_ABI
}  // namespace pimg
