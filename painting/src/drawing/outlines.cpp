// SPDX-License-Identifier: BSD-3-Clause
// The ridges of a map of lines are followed in steps of a cell, from the most important place to both sides.
#include "drawing/outlines.h"

#include <algorithm>
#include <cmath>

#include <pimg/detail/elementary.h>
#include <pimg/detail/stop.h>

#include "drawing/line_map.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// Chosen by eye on photographs of 0.1 to 1 megapixel. Importance is in 8-bit steps per cell, of which a pen is two wide
// (ink.cpp); after each number stands what more of it does.
constexpr float kStart = 6.0f;                ///< slope at which a line may start; more: fewer lines
constexpr float kGoOn = 2.6f;                 ///< slope down to which it goes on; more: shorter lines
constexpr int kGap = 4;                       ///< steps with less than that which a line crosses; more: longer lines
constexpr float kLeastSum = 140.0f;           ///< sum of slopes along a line that is drawn; more: fewer lines
constexpr float kShortest = 5.0f;             ///< length in pens of an edge; more: fewer lines
constexpr float kShortestThin = 15.0f;        ///< and of a line along what is thin
constexpr float kStraight = 0.45f;            ///< cosine of the sharpest turn in a step
constexpr int kMostSteps = 8000;              ///< to one side
constexpr int kLoop = 12;                     ///< steps after which a line that meets itself has closed
constexpr int kSmoothings = 10;               ///< of the places, each with 1 2 1; more: calmer lines, rounder corners
constexpr int kWidthSmoothings = 24;          ///< of the widths
constexpr float kThin = 0.5f, kThick = 1.8f;  ///< widths in pens of a line without and with the most slope
constexpr float kThickestThin = 1.1f;         ///< the most of a line along what is thin
constexpr float kRise = 0.9f;                 ///< width in pens that an edge of kSteep adds to kThin
constexpr float kSteep = 16.0f;               ///< slope; more: thinner lines
constexpr float kTaper = 6.0f;                ///< length of an end that tapers, in pens
constexpr float kTip = 0.3f;                  ///< width of its tip, as a share of the line's

/// Follows ridges, the most important first. Lines keep away from those of maps traced before.
class Tracer {
public:
    Tracer(const OutlineOptions& options, Drawing& drawing)
        : m_options(options),
          m_drawing(drawing),
          m_scale(float(elementary::exp2(2.0 * (1.0 - 2.0 * double(options.detail))))),
          m_marks(std::size_t(drawing.width) * std::size_t(drawing.height), Mark { -1, 0 })
    {
    }

    /// `shortest` is the length in pens of a line, `thick` its width.
    void trace(const LineMap& map, float shortest, float thick);

private:
    struct Mark {
        int line, step;  ///< number of the line through the pixel, and of its step there; -1: none
    };
    struct Side {
        std::vector<InkPoint> points;  ///< the width is the importance until the line is finished
        bool joined = false;           ///< ends at another line or at its own beginning
    };

    std::vector<std::size_t> starts() const;
    Side follow(Vec2 start, int sign);
    Vec2 onto_ridge(Vec2 p, Vec2 along) const;
    bool is_drawn(const std::vector<InkPoint>& points) const;
    void finish(std::vector<InkPoint>& points, bool joined_at_first, bool joined_at_last) const;
    void keep_away(const std::vector<InkPoint>& points);
    float strength_at(Vec2 p) const { return between(m_map->strength, p); }
    float importance_at(Vec2 p) const { return between(m_map->importance, p); }

    const OutlineOptions& m_options;
    const LineMap* m_map = nullptr;
    float m_shortest = 0.0f, m_thick = 0.0f;
    Drawing& m_drawing;
    float m_scale;  ///< factor on what a line needs
    int m_line = 0;
    std::vector<Mark> m_marks;
    std::vector<std::size_t> m_walked;  ///< pixels with the mark of the line being followed
};

std::vector<std::size_t> Tracer::starts() const
{
    const Raster& ridges = m_map->strength;
    const std::vector<float>& importances = m_map->importance.samples;
    std::vector<std::size_t> starts;
    for (int y = 2; y < ridges.height - 2; ++y)
        for (int x = 2; x < ridges.width - 2; ++x) {
            const Vec2 p { float(x), float(y) };
            const std::size_t at = pixel_at(ridges, p);
            if (importances[at] < m_scale * kStart)
                continue;
            const Vec2 d = m_map->along(p);
            if (ridges.samples[at] >= strength_at({ p.x - d.y, p.y + d.x })
                && ridges.samples[at] > strength_at({ p.x + d.y, p.y - d.x }))
                starts.push_back(at);
        }
    std::stable_sort(starts.begin(), starts.end(),
                     [&](std::size_t a, std::size_t b) { return importances[a] > importances[b]; });
    return starts;
}

/// Moves p towards the top of a parabola through three slopes across the ridge.
Vec2 Tracer::onto_ridge(Vec2 p, Vec2 along) const
{
    constexpr float kPull = 0.7f;  // moving all the way would make lines jump where ridges meet
    const Vec2 across { -along.y, along.x };
    const float here = strength_at(p), left = strength_at({ p.x - across.x, p.y - across.y }),
                right = strength_at({ p.x + across.x, p.y + across.y });
    const float bend = left - 2.0f * here + right;
    const float top = bend < -1e-4f ? std::clamp(0.5f * (left - right) / bend, -0.5f, 0.5f)
        : left > right              ? -0.5f
                                    : 0.5f;
    return { p.x + kPull * top * across.x, p.y + kPull * top * across.y };
}

