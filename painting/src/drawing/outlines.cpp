// SPDX-License-Identifier: BSD-3-Clause
// Slopes across the edges, summed along them, have ridges; the ridges are followed in steps of a pixel.
//
//     channels -> slopes -> structure tensor -> direction along the edge -> slope across it, mean along it -> ridges
//
// The mean along the edge, as in flow-based differences of Gaussians (Kang, Lee and Chui 2007), keeps edges that run on
// and removes texture.
#include "drawing/outlines.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>

#include "drawing/raster_ops.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// Chosen by eye on photographs of 0.1 to 1 megapixel. Slopes are in 8-bit steps per pixel of the pictures, of which a
// pen is two wide (ink.cpp); after each number stands what more of it does.
constexpr float kSlopeSigma = 1.0f;   ///< of the filter before slopes are taken, pixels; more: fewer, smoother lines
constexpr float kTensorSigma = 2.0f;  ///< of the filter of the structure tensor, pixels; more: straighter lines
constexpr int kAlong = 6;             ///< steps to either side over which slopes are averaged; more: only long edges
constexpr float kAlongSigma = 2.5f;   ///< of the weights of these steps
constexpr float kLeastEnergy = 1.0f;  ///< squared slope below which nothing is looked at; more: faster
constexpr float kAround = 8.0f;       ///< standard deviation in pixels of what is around an edge
// The share of its importance that an edge keeps is kAlone - kInhibition r, where r is the mean slope around it over
// its own slope: 0.12 for an edge that is alone, which keeps all.
constexpr float kAlone = 1.3f;                ///< more: busier places
constexpr float kInhibition = 1.4f;           ///< more: calmer places
constexpr float kLeastAlone = 0.15f;          ///< the least share; more: busier places
constexpr float kStart = 6.0f;                ///< slope at which a line may start; more: fewer lines
constexpr float kGoOn = 2.6f;                 ///< slope down to which it goes on; more: shorter lines
constexpr int kGap = 4;                       ///< steps with less than that which a line crosses; more: longer lines
constexpr float kLeastSum = 140.0f;           ///< sum of slopes along a line that is drawn; more: fewer lines
constexpr float kShortest = 5.0f;             ///< length in pens; more: fewer lines
constexpr float kStraight = 0.45f;            ///< cosine of the sharpest turn in a step
constexpr int kMostSteps = 8000;              ///< to one side
constexpr int kLoop = 12;                     ///< steps after which a line that meets itself has closed
constexpr int kSmoothings = 10;               ///< of the places, each with 1 2 1; more: calmer lines, rounder corners
constexpr int kWidthSmoothings = 24;          ///< of the widths
constexpr float kThin = 0.5f, kThick = 1.8f;  ///< widths in pens of a line without and with the most slope
constexpr float kRise = 0.9f;                 ///< width in pens that an edge of kSteep adds to kThin
constexpr float kSteep = 16.0f;               ///< slope; more: thinner lines
constexpr float kTaper = 6.0f;                ///< length of an end that tapers, in pens
constexpr float kTip = 0.3f;                  ///< width of its tip, as a share of the line's

/// Slopes of one channel.
struct Slopes {
    Raster x, y;
};

Slopes slopes_of(const Raster& channel, const ParallelFor& parallel)
{
    const Raster smooth = blurred(channel, kSlopeSigma, parallel);
    const int w = channel.width, h = channel.height;
    Slopes slopes { make_raster(w, h), make_raster(w, h) };
    for_rows(parallel, 0, h, [&](int y) {
        const float* here = smooth.samples.data() + std::size_t(y) * std::size_t(w);
        const float *above = y > 0 ? here - w : here, *below = y + 1 < h ? here + w : here;
        const std::size_t row = std::size_t(y) * std::size_t(w);
        for (int x = 0; x < w; ++x) {
            slopes.x.samples[row + std::size_t(x)] = 0.5f * (here[std::min(x + 1, w - 1)] - here[std::max(x - 1, 0)]);
            slopes.y.samples[row + std::size_t(x)] = 0.5f * (below[x] - above[x]);
        }
    });
    return slopes;
}

/// The edges of a picture: how steep each pixel is across them, and which way they run.
class Edges {
public:
    Edges(const std::vector<Raster>& features, const std::vector<Raster>& base, const ParallelFor& parallel);

    /// Unit vector along the edge.
    Vec2 along(Vec2 p) const
    {
        const std::size_t at = pixel_at(m_slope, p);
        return { m_along_x.samples[at], m_along_y.samples[at] };
    }
    float slope(Vec2 p) const { return between(m_slope, p); }
    /// Geometric mean of the slopes in both pictures. It is reduced where there are other edges around, so that the
    /// edges of leaves and gravel suppress each other.
    float importance(Vec2 p) const
    {
        const float slope = between(m_slope, p), around = between(m_around, p);
        const float alone = std::clamp(kAlone - kInhibition * around / std::max(slope, 1e-3f), kLeastAlone, 1.0f);
        return alone * std::sqrt(slope * between(m_base_slope, p));
    }
    const Raster& slopes() const { return m_slope; }

private:
    void find_directions(const ParallelFor& parallel);
    void average_along(int x, int y);

