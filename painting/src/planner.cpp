// SPDX-License-Identifier: BSD-3-Clause
#include "planner.h"

#include <algorithm>
#include <cmath>

#include <pimg/detail/elementary.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// The paper gives the idea of section 5.2 but no numbers. Where nothing else is said, a number is chosen by eye.

/// A stroke is at least this many widths long, ends included, where nothing stops it, and at most that many. More of
/// the second gives longer, calmer strokes.
constexpr float kShortest = 1.0f, kLongest = 8.0f;

/// Width of an edge in a shade picture, in its pixels to either side: the reach of its kernel of five pixels.
constexpr float kEdgeWidth = 2.0f;

/// The eighth of a full turn, 45 degrees, in radians: the largest turn by jitter_angle.
constexpr float kEighth = float(elementary::kPi / 4);

/// Step along a stroke in widths, and the cosine of the sharpest turn from one step to the next, 45 degrees.
constexpr float kStep = 0.4f, kStraight = 0.7f;

/// A stroke between edges is made narrower down to this share of its width; what is finer is left to finer strokes.
constexpr float kNarrowest = 0.5f;

}  // namespace

/// Where an edge cuts into the width of a stroke, moves the stroke to its own side and makes it as narrow as necessary.
void Planner::fit_between_edges(const ShadePicture& picture, Draft& draft, Vec2 along, float least) const
{
    Vec2& centre = draft.points[kMostPoints];
    const Vec2 across { -along.y, along.x };
    const float half = 0.5f * draft.width, step = std::max(0.75f, 0.125f * draft.width);
    const float edge_width = kEdgeWidth * float(picture.shrunk());
    const auto difference_at = [&](float v) {
        return picture.distance(picture.between({ centre.x + v * across.x, centre.y + v * across.y }), draft.shade);
    };
    float free[2];
    for (int side = 0; side < 2; ++side) {
        const float sign = side ? 1.0f : -1.0f;
        float reached = 0.0f, before = 0.0f;
        while (reached < half) {
            const float next = std::min(reached + step, half), here = difference_at(sign * next);
            if (here > m_options.crossing) {
                // The edge is where half of the difference between its sides is reached.
                const float level = std::max(m_options.crossing, 0.5f * difference_at(sign * (next + edge_width)));
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
    draft.width = std::max(room, std::max(least, kNarrowest * draft.width));
    // If there is less room on one side, half of the difference shifts the stroke to the other.
    const float shift = 0.5f * (free[1] - free[0]);
    centre = { centre.x + shift * across.x, centre.y + shift * across.y };
}

/// Follows the directions from the middle to one end.
void Planner::walk(const ShadePicture& picture, Draft& draft, Vec2 along, float reach, int sign) const
{
    const float wanted = std::max(1.0f, kStep * draft.width);
    const int steps = std::min(kMostPoints, int(std::ceil(reach / wanted)));
    if (steps <= 0)
        return;
    const float step = reach / float(steps), tip = 0.5f * draft.width;
    const auto is_same_shade = [&](Vec2 p) {
        return picture.distance(picture.at(p), draft.shade) <= m_options.crossing;
    };
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
        if (!is_same_shade(q) || !is_same_shade({ q.x + tip * turn.x, q.y + tip * turn.y }) || q.x < 0.0f || q.y < 0.0f
            || q.x > float(m_field.width() - 1) || q.y > float(m_field.height() - 1))
            break;
        p = q;
        d = turn;
        draft.points[sign > 0 ? ++draft.last : --draft.first] = p;
    }
}

Draft Planner::draft(const Site& site, float length) const
{
    const ShadePicture& picture = m_pictures.for_width(site.width);
    Draft draft;
    draft.variation = site.variation;
    const float resized = site.width * (1.0f + m_options.jitter_size * signed_unit(scramble(site.variation + 1)));
    draft.width = std::clamp(resized, site.narrowest, site.widest);
    draft.points[kMostPoints] = site.place;
    draft.shade = picture.between(site.place);
    fit_between_edges(picture, draft, m_field.at(site.place), site.narrowest);

    const Vec2 centre = draft.points[kMostPoints];
    Vec2 along = m_field.at(centre);
    const float turn = kEighth * m_options.jitter_angle * signed_unit(scramble(draft.variation + 2));
    const auto [sine, cosine] = elementary::sine_cosine(double(turn));
    const float c = float(cosine), s = float(sine);
    along = { c * along.x - s * along.y, s * along.x + c * along.y };
    draft.shade = picture.between(centre);
    length = std::clamp(length, kShortest * draft.width, std::max(1.0f, m_options.length) * kLongest * draft.width);
    walk(picture, draft, along, 0.5f * (length - draft.width), -1);
    walk(picture, draft, along, 0.5f * (length - draft.width), +1);
    if (draft.size() == 1)
        draft.points[++draft.last] = { centre.x + 0.25f * along.x, centre.y + 0.25f * along.y };
    return draft;
}

}  // namespace PIMG_ABI
}  // namespace pimg
