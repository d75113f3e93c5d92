// SPDX-License-Identifier: BSD-3-Clause
// A line of width w in tone d claims a band of w/d to either side, fading outwards like a tent: lines at that
// distance add up to an even tone. A new line is drawn where less than a share of the tone is claimed yet.
#include <pimg/detail/elementary.h>
#include <pimg/ink.h>

#include <algorithm>
#include <cmath>

namespace pimg {

namespace {

// The paper shows pen and ink (section 7) but names no numbers. Those below are chosen by eye; after each stands what
// more of it does. Darkness is 0 (paper) to 1 (black).
constexpr float kLightest = 0.04f;     ///< darkness that is left white; more: larger white areas
constexpr float kOneWay = 0.5f;        ///< darkness up to which one direction does; more: crossing starts later
constexpr float kDarkest = 0.9f;       ///< most of one direction, which leaves a little paper; more: solid black
constexpr float kBlackest = 0.97f;     ///< most of two crossing directions; more: solid black
constexpr float kLeftToCross = 0.25f;  ///< least darkness the second direction adds where both are; more: even crossing
constexpr float kFree = 0.35f;         ///< share of the tone claimed where a line may still start; more: denser lines
constexpr float kNear = 0.6f;          ///< ... and where a line that started elsewhere ends; more: longer lines
constexpr float kToneChange = 0.30f;   ///< change of darkness along a line at which it ends; more: lines cross shadows
constexpr double kTone = 1.6;          ///< exponent of the darkness; more: light tones are left to the paper
constexpr float kLeastEdge = 0.04f;    ///< slope, in darkness per pixel, that is no edge yet; more: fewer outlines
constexpr float kOutline = 4.0f;       ///< darkness an edge adds per unit of slope above it; more: heavier outlines
constexpr float kStraight = 0.7f;      ///< cosine of the sharpest turn between two points of a line, 45 degrees
constexpr float kPerPiece = 2.0f;      ///< length of a line in lengths of its piece; more: longer lines
constexpr float kShortest = 10.0f, kLongest = 48.0f;  ///< length of a line in pixels before the option `length`
constexpr float kFinest = 1.0f, kCoarsest = 24.0f;    ///< widths in pixels of the pieces at which lines start

/// Points of a line to one side of its start at most; lines too long for steps of 1.5 pixels have longer steps.
constexpr int kMostSteps = 24;

struct Tones {
    int width, height;
    std::vector<float> wanted, claimed;

    std::size_t at(Vec2 p) const
    {
        const int x = std::clamp(int(p.x + 0.5f), 0, width - 1), y = std::clamp(int(p.y + 0.5f), 0, height - 1);
        return std::size_t(y) * std::size_t(width) + std::size_t(x);
    }
};

/// One direction of hatching: along the field or across it.
class Hatch {
public:
    Hatch(const DirectionField& field, const PenOptions& options, Tones tones, bool across)
        : m_field(field),
          m_options(options),
          m_tones(std::move(tones)),
          m_across(across)
    {
    }

    void draw(const Dab& dab, Strokes& lines);

private:
    Vec2 direction(Vec2 p) const
    {
        const Vec2 d = m_field.at(p);
        return m_across ? Vec2 { -d.y, d.x } : d;
    }
    int walk(Vec2 start, float sign, float reach, Vec2* points) const;
    void claim(Vec2 from, Vec2 to);