    std::vector<Slopes> m_features, m_base;
    Raster m_energy, m_along_x, m_along_y, m_slope, m_base_slope, m_around;
};

Edges::Edges(const std::vector<Raster>& features, const std::vector<Raster>& base, const ParallelFor& parallel)
{
    for (std::size_t c = 0; c < features.size(); ++c) {
        m_features.push_back(slopes_of(features[c], parallel));
        m_base.push_back(slopes_of(base[c], parallel));
    }
    const int w = features[0].width, h = features[0].height;
    m_slope = m_base_slope = make_raster(w, h);
    find_directions(parallel);
    for_rows(parallel, 0, h, [&](int y) {
        for (int x = 0; x < w; ++x)
            average_along(x, y);
    });
    m_around = blurred(m_slope, kAround, parallel);
}

void Edges::find_directions(const ParallelFor& parallel)
{
    Raster xx = m_slope, yy = m_slope, xy = m_slope;
    for (const Slopes& s : m_features)
        for (std::size_t i = 0; i < xx.samples.size(); ++i) {
            xx.samples[i] += s.x.samples[i] * s.x.samples[i];
            yy.samples[i] += s.y.samples[i] * s.y.samples[i];
            xy.samples[i] += s.x.samples[i] * s.y.samples[i];
        }
    xx = blurred(xx, kTensorSigma, parallel);
    yy = blurred(yy, kTensorSigma, parallel);
    xy = blurred(xy, kTensorSigma, parallel);
    m_energy = m_along_x = m_along_y = make_raster(xx.width, xx.height);
    in_batches(parallel, xx.samples.size(), [&](std::size_t i) {
        // The directions along and across an edge are at 90 degrees, so twice their angles point in opposite
        // directions.
        const Vec2 d = half_angle(yy.samples[i] - xx.samples[i], -2.0f * xy.samples[i]);
        m_energy.samples[i] = xx.samples[i] + yy.samples[i];
        m_along_x.samples[i] = d.x;
        m_along_y.samples[i] = d.y;
    });
}

/// Averages slopes with their signs, channel by channel, so that the slopes of texture cancel.
void Edges::average_along(int x, int y)
{
    const std::size_t centre = std::size_t(y) * std::size_t(m_slope.width) + std::size_t(x);
    if (m_energy.samples[centre] < kLeastEnergy)
        return;
    static const std::array<float, kAlong> bell = [] {
        std::array<float, kAlong> weights {};
        for (int k = 0; k < kAlong; ++k)
            weights[std::size_t(k)] =
                float(elementary::exp2(-0.5 / elementary::kLn2 * k * k / double(kAlongSigma * kAlongSigma)));
        return weights;
    }();
    std::array<float, 3> sums {}, base_sums {};
    float total = 0.0f;
    for (const float sign : { -1.0f, 1.0f }) {
        Vec2 p { float(x), float(y) };
        Vec2 d { sign * m_along_x.samples[centre], sign * m_along_y.samples[centre] };
        for (int k = sign < 0.0f ? 1 : 0; k < kAlong; ++k) {
            if (k > 0) {
                p = { p.x + d.x, p.y + d.y };
                const Vec2 next = along(p);
                const float cosine = next.x * d.x + next.y * d.y;
                if (std::fabs(cosine) < kStraight)
                    break;
                d = cosine < 0.0f ? Vec2 { -next.x, -next.y } : next;
            }
            const std::size_t at = pixel_at(m_slope, p);
            const float weight = bell[std::size_t(k)], nx = -sign * d.y, ny = sign * d.x;
            total += weight;
            for (std::size_t c = 0; c < m_features.size(); ++c) {
                sums[c] += weight * (nx * m_features[c].x.samples[at] + ny * m_features[c].y.samples[at]);
                base_sums[c] += weight * (nx * m_base[c].x.samples[at] + ny * m_base[c].y.samples[at]);
            }
        }
    }
    const float scale = 1.0f / (total * std::sqrt(float(m_features.size())));
    const auto length = [](const std::array<float, 3>& v) {
        return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    };
    m_slope.samples[centre] = scale * length(sums);
    m_base_slope.samples[centre] = scale * length(base_sums);
}

/// Follows ridges of the slope, the steepest first.
class Tracer {
public:
    Tracer(const Edges& edges, const OutlineOptions& options, Drawing& drawing)
        : m_edges(edges),
          m_options(options),
          m_drawing(drawing),
          m_scale(float(elementary::exp2(2.0 * (1.0 - 2.0 * double(options.detail))))),
          m_marks(edges.slopes().samples.size(), Mark { -1, 0 })
    {
    }

