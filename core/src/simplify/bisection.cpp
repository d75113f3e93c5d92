// SPDX-License-Identifier: BSD-3-Clause
#include "simplify/bisection.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>

#include "sampling/guide_jump.h"
#include "simplify/collapse_cost.h"
#include "simplify/key_sort.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr std::size_t kRemovedBetweenStops = 1 << 14;  ///< at a tenth of a microsecond each

/// Pixels between vertices that no bisection makes.
constexpr int kSide = 64;

constexpr int kDx[] = { 1, 1, 0, -1, -1, -1, 0, 1 }, kDy[] = { 0, 1, 1, 1, 0, -1, -1, -1 };

/// Direction number `k` of the eight, which may be up to 16.
int turned(int k)
{
    return k & (Bisection::kDirections - 1);
}

/// Mid-points of bisection at `step` pixels: those of edges along rows and columns, and centres of squares.
int step_of(int x, int y)
{
    return (x | y) & -(x | y);
}

/// Whether the diagonal of the square with the upper left corner (x, y) and that side falls to the right.
bool falls(int x, int y, int side)
{
    return (x / side + y / side) % 2 == 0;
}

/// A cost rounded up to four steps an octave. Vertices of equal cost are removed as they lie in memory, which saves most of
/// the time that one after the other in exact order would take. What overflowed is infinite.
float rounded_up(float cost)
{
    constexpr std::uint32_t kBelowStep = (1u << 21) - 1;
    if (!(cost < kInfinity))
        return kInfinity;
    std::uint32_t bits;
    std::memcpy(&bits, &cost, sizeof bits);
    bits = (bits + kBelowStep) & ~kBelowStep;
    std::memcpy(&cost, &bits, sizeof bits);
    return cost;
}

/// What collapsing u -> t costs: the squares of six times the volumes between the surface before and after it, as in
/// collapse_cost.h, and the same floor. `area` is twice that of each of the four triangles.
float removal_cost(const Guide& guide, Index u, Index t, Index b, float area, float squared_length)
{
    float squared = 0.0f;
    for (const GuideChannel& c : guide.channels) {
        const float d = c.samples[u] - 0.5f * (c.samples[t] + c.samples[b]);
        squared += c.weight * d * d;
    }
    return rounded_up(8.0f * area * area * squared + kCostFloor * 4.0f * area * squared_length);
}

}  // namespace

Bisection::Bisection(const Guide& guide, const BisectionLimits& limits, const ParallelFor& parallel,
                     CollapseSequence& sequence)
    : m_width(guide.width),
      m_height(guide.height),
      m_more_channels(guide.channels.size() - 1)
{
    for (std::size_t k = 0; k < kDirections; ++k)
        m_offset[k] = kDx[k] + std::int64_t(kDy[k]) * m_width;
    find_costs(guide, parallel);
    const std::vector<Index> removed = choose(limits, parallel);
    m_left = Index(m_costs.size() - removed.size());
    lay_out(guide, parallel);

    const std::size_t first = sequence.records.size();
    sequence.records.extend(removed.size());
    sequence.more.extend(removed.size() * m_more_channels);
    // What a removal reads is all over memory, so it is fetched some removals ahead.
    constexpr std::size_t kAhead = 16;
    std::array<Removal, kAhead> next;
    for (std::size_t i = 0; i < removed.size() + kAhead; ++i) {
        if (i % kRemovedBetweenStops == 0)
            stop_point();
        if (i >= kAhead)
            sequence.records.set(
                first + i - kAhead,
                remove(next[i % kAhead], sequence.more.data() + (first + i - kAhead) * m_more_channels));
        if (i < removed.size())
            prefetch(next[i % kAhead] = removal_of(removed[i]));
    }
}

void Bisection::prefetch(const Removal& r) const
{
    for (const Index p : { r.t, r.u, r.b })
        __builtin_prefetch(m_spots.data() + p);
    __builtin_prefetch(m_costs.data() + r.u);
}

/// From fine to coarse: a vertex needs the costs of those that halve its triangles.
void Bisection::find_costs(const Guide& guide, const ParallelFor& parallel)
{
    m_costs.extend(std::size_t(m_width) * std::size_t(m_height));
    for (int step = 1; step < kSide; step *= 2) {
        const auto rows = [&](int first, int apart, const auto& body) {
            const int count = first < m_height ? (m_height - 1 - first) / apart + 1 : 0;
            for_rows(parallel, 0, count, [&](int i) { body(first + i * apart); });
        };
        rows(0, step, [&](int y) { find_costs_of_edges(guide, step, y); });
        rows(step, 2 * step, [&](int y) { find_costs_of_centres(guide, step, y); });
    }
    for (int y = 0; y < m_height; y += kSide)
        for (int x = 0; x < m_width; x += kSide)
            m_costs[pixel(x, y)] = kInfinity;
}