    const DirectionField& m_field;
    const PenOptions& m_options;
    Tones m_tones;
    bool m_across;
};

/// Points after `start`; returns their number.
int Hatch::walk(Vec2 start, float sign, float reach, Vec2* points) const
{
    const float tone = m_tones.wanted[m_tones.at(start)], step = std::max(1.5f, reach / kMostSteps);
    Vec2 d = direction(start), p = start;
    d = { sign * d.x, sign * d.y };
    int count = 0;
    for (float done = step; done <= reach && count < kMostSteps; done += step) {
        Vec2 next = direction({ p.x + 0.5f * step * d.x, p.y + 0.5f * step * d.y });
        const float cosine = next.x * d.x + next.y * d.y;
        if (std::fabs(cosine) < kStraight)
            break;
        d = cosine < 0.0f ? Vec2 { -next.x, -next.y } : next;
        p = { p.x + step * d.x, p.y + step * d.y };
        const std::size_t at = m_tones.at(p);
        if (p.x < 0.0f || p.y < 0.0f || p.x > float(m_tones.width - 1) || p.y > float(m_tones.height - 1)
            || m_tones.wanted[at] < kLightest || std::fabs(m_tones.wanted[at] - tone) > kToneChange
            || m_tones.claimed[at] > kNear * m_tones.wanted[at])
            break;
        points[count++] = p;
    }
    return count;
}

void Hatch::claim(Vec2 from, Vec2 to)
{
    const Vec2 middle { 0.5f * (from.x + to.x), 0.5f * (from.y + to.y) };
    const float dx = to.x - from.x, dy = to.y - from.y, length = std::sqrt(dx * dx + dy * dy);
    if (length <= 0.0f)
        return;
    const float tone = std::max(m_tones.wanted[m_tones.at(middle)], kLightest);
    const float reach = m_options.width / tone, nx = -dy / length, ny = dx / length;
    const int x0 = std::max(0, int(std::min(from.x, to.x) - reach)),
              y0 = std::max(0, int(std::min(from.y, to.y) - reach));
    const int x1 = std::min(m_tones.width - 1, int(std::max(from.x, to.x) + reach) + 1);
    const int y1 = std::min(m_tones.height - 1, int(std::max(from.y, to.y) + reach) + 1);
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const float px = float(x) - from.x, py = float(y) - from.y;
            const float along = (px * dx + py * dy) / (length * length), off = std::fabs(px * nx + py * ny);
            // Half open, so that successive segments do not claim a place twice.
            if (along < 0.0f || along >= 1.0f || off >= reach)
                continue;
            m_tones.claimed[std::size_t(y) * std::size_t(m_tones.width) + std::size_t(x)] +=
                tone * (1.0f - off / reach);
        }
}

void Hatch::draw(const Dab& dab, Strokes& lines)
{
    const std::size_t at = m_tones.at(dab.centre);
    if (m_tones.wanted[at] < kLightest || m_tones.claimed[at] > kFree * m_tones.wanted[at])
        return;
    const float reach = 0.5f * m_options.length * std::clamp(kPerPiece * dab.length, kShortest, kLongest);
    Vec2 back[kMostSteps], forth[kMostSteps];
    const int before = walk(dab.centre, -1.0f, reach, back), after = walk(dab.centre, 1.0f, reach, forth);
    if (before + after < 2)
        return;
    Stroke line { Index(lines.points.size()),
                  Index(before + after + 1),
                  m_options.width,
                  dab.vertex,
                  dab.level,
                  scramble(dab.vertex + scramble(m_options.seed)) };
    for (int i = before; i-- > 0;)
        lines.points.push_back(back[i]);
    lines.points.push_back(dab.centre);
    lines.points.insert(lines.points.end(), forth, forth + after);
    const Vec2* p = lines.points.data() + line.first;
    for (Index i = 0; i + 1 < line.count; ++i)
        claim(p[i], p[i + 1]);
    lines.strokes.push_back(line);
}

/// Darkness with the edges' outlines added.
std::vector<float> with_outlines(const float* darkness, int width, int height, const PenOptions& options)
{
    std::vector<float> wanted(std::size_t(width) * std::size_t(height));
    const auto clean = [&](int x, int y) {
        const float d = darkness[std::size_t(std::clamp(y, 0, height - 1)) * std::size_t(width)
                                 + std::size_t(std::clamp(x, 0, width - 1))];
        return d > 0.0f ? std::min(d, 1.0f) : 0.0f;
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float gx = 0.5f * (clean(x + 1, y) - clean(x - 1, y)),
                        gy = 0.5f * (clean(x, y + 1) - clean(x, y - 1));
            const float edge = std::max(0.0f, std::sqrt(gx * gx + gy * gy) - kLeastEdge);
            wanted[std::size_t(y) * std::size_t(width) + std::size_t(x)] =
                std::min(1.0f,
                         options.density * float(elementary::power(double(clean(x, y)), kTone))
                             + kOutline * options.outline * edge);
        }
    return wanted;
}

}  // namespace

Status plan_ink(const Hierarchy& hierarchy, const float* darkness, const DirectionField& field,
                const PenOptions& options, Strokes& lines)
{
    const int width = field.width(), height = field.height();
    lines = {};
    lines.width = width;
    lines.height = height;
    DabOptions range;
    range.min = kFinest;
    range.max = kCoarsest;
    std::vector<Dab> dabs;
    const Status status = collect_dabs(hierarchy, field, range, dabs);
    if (!status)
        return status;
    std::stable_sort(dabs.begin(), dabs.end(), [](const Dab& a, const Dab& b) { return a.width > b.width; });

    Tones along { width, height, with_outlines(darkness, width, height, options), {} };
    along.claimed.resize(along.wanted.size());
    Tones across = along;
    for (std::size_t i = 0; i < along.wanted.size(); ++i) {
        // Two layers leave (1 - a) (1 - b) of the paper.
        const float total = std::min(along.wanted[i], options.cross ? kBlackest : kDarkest);
        along.wanted[i] = options.cross ? std::min(total, std::max(kOneWay, total - kLeftToCross)) : total;
        across.wanted[i] = std::min(kDarkest, 1.0f - (1.0f - total) / (1.0f - along.wanted[i]));
    }
    Hatch first(field, options, std::move(along), false), second(field, options, std::move(across), true);
    for (const Dab& dab : dabs)
        first.draw(dab, lines);
    if (options.cross)
        for (const Dab& dab : dabs)
            second.draw(dab, lines);
    return {};
}

}  // namespace pimg
