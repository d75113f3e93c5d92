// SPDX-License-Identifier: BSD-3-Clause
// Error diffusion decides how many dots there are and where about; Lloyd's method spreads them evenly.
#include "drawing/stipple.h"

#include <algorithm>
#include <cmath>

#include <pimg/detail/elementary.h>
#include <pimg/detail/stop.h>

#include "drawing/raster_ops.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kSteps = 16;                    ///< of Lloyd's method; more: more even, and slower in proportion
constexpr float kReach = 2.0f;                ///< of a dot's cell, in radii of a disk of the area that it should have
constexpr float kLight = 1.0f, kDark = 1.6f;  ///< widths in pens of dots in light and dark tones, by eye
constexpr float kNarrowest = 0.7f, kWidest = 2.2f;  ///< and at least and at most
constexpr float kJitter = 0.5f;                     ///< pixels; breaks the patterns of error diffusion

/// A cell of the diagram: sums over its pixels.
struct Cell {
    float weight = 0.0f, x = 0.0f, y = 0.0f;  ///< sums of the density, and of the density times x and y
    float cover = 0.0f;                       ///< area that the dot should cover, in pixels
};

class Stippler {
public:
    Stippler(const Raster& cover, const StippleOptions& options) : m_cover(cover), m_options(options), m_density(cover)
    {
        for (float& d : m_density.samples)
            d = d < options.least ? 0.0f : d / area(width(d));
    }

    void diffuse();
    void spread();
    void add_to(Drawing& drawing) const;

private:
    static float area(float width) { return float(elementary::kPi / 4.0) * width * width; }
    float width(float cover) const { return m_options.pen * (kLight + (kDark - kLight) * cover); }
    void assign();

    const Raster& m_cover;
    const StippleOptions& m_options;
    Raster m_density;  ///< dots per pixel
    std::vector<Vec2> m_dots;
    std::vector<Cell> m_cells;
};

/// Floyd and Steinberg (1976), every other row backwards.
void Stippler::diffuse()
{
    const int w = m_density.width, h = m_density.height;
    std::vector<float> here(std::size_t(w) + 2, 0.0f), below = here;
    for (int y = 0; y < h; ++y) {
        stop_point();
        const int step = y % 2 ? -1 : 1;
        for (int k = 0; k < w; ++k) {
            const int x = step > 0 ? k : w - 1 - k;
            float* at = here.data() + x + 1;
            float* under = below.data() + x + 1;
            const std::size_t pixel = std::size_t(y) * std::size_t(w) + std::size_t(x);
            const float wanted = m_density.samples[pixel] + *at;
            const bool dot = wanted >= 0.5f;
            const float rest = dot ? wanted - 1.0f : wanted;
            if (dot) {
                const std::uint32_t chance = scramble(std::uint32_t(pixel) + scramble(m_options.seed));
                m_dots.push_back(
                    { float(x) + kJitter * signed_unit(chance), float(y) + kJitter * signed_unit(scramble(chance)) });
            }
            at[step] += rest * (7.0f / 16.0f);
            under[-step] += rest * (3.0f / 16.0f);
            under[0] += rest * (5.0f / 16.0f);
            under[step] += rest * (1.0f / 16.0f);
        }
        std::swap(here, below);
        std::fill(below.begin(), below.end(), 0.0f);
    }
}

/// Gives every pixel to the nearest dot whose cell may reach it.
void Stippler::assign()
{
    const int w = m_density.width, h = m_density.height;
    std::vector<float> least(m_density.samples.size(), 1e30f);
    std::vector<Index> owner(m_density.samples.size(), kGhost);
    for (Index i = 0; i < Index(m_dots.size()); ++i) {
        stop_point();
        const Vec2 p = m_dots[i];
        const float density = std::max(nearest(m_density, p), 1e-3f);
        const float reach = kReach / std::sqrt(float(elementary::kPi) * density);
        const int x0 = std::max(0, int(p.x - reach)), x1 = std::min(w - 1, int(p.x + reach) + 1);
        const int y0 = std::max(0, int(p.y - reach)), y1 = std::min(h - 1, int(p.y + reach) + 1);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const float dx = float(x) - p.x, dy = float(y) - p.y, square = dx * dx + dy * dy;
                const std::size_t at = std::size_t(y) * std::size_t(w) + std::size_t(x);
                if (square < least[at]) {
                    least[at] = square;
                    owner[at] = i;
                }
            }
    }
    stop_point();
    m_cells.assign(m_dots.size(), Cell {});
    for (std::size_t at = 0; at < owner.size(); ++at)
        if (owner[at] != kGhost) {
            Cell& cell = m_cells[owner[at]];
            const float density = m_density.samples[at];
            cell.weight += density;
            const std::size_t column = at % std::size_t(w), row = at / std::size_t(w);
            cell.x += density * float(column);
            cell.y += density * float(row);
            cell.cover += m_cover.samples[at];
        }
}

void Stippler::spread()
{
    for (int step = 0; step < kSteps; ++step) {
        assign();
        for (std::size_t i = 0; i < m_dots.size(); ++i)
            if (m_cells[i].weight > 0.0f)
                m_dots[i] = { m_cells[i].x / m_cells[i].weight, m_cells[i].y / m_cells[i].weight };
    }
    assign();
}

void Stippler::add_to(Drawing& drawing) const
{
    for (std::size_t i = 0; i < m_dots.size(); ++i) {
        const Vec2 p = m_dots[i];
        const float width = std::sqrt(m_cells[i].cover * float(4.0 / elementary::kPi));
        const Index ink = m_options.ink_of ? (*m_options.ink_of)[pixel_at(m_cover, p)] : 0;
        drawing.lines.push_back({ Index(drawing.points.size()), 1, ink });
        drawing.points.push_back({ p.x, p.y, std::clamp(width, kNarrowest * m_options.pen, kWidest * m_options.pen) });
    }
}

}  // namespace

void add_stipple(const Raster& cover, const StippleOptions& options, Drawing& drawing)
{
    Stippler stippler(cover, options);
    stippler.diffuse();
    stippler.spread();
    stippler.add_to(drawing);
}

}  // namespace PIMG_ABI
}  // namespace pimg