    void trace();

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

    const Edges& m_edges;
    const OutlineOptions& m_options;
    Drawing& m_drawing;
    float m_scale;  ///< factor on what a line needs
    int m_line = 0;
    std::vector<Mark> m_marks;
    std::vector<std::size_t> m_walked;  ///< pixels with the mark of the line being followed
};

std::vector<std::size_t> Tracer::starts() const
{
    const Raster& slopes = m_edges.slopes();
    std::vector<std::size_t> starts;
    for (int y = 2; y < slopes.height - 2; ++y)
        for (int x = 2; x < slopes.width - 2; ++x) {
            const Vec2 p { float(x), float(y) };
            const std::size_t at = pixel_at(slopes, p);
            if (slopes.samples[at] <= 0.0f || m_edges.importance(p) < m_scale * kStart)
                continue;
            const Vec2 d = m_edges.along(p);
            if (slopes.samples[at] >= m_edges.slope({ p.x - d.y, p.y + d.x })
                && slopes.samples[at] > m_edges.slope({ p.x + d.y, p.y - d.x }))
                starts.push_back(at);
        }
    std::stable_sort(starts.begin(), starts.end(),
                     [&](std::size_t a, std::size_t b) { return slopes.samples[a] > slopes.samples[b]; });
    return starts;
}

/// Moves p towards the top of a parabola through three slopes across the ridge.
Vec2 Tracer::onto_ridge(Vec2 p, Vec2 along) const
{
    constexpr float kPull = 0.7f;  // moving all the way would make lines jump where ridges meet
    const Vec2 across { -along.y, along.x };
    const float here = m_edges.slope(p), left = m_edges.slope({ p.x - across.x, p.y - across.y }),
                right = m_edges.slope({ p.x + across.x, p.y + across.y });
    const float bend = left - 2.0f * here + right;
    const float top = bend < -1e-4f ? std::clamp(0.5f * (left - right) / bend, -0.5f, 0.5f)
        : left > right              ? -0.5f
                                    : 0.5f;
    return { p.x + kPull * top * across.x, p.y + kPull * top * across.y };
}

Tracer::Side Tracer::follow(Vec2 start, int sign)
{
    const Raster& slopes = m_edges.slopes();
    Side side;
    Vec2 p = start, d = m_edges.along(start);
    d = { float(sign) * d.x, float(sign) * d.y };
    int weak = 0;
    for (int step = 0; step < kMostSteps; ++step) {
        if (step > 0)
            p = { p.x + d.x, p.y + d.y };
        if (p.x < 1.0f || p.y < 1.0f || p.x > float(slopes.width - 2) || p.y > float(slopes.height - 2))
            break;
        p = onto_ridge(p, d);
        Mark& here = m_marks[pixel_at(slopes, p)];
        const bool closed = here.line == m_line && std::abs(here.step - sign * step) > kLoop;
        const float importance = m_edges.importance(p);
        if ((here.line >= 0 && here.line != m_line) || closed) {
            side.joined = true;
            side.points.push_back({ p.x, p.y, importance });
            break;
        }
        here = { m_line, sign * step };
        m_walked.push_back(pixel_at(slopes, p));
        weak = importance < m_scale * kGoOn ? weak + 1 : 0;
        if (weak > kGap)
            break;
        side.points.push_back({ p.x, p.y, importance });
        Vec2 next = m_edges.along(p);
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
    return sum >= m_scale * kLeastSum && float(points.size()) >= m_scale * kShortest * m_options.pen;
}

/// Marks the pixels around a line where another line would touch it.
void Tracer::keep_away(const std::vector<InkPoint>& points)
{
    constexpr int kNear = 2;
    const Raster& slopes = m_edges.slopes();
    for (const InkPoint& p : points)
        for (int y = -kNear; y <= kNear; ++y)
            for (int x = -kNear; x <= kNear; ++x) {
                Mark& mark = m_marks[pixel_at(slopes, { p.x + float(x), p.y + float(y) })];
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
        points[k].width =
            m_options.pen * m_options.weight * std::min(kThick, kThin + kRise * steep) * (kTip + (1.0f - kTip) * share);
    }
}

void Tracer::trace()
{
    for (const std::size_t start : starts()) {
        stop_point();
        if (m_marks[start].line >= 0)
            continue;
        const Index width = Index(m_edges.slopes().width);
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

void add_outlines(const std::vector<Raster>& features, const std::vector<Raster>& base, const OutlineOptions& options,
                  Drawing& drawing)
{
    const Edges edges(features, base, options.parallel);
    Tracer(edges, options, drawing).trace();
}

}  // namespace PIMG_ABI
}  // namespace pimg
