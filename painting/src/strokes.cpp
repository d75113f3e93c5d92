// SPDX-License-Identifier: BSD-3-Clause
// Plans a painting: dabs in coarse-to-fine order are bent along the edges, fitted between them, and kept when they
// bring the canvas closer to the picture.
#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>
#include <pimg/strokes.h>

#include <algorithm>
#include <cmath>

#include "sketch.h"

namespace pimg {

namespace {

// The paper gives the idea of section 5.2 but no numbers. Where nothing else is said, a number is chosen by eye.

/// Points of a stroke to either side of its middle: at a step of 0.4 widths enough for 19 widths of length.
constexpr int kMostPoints = 24;

/// A stroke is at least this many widths long, ends included, where nothing stops it, and at most that many. More of
/// the second gives longer, calmer strokes.
constexpr float kShortest = 2.0f, kLongest = 8.0f;

/// How wrong a cell without paint counts as, in 8-bit steps: more than a shade usually differs from the picture, so
/// that bare canvas is covered first, but less than black differs from white, so that a stroke of a quite wrong colour
/// is not put there.
constexpr float kBare = 64.0f;

/// Width of an edge in the smoothed picture, in pixels to either side: the reach of its kernel of five pixels.
constexpr float kEdgeWidth = 2.0f;

/// The eighth of a full turn, 45 degrees, in radians: the largest turn by jitter_angle.
constexpr float kEighth = float(elementary::kPi / 4);

/// Distance of places, in widths. Measured: at 0.33 and 0.8 as much paint spills on the astronaut and more
/// on the rocket (docs/internals.md).
constexpr float kPitch = 0.5f;

/// Largest random shift of a place, as a share of the distance of places. With more there is less of a grid, but more
/// gaps.
constexpr float kScatter = 0.3f;

/// A stroke goes to the fixed place if the picture there differs by less than this share of `crossing`; else to the
/// place of its piece. Chosen by eye. Taking the fixed place always makes hardly any difference (docs/internals.md).
constexpr float kAlikePlace = 0.4f;

/// Step along a stroke in widths, and the cosine of the sharpest turn from one step to the next, 45 degrees.
constexpr float kStep = 0.4f, kStraight = 0.7f;

/// Cell of the sketch in least widths: 2 pixels at the default least width of 3, which halved the time of planning.
constexpr float kCell = 0.67f;

/// Length, in widths, of a stroke that fills a gap.
constexpr float kGapLength = 3.0f;

/// A stroke being drawn.
struct Draft {
    Vec2 points[2 * kMostPoints + 1];
    int first = kMostPoints, last = kMostPoints;  ///< of `points`, both in use
    float width = 0.0f;
    Shade shade {};
    std::uint32_t variation = 0;

    const Vec2* begin() const { return points + first; }
    int size() const { return last - first + 1; }
};

class Planner {
public:
    Planner(const ShadePicture& picture, const DirectionField& field, const StrokeOptions& options)
        : m_picture(picture),
          m_field(field),
          m_options(options)
    {
    }

    /// A stroke of about that width and length.
    Draft draft(Vec2 place, float width, float length, std::uint32_t variation) const;

private:
    void fit_between_edges(Draft& draft, Vec2 along, float min) const;
    void walk(Draft& draft, Vec2 along, float reach, int sign) const;
    bool is_same_shade(Vec2 p, const Shade& shade) const
    {
        return m_picture.distance(m_picture.at(p), shade) <= m_options.crossing;
    }