Tracer::Side Tracer::follow(Vec2 start, int sign)
{
    const Raster& ridges = m_map->strength;
    Side side;
    Vec2 p = start, d = m_map->along(start);
    d = { float(sign) * d.x, float(sign) * d.y };
    int weak = 0;
    for (int step = 0; step < kMostSteps; ++step) {
        if (step > 0)
            p = { p.x + d.x, p.y + d.y };
        if (p.x < 1.0f || p.y < 1.0f || p.x > float(ridges.width - 2) || p.y > float(ridges.height - 2))
            break;
        p = onto_ridge(p, d);
        Mark& here = m_marks[pixel_at(ridges, p)];
        const bool closed = here.line == m_line && std::abs(here.step - sign * step) > kLoop;
        const float importance = importance_at(p);
        if ((here.line >= 0 && here.line != m_line) || closed) {
            side.joined = true;
            side.points.push_back({ p.x, p.y, importance });
            break;
        }
        here = { m_line, sign * step };
        m_walked.push_back(pixel_at(ridges, p));
        weak = importance < m_scale * kGoOn ? weak + 1 : 0;
        if (weak > kGap)
            break;
        side.points.push_back({ p.x, p.y, importance });
        Vec2 next = m_map->along(p);
        const float cosine = next.x * d.x + next.y * d.y;
        if (std::fabs(cosine) < kStraight)
            break;
        next = cosine < 0.0f ? Vec2 { -next.x, -next.y } : next;
        const Vec2 sum { d.x + next.x, d.y + next.y };
        const float length = std::sqrt(sum.x * sum.x + sum.y * sum.y);
        d = { sum.x / length, sum.y / length };
    }
    if (!side.joined)
        side.points.resize(side.points.size() - std::min(side.points.size(), std::size_t(std::min(weak, kGap))));
    return side;
}

bool Tracer::is_drawn(const std::vector<InkPoint>& points) const
{
    float sum = 0.0f;
    for (const InkPoint& p : points)
        sum += p.width;
    return sum >= m_scale * kLeastSum && float(points.size()) >= m_scale * m_shortest * m_options.pen;
}

/// Marks the pixels around a line where another line would touch it.
void Tracer::keep_away(const std::vector<InkPoint>& points)
{
    constexpr int kNear = 2;
    const Raster& ridges = m_map->strength;
    for (const InkPoint& p : points)
        for (int y = -kNear; y <= kNear; ++y)
            for (int x = -kNear; x <= kNear; ++x) {
                Mark& mark = m_marks[pixel_at(ridges, { p.x + float(x), p.y + float(y) })];
                if (mark.line < 0)
                    mark = { m_line, 0 };
            }
}

/// One step of smoothing with 1 2 1 that leaves the ends where they are.
template<class Member>
void smooth(std::vector<InkPoint>& points, Member member)
{
    float before = points.front().*member;
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
        const float here = points[k].*member;
        points[k].*member = 0.25f * before + 0.5f * here + 0.25f * points[k + 1].*member;
        before = here;
    }
}

void Tracer::finish(std::vector<InkPoint>& points, bool joined_at_first, bool joined_at_last) const
{
    for (int i = 0; i < kSmoothings; ++i) {
        smooth(points, &InkPoint::x);
        smooth(points, &InkPoint::y);
    }
    for (int i = 0; i < kWidthSmoothings; ++i)
        smooth(points, &InkPoint::width);
    const float length = float(points.size()), taper = std::min(kTaper * m_options.pen, 0.4f * length);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const float steep = std::sqrt(points[k].width / kSteep);
        float share = 1.0f;
        if (!joined_at_first)
            share = std::min(share, (float(k) + 0.5f) / taper);
        if (!joined_at_last)
            share = std::min(share, (length - float(k) - 0.5f) / taper);
        points[k].width = m_options.pen * m_options.weight * std::min(m_thick, kThin + kRise * steep)
            * (kTip + (1.0f - kTip) * share);
    }
}

void Tracer::trace(const LineMap& map, float shortest, float thick)
{
    m_map = &map;
    m_shortest = shortest;
    m_thick = thick;
    for (const std::size_t start : starts()) {
        stop_point();
        if (m_marks[start].line >= 0)
            continue;
        const Index width = Index(m_drawing.width);
        const Index column = Index(start) % width, row = Index(start) / width;
        const Vec2 place { float(column), float(row) };
        m_walked.clear();
        Side back = follow(place, -1), forth = follow(place, 1);
        std::vector<InkPoint> points(back.points.rbegin(), back.points.rend());
        points.insert(points.end(), forth.points.begin() + (forth.points.empty() ? 0 : 1), forth.points.end());
        if (!is_drawn(points)) {
            for (const std::size_t pixel : m_walked)
                m_marks[pixel].line = -1;
            continue;
        }
        keep_away(points);
        ++m_line;
        finish(points, back.joined, forth.joined);
        m_drawing.lines.push_back({ Index(m_drawing.points.size()), Index(points.size()), 0 });
        m_drawing.points.insert(m_drawing.points.end(), points.begin(), points.end());
    }
}

}  // namespace

void add_outlines(const Study& study, const OutlineOptions& options, Drawing& drawing)
{
    // What is thin is drawn with one line, and comes first, so that its two edges do not get lines of their own.
    Tracer tracer(options, drawing);
    tracer.trace(thin_lines_of(study, false, options.parallel), kShortestThin, kThickestThin);
    tracer.trace(edges_of(study, options.parallel), kShortest, kThick);
}

void add_highlights(const Study& study, const OutlineOptions& options, Drawing& drawing)
{
    Tracer(options, drawing).trace(thin_lines_of(study, true, options.parallel), kShortestThin, kThickestThin);
}

}  // namespace PIMG_ABI
}  // namespace pimg