/// The vertices of row y that halve edges along rows and columns.
void Bisection::find_costs_of_edges(const Guide& guide, int step, int y)
{
    const int half = step / 2;
    const bool is_along_row = y / step % 2 == 0;
    for (int x = is_along_row ? step : 0; x < m_width; x += 2 * step) {
        const Index u = pixel(x, y);
        const int dx = is_along_row ? step : 0, dy = is_along_row ? 0 : step;
        float& cost = m_costs[u];
        cost = kInfinity;
        if (!is_inside(x + dx, y + dy))
            continue;
        float least = removal_cost(guide, u, pixel(x - dx, y - dy), pixel(x + dx, y + dy), float(step * step),
                                   float(step * step));
        // The triangles on both sides of the edge; on the picture's sides there is one.
        for (int side : { -half, half }) {
            const int across = is_along_row ? y + side : x + side;
            if (half == 0 || across < 0 || across == (is_along_row ? m_height : m_width) - 1 + half)
                continue;
            for (int along : { -half, half }) {
                const int cx = is_along_row ? x + along : across, cy = is_along_row ? across : y + along;
                least = std::max(least, is_inside(cx, cy) ? m_costs[pixel(cx, cy)] : kInfinity);
            }
        }
        cost = least;
    }
}

/// The vertices of row y that halve diagonals.
void Bisection::find_costs_of_centres(const Guide& guide, int step, int y)
{
    for (int x = step; x < m_width; x += 2 * step) {
        const Index u = pixel(x, y);
        m_costs[u] = kInfinity;
        if (!is_inside(x + step, y + step))
            continue;
        const int dy = falls(x - step, y - step, 2 * step) ? step : -step;
        float least = removal_cost(guide, u, pixel(x - step, y - dy), pixel(x + step, y + dy), float(2 * step * step),
                                   float(2 * step * step));
        for (const Index below : { pixel(x - step, y), pixel(x + step, y), pixel(x, y - step), pixel(x, y + step) })
            least = std::max(least, m_costs[below]);
        m_costs[u] = least;
    }
}

/// The vertices to be removed, in the order in which that can be done: by cost, and fine before coarse where costs are
/// equal. Sets the limit.
std::vector<Index> Bisection::choose(const BisectionLimits& limits, const ParallelFor& parallel)
{
    FlatArray<KeyedIndex> items;
    items.reserve(m_costs.size());
    const auto take = [&](int x, int y) {
        if (const float cost = m_costs[pixel(x, y)]; cost <= limits.cost)
            items.push_back({ cost, pixel(x, y) });
    };
    for (int step = 1; step < kSide; step *= 2) {
        for (int y = 0; y < m_height; y += step)
            for (int x = y / step % 2 == 0 ? step : 0; x < m_width; x += 2 * step)
                take(x, y);
        for (int y = step; y < m_height; y += 2 * step)
            for (int x = step; x < m_width; x += 2 * step)
                take(x, y);
    }
    std::vector<Index> chosen = sorted(std::move(items), parallel);
    const std::size_t most = std::size_t(limits.share * double(m_costs.size()));
    if (chosen.size() > most) {
        // All of one cost are removed or none, so that the limit tells them apart.
        const auto cost = [&](std::size_t i) {
            return m_costs[chosen[i]];
        };
        std::size_t n = most;
        while (n > 0 && cost(n - 1) == cost(most))
            --n;
        chosen.resize(n);
    }
    m_limit = chosen.empty() ? -1.0f : m_costs[chosen.back()];
    return chosen;
}

/// The mesh of all pixels. Quads that stay as they are have the diagonal that fits the guide.
void Bisection::lay_out(const Guide& guide, const ParallelFor& parallel)
{
    m_spots.extend(m_costs.size());
    m_more.resize(m_costs.size() * m_more_channels);
    for_rows(parallel, 0, m_height, [&](int y) {
        const std::vector<Diagonal> above = diagonals(guide, y - 1), below = diagonals(guide, y);
        for (int x = 0; x < m_width; ++x) {
            const Index p = pixel(x, y);
            Spot& spot = m_spots[p];
            spot = { {}, guide.channels[0].samples[p], 0.0f, 0.0f };
            for (int k = 0; k < kDirections; k += 2)
                spot.reach[std::size_t(k)] = is_inside(x + kDx[k], y + kDy[k]);
            const std::size_t left = std::size_t(x), right = left + 1;
            const auto add = [&](std::size_t direction, Diagonal of_quad, Diagonal that_meets) {
                spot.reach[direction] = of_quad == that_meets;
                spot.area += of_quad == Diagonal::none ? 0.0f : of_quad == that_meets ? 2.0f : 1.0f;
            };
            add(1, below[right], Diagonal::falling);
            add(3, below[left], Diagonal::rising);
            add(5, above[left], Diagonal::falling);
            add(7, above[right], Diagonal::rising);
            for (std::size_t c = 0; c < m_more_channels; ++c)
                m_more[p * m_more_channels + c] = guide.channels[c + 1].samples[p];
        }
    });
}