    const ShadePicture& m_picture;
    const DirectionField& m_field;
    const StrokeOptions& m_options;
};

/// Where an edge cuts into the width of a stroke, moves the stroke to its own side and makes it as narrow as necessary.
void Planner::fit_between_edges(Draft& draft, Vec2 along, float min) const
{
    Vec2& centre = draft.points[kMostPoints];
    const Vec2 across { -along.y, along.x };
    const float half = 0.5f * draft.width, step = std::max(0.75f, 0.125f * draft.width);
    const auto difference_at = [&](float v) {
        return m_picture.distance(m_picture.between({ centre.x + v * across.x, centre.y + v * across.y }), draft.shade);
    };
    float free[2];
    for (int side = 0; side < 2; ++side) {
        const float sign = side ? 1.0f : -1.0f;
        float reached = 0.0f, before = 0.0f;
        while (reached < half) {
            const float next = std::min(reached + step, half), here = difference_at(sign * next);
            if (here > m_options.crossing) {
                // The edge is where half of the difference between its sides is reached.
                const float level = std::max(m_options.crossing, 0.5f * difference_at(sign * (next + kEdgeWidth)));
                reached += step * std::min(1.0f, (level - before) / std::max(here - before, 1e-3f));
                break;
            }
            reached = next;
            before = here;
        }
        free[side] = std::min(reached, half);
    }
    const float room = free[0] + free[1];
    if (room >= draft.width)
        return;
    draft.width = std::max(room, min);
    // If there is less room on one side, half of the difference shifts the stroke to the other.
    const float shift = 0.5f * (free[1] - free[0]);
    centre = { centre.x + shift * across.x, centre.y + shift * across.y };
}

/// Follows the directions from the middle to one end.
void Planner::walk(Draft& draft, Vec2 along, float reach, int sign) const
{
    const float wanted = std::max(1.0f, kStep * draft.width);
    const int steps = std::min(kMostPoints, int(std::ceil(reach / wanted)));
    if (steps == 0)
        return;
    const float step = reach / float(steps), tip = 0.5f * draft.width;
    Vec2 p = draft.points[kMostPoints], d { float(sign) * along.x, float(sign) * along.y };
    for (int i = 0; i < steps; ++i) {
        Vec2 turn = m_field.at({ p.x + 0.5f * step * d.x, p.y + 0.5f * step * d.y });
        float cosine = turn.x * d.x + turn.y * d.y;
        if (cosine < 0.0f) {
            turn = { -turn.x, -turn.y };
            cosine = -cosine;
        }
        if (i == 0)
            turn = d;  // a stroke that chance has turned starts in that direction
        else if (cosine < kStraight)
            break;
        const Vec2 q { p.x + step * turn.x, p.y + step * turn.y };
        if (!is_same_shade(q, draft.shade) || !is_same_shade({ q.x + tip * turn.x, q.y + tip * turn.y }, draft.shade)
            || q.x < 0.0f || q.y < 0.0f || q.x > float(m_picture.width() - 1) || q.y > float(m_picture.height() - 1))
            break;
        p = q;
        d = turn;
        draft.points[sign > 0 ? ++draft.last : --draft.first] = p;
    }
}

Draft Planner::draft(Vec2 place, float width, float length, std::uint32_t variation) const
{
    Draft draft;
    draft.variation = variation;
    const float scale = m_options.scale(place, m_picture.width(), m_picture.height());
    const float min = m_options.min * scale, max = m_options.max * scale;
    const float resized = width * (1.0f + m_options.jitter_size * signed_unit(scramble(draft.variation + 1)));
    draft.width = std::clamp(resized, min, max);
    draft.points[kMostPoints] = place;
    draft.shade = m_picture.at(place);
    fit_between_edges(draft, m_field.at(place), min);

    const Vec2 centre = draft.points[kMostPoints];
    Vec2 along = m_field.at(centre);
    const float turn = kEighth * m_options.jitter_angle * signed_unit(scramble(draft.variation + 2));
    const auto [sine, cosine] = elementary::sine_cosine(double(turn));
    const float c = float(cosine), s = float(sine);
    along = { c * along.x - s * along.y, s * along.x + c * along.y };
    draft.shade = m_picture.at(centre);
    length = std::clamp(m_options.length * length, kShortest * draft.width,
                        std::max(1.0f, m_options.length) * kLongest * draft.width);
    walk(draft, along, 0.5f * (length - draft.width), -1);
    walk(draft, along, 0.5f * (length - draft.width), +1);
    if (draft.size() == 1)
        draft.points[++draft.last] = { centre.x + 0.25f * along.x, centre.y + 0.25f * along.y };
    return draft;
}

/// A place that may have a stroke of one size. Sizes of brushes are half an octave apart, and there is one stroke of a
/// size to a place. So the next frame of a film, whose noise makes another mesh, finds most strokes where they were.
struct Site {
    std::uint64_t key;  ///< size, large first, then chance: the order of painting
    Index dab;
    float width;
    Vec2 centre;
};

Site site_of(const Dab& dab, Index index, const ShadePicture& picture, const StrokeOptions& options)
{
    const float scale = options.scale(dab.centre, picture.width(), picture.height());
    const float min = options.min * scale, max = options.max * scale;
    const int size = int(std::lround(2.0 * elementary::log2(double(dab.width / min))));
    Site site { 0, index, std::clamp(min * float(elementary::exp2(0.5 * size)), min, max), dab.centre };
    const float pitch = kPitch * site.width;
    const int x = int(std::lround(dab.centre.x / pitch)), y = int(std::lround(dab.centre.y / pitch));
    const std::uint32_t chance = scramble(
        std::uint32_t(x) + scramble(std::uint32_t(y) + scramble(std::uint32_t(size) + scramble(options.seed))));
    const Vec2 place { pitch * (float(x) + kScatter * signed_unit(scramble(chance + 4))),
                       pitch * (float(y) + kScatter * signed_unit(scramble(chance + 5))) };
    // Next to an edge the place of the piece is better, because it comes from the mesh.
    if (picture.distance(picture.at(place), picture.at(dab.centre)) < kAlikePlace * options.crossing)
        site.centre = place;
    const int bin = std::clamp(int(4.0 * (20.0 - elementary::log2(double(site.width)))), 0, 255);
    site.key = (std::uint64_t(bin) << 32) + chance;
    return site;
}

/// The sites of all dabs in the order of painting.
std::vector<Site> sites_in_order(const std::vector<Dab>& dabs, const ShadePicture& picture,
                                 const StrokeOptions& options)
{
    std::vector<Site> sites;
    sites.reserve(dabs.size());
    for (Index i = 0; i < Index(dabs.size()); ++i) {
        stop_point();
        sites.push_back(site_of(dabs[i], i, picture, options));
    }
    std::sort(sites.begin(), sites.end(),
              [](const Site& a, const Site& b) { return a.key != b.key ? a.key < b.key : a.dab < b.dab; });
    return sites;
}

void append(const Draft& draft, Index vertex, Level level, Strokes& strokes)
{
    strokes.strokes.push_back(
        { Index(strokes.points.size()), Index(draft.size()), draft.width, vertex, level, draft.variation });
    strokes.points.insert(strokes.points.end(), draft.begin(), draft.begin() + draft.size());
}

}  // namespace

Status plan_strokes(const Hierarchy& hierarchy, const ChannelsView& guides, const DirectionField& field,
                    const StrokeOptions& options, Strokes& strokes)
{
    std::vector<Dab> dabs;
    const Status status = collect_dabs(hierarchy, field, options, dabs);
    if (!status)
        return status;
    const ShadePicture picture(guides, options.parallel);
    Sketch sketch(picture, std::max(1, int(kCell * options.min + 0.5f)));
    const Planner planner(picture, field, options);

    Strokes laid;
    for (const Site& site : sites_in_order(dabs, picture, options)) {
        stop_point();
        const Draft draft = planner.draft(site.centre, site.width, dabs[site.dab].length, std::uint32_t(site.key));
        const float gain = sketch.gain(draft.begin(), draft.size(), draft.width, draft.shade, kBare);
        if (options.tolerance > 0.0f && gain < options.tolerance)
            continue;
        sketch.put(draft.begin(), draft.size(), draft.width, draft.shade);
        append(draft, dabs[site.dab].vertex, dabs[site.dab].level, laid);
    }

    // Canvas that is still bare is covered by strokes below all others, which show in the gaps only.
    strokes = {};
    strokes.width = guides.width;
    strokes.height = guides.height;
    const float width = std::min(options.max, 2.0f * options.min);
    for (Vec2 place : sketch.bare_cells()) {
        stop_point();
        if (sketch.is_covered(place))
            continue;
        const Draft draft = planner.draft(place, width, kGapLength * width, scramble(Index(strokes.strokes.size())));
        sketch.put_below(draft.begin(), draft.size(), draft.width, draft.shade);
        append(draft, kGhost, 0, strokes);
    }
    const Index shift = Index(strokes.points.size());
    for (Stroke s : laid.strokes) {
        s.first += shift;
        strokes.strokes.push_back(s);
    }
    strokes.points.insert(strokes.points.end(), laid.points.begin(), laid.points.end());
    return {};
}

std::vector<std::vector<float>> stroke_colours(const Strokes& strokes, const ChannelsView& picture,
                                               const ChannelsView& guides, const ParallelFor& parallel)
{
    constexpr std::size_t kBlock = 1024;
    // In steps of an 8-bit picture: colours that differ less count as the same paint. By eye; more makes colours
    // duller.
    constexpr float kAlike = 16.0f;
    const std::size_t n = strokes.strokes.size();
    std::vector<std::vector<float>> colours(picture.channels.size(), std::vector<float>(n));
    const auto pixel = [&](Vec2 p) {
        const int x = std::clamp(int(p.x + 0.5f), 0, picture.width - 1);
        const int y = std::clamp(int(p.y + 0.5f), 0, picture.height - 1);
        return std::size_t(y) * std::size_t(picture.width) + std::size_t(x);
    };
    run(parallel, (n + kBlock - 1) / kBlock, [&](std::size_t block) {
        std::vector<double> sums(picture.channels.size());
        for (std::size_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i) {
            const Stroke& stroke = strokes.strokes[i];
            const Vec2* points = strokes.begin(stroke);
            const std::size_t centre = pixel(points[stroke.count / 2]);
            std::fill(sums.begin(), sums.end(), 0.0);
            double total = 0.0;
            for (Index k = 0; k < stroke.count; ++k) {
                const Vec2 p = points[k], next = points[k + 1 < stroke.count ? k + 1 : k - 1];
                const float dx = next.x - p.x, dy = next.y - p.y;
                const float side = 0.25f * stroke.width / std::max(std::sqrt(dx * dx + dy * dy), 1e-6f);
                for (int j = -1; j <= 1; ++j) {
                    const std::size_t at = pixel({ p.x - float(j) * side * dy, p.y + float(j) * side * dx });
                    float off = 0.0f;
                    for (const float* guide : guides.channels)
                        off += (guide[at] - guide[centre]) * (guide[at] - guide[centre]);
                    const double weight = 1.0 / (1.0 + double(off / (kAlike * kAlike)));
                    total += weight;
                    for (std::size_t c = 0; c < sums.size(); ++c)
                        sums[c] += weight * double(picture.channels[c][at]);
                }
            }
            for (std::size_t c = 0; c < sums.size(); ++c)
                colours[c][i] = float(sums[c] / total);
        }
    });
    return colours;
}

}  // namespace pimg