/// Those of the quads below row y, from the one left of the picture to the one right of it, which are none.
std::vector<Bisection::Diagonal> Bisection::diagonals(const Guide& guide, int y) const
{
    std::vector<Diagonal> row(std::size_t(m_width) + 1, Diagonal::none);
    for (int x = 0; y >= 0 && y + 1 < m_height && x + 1 < m_width; ++x) {
        const bool falling = falls(x, y, 1);
        const bool stays = falling ? is_left(pixel(x + 1, y)) && is_left(pixel(x, y + 1))
                                   : is_left(pixel(x, y)) && is_left(pixel(x + 1, y + 1));
        row[std::size_t(x) + 1] =
            (stays ? is_falling(guide, pixel(x, y)) : falling) ? Diagonal::falling : Diagonal::rising;
    }
    return row;
}

/// t is the end whose pixel comes first, as in files, so that what is read back has the same stencils.
Bisection::Removal Bisection::removal_of(Index u) const
{
    const int x = int(u % Index(m_width)), y = int(u / Index(m_width)), step = step_of(x, y);
    const bool is_centre = (x & step) && (y & step);
    const int direction = is_centre ? falls(x - step, y - step, 2 * step) ? 1 : 3 : x & step ? 0 : 2;
    const std::int64_t offset = step * m_offset[std::size_t(direction)];
    const Point of_u { x * kSubpixels, y * kSubpixels };
    const Point of_t { (x - kDx[direction] * step) * kSubpixels, (y - kDy[direction] * step) * kSubpixels };
    return {
        Index(u - offset), u, Index(u + offset), of_t, of_u, direction, float(is_centre ? 2 * step * step : step * step)
    };
}

bool Bisection::leads_outside(Index pixel, int direction) const
{
    const int x = int(pixel % Index(m_width)), y = int(pixel / Index(m_width));
    return !is_inside(x + kDx[direction], y + kDy[direction]);
}

/// The vertex at the other end of an edge, or the ghost.
Index Bisection::neighbour(Index pixel, int direction) const
{
    const int reach = m_spots[pixel].reach[std::size_t(direction)];
    return reach == 0 ? kGhost : Index(pixel + (Index(m_offset[std::size_t(direction)]) << (reach - 1)));
}

/// The neighbours in `count` directions from `first` on, the ghost once.
int Bisection::ring_from(Index pixel, int first, int count, Index* ring) const
{
    int n = 0;
    bool has_ghost = false;
    for (int k = first; k < first + count; ++k) {
        const Index q = neighbour(pixel, turned(k));
        if (q != kGhost)
            ring[n++] = q;
        else if (!has_ghost && leads_outside(pixel, turned(k))) {
            ring[n++] = kGhost;
            has_ghost = true;
        }
    }
    return n;
}

/// Collapses the edge from t to u. t stays where it is; its intensities change so that the volume under the surface
/// does not.
CollapseRecord Bisection::remove(const Removal& r, SplitPair* more)
{
    CollapseRecord record;
    Spot &t = m_spots[r.t], &u = m_spots[r.u], &b = m_spots[r.b];
    // The star of the collapse: the ring of t from vr to vl, then b.
    Index ring[kDirections + 2];
    int n = ring_from(r.t, r.direction + 1, kDirections - 1, ring);
    const Index vr = ring[0], vl = ring[n - 1];
    ring[n++] = r.b;
    int face = 0;
    while (ring[face] == kGhost || ring[face + 1] == kGhost)
        ++face;
    record.split = { r.t, vl, vr, r.of_t, r.of_u };
    record.u = r.u;
    // t is where s is. u is half way to b; of the two faces there, the first in ring order predicts it.
    record.stencil = { r.t,  ring[face], ring[face + 1], vl != kGhost ? vl : r.b, vl != kGhost ? r.b : vr, 0.0f, 0.0f,
                       0.0f, 0.0f };
    (vl != kGhost ? record.stencil.wbu : record.stencil.wau) = 0.5f;
    record.zt = t.z;
    record.zu = u.z;
    record.order = m_costs[r.u];

    const float sides = vl != kGhost && vr != kGhost ? 2.0f : 1.0f, gained = sides * r.area;
    const auto change = [&](float zt, float zu, float zb) {
        return gained * ((zu - zt) + (zu - zb)) / (t.area + gained);
    };
    t.z += change(t.z, u.z, b.z);
    for (std::size_t c = 0; c < m_more_channels; ++c) {
        float& zt = m_more[r.t * m_more_channels + c];
        const float zu = m_more[r.u * m_more_channels + c];
        more[c] = { zt, zu };
        zt += change(zt, zu, m_more[r.b * m_more_channels + c]);
    }
    t.area += gained;
    b.area += gained;
    t.order = b.order = record.order;
    ++t.reach[std::size_t(r.direction)];
    ++b.reach[std::size_t(turned(r.direction + 4))];
    if (vr != kGhost)
        m_spots[vr].reach[std::size_t(turned(r.direction + 6))] = 0;
    if (vl != kGhost)
        m_spots[vl].reach[std::size_t(turned(r.direction + 2))] = 0;
    return record;
}

}  // namespace PIMG_ABI
}  // namespace pimg
