// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/brush.h>

#include <algorithm>
#include <cmath>

#include <pimg/strokes.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// The masks are our own drawings: all numbers here and in the six functions below, such as where hairs start, how
// ragged ends are and how high the paint stands, were chosen by eye. Lengths along a stroke are in columns of the
// finest mask; lengths across it are shares of half its width. Heights and alphas are 0 to 1.

/// Number of masks of one brush. With more, strokes repeat less often, and a brush takes longer to make.
constexpr int kVariants = 8;
constexpr float kCap = float(Brush::kRows) / 2;  ///< columns from the tip to where a round end is full

float smooth_step(float from, float to, float x)
{
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// Smooth noise in -1..1 on a lattice of unit cells.
float noise(float x, float y, std::uint32_t seed)
{
    const auto corner = [&](int ix, int iy) {
        return signed_unit(scramble(std::uint32_t(ix) + scramble(std::uint32_t(iy) + scramble(seed))));
    };
    const int ix = int(std::floor(x)), iy = int(std::floor(y));
    const float wx = smooth_step(0, 1, x - float(ix)), wy = smooth_step(0, 1, y - float(iy));
    return (1 - wy) * ((1 - wx) * corner(ix, iy) + wx * corner(ix + 1, iy))
        + wy * ((1 - wx) * corner(ix, iy + 1) + wx * corner(ix + 1, iy + 1));
}

/// A place on the finest mask: columns from the near end and -1..1 across.
struct Place {
    float along, across;
    float to_end() const { return float(Brush::kColumns) - along; }
};

Paint round_paint(Place p, std::uint32_t)
{
    const float x = std::max(0.0f, 1.0f - std::min(p.along, p.to_end()) / kCap);
    const float r = std::sqrt(x * x + p.across * p.across);
    return { 1.0f - smooth_step(0.94f, 1.0f, r), 0.35f + 0.3f * std::sqrt(std::max(0.0f, 1.0f - r * r)) };
}

/// Square ends, paint pushed to the two sides.
Paint flat_paint(Place p, std::uint32_t seed)
{
    const float rim = smooth_step(0.7f, 0.95f, std::fabs(p.across));
    const float streak = noise(p.along / 48.0f, p.across * 7.0f, seed);
    return { 1.0f, 0.45f + 0.12f * streak + 0.15f * rim };
}

/// Hairs: each has its own load of paint, starts and lifts off at its own place, and runs dry now and then.
Paint bristle_paint(Place p, std::uint32_t seed)
{
    const float thick = noise(p.along / 70.0f, p.across * 4.5f, seed);
    const float thin = noise(p.along / 40.0f, p.across * 13.0f, seed + 1);
    const float height = 0.5f + 0.26f * thick + 0.24f * thin;
    // Ends follow a round outline, set back by up to a third of the width hair by hair.
    const float ragged = noise(0.0f, p.across * 8.0f, seed + 2), lifted = noise(0.0f, p.across * 10.0f, seed + 3);
    const float bow = kCap * 0.55f * (1.0f - std::sqrt(std::max(0.0f, 1.0f - p.across * p.across)));
    const float start = bow + kCap * 0.12f * (1.0f + ragged), end = bow + kCap * 0.3f * (1.0f + lifted);
    float alpha = smooth_step(start - 3.0f, start + 3.0f, p.along) * smooth_step(end - 5.0f, end + 5.0f, p.to_end());
    // Thin paint lets the ground show through, more so towards the end and at the rim.
    const float dry = smooth_step(0.35f, 1.0f, p.along / float(Brush::kColumns));
    alpha *= 1.0f - (0.25f + 0.35f * dry) * smooth_step(0.30f, 0.05f, height);
    alpha *= 1.0f - smooth_step(0.86f + 0.1f * thin, 1.0f + 0.1f * thin, std::fabs(p.across));
    return { std::clamp(alpha, 0.0f, 1.0f), std::clamp(height, 0.0f, 1.0f) };
}

/// A blade: even paint, pressed to a ridge on one side and heaped where the blade lifts off.
Paint knife_paint(Place p, std::uint32_t seed)
{
    const float side = seed & 1 ? p.across : -p.across;
    const float slant = kCap * 0.35f * (1.0f + side);
    const float broken = 2.0f * noise(p.across * 5.0f, 3.0f, seed);
    const float alpha =
        smooth_step(slant - 1.0f, slant + 1.0f, p.along) * smooth_step(2.0f + broken, 4.0f + broken, p.to_end());
    const float ridge = smooth_step(0.72f, 0.92f, side) + smooth_step(0.3f * kCap, 0.1f * kCap, p.to_end());
    const float scrape = noise(p.along / 90.0f, p.across * 5.0f, seed + 1);
    return { alpha, std::clamp(0.4f + 0.1f * scrape + 0.35f * std::min(ridge, 1.0f), 0.0f, 1.0f) };
}

/// A stick of chalk, pressed most in the middle. The tooth of the canvas does the rest.
Paint chalk_paint(Place p, std::uint32_t seed)
{
    const float x = std::max(0.0f, 1.0f - std::min(p.along, p.to_end()) / kCap);
    const float r = std::sqrt(x * x + p.across * p.across);
    const float streak = noise(p.along / 50.0f, p.across * 6.0f, seed);
    return { std::clamp((0.8f + 0.2f * streak) * (1.0f - smooth_step(0.55f, 1.0f, r)), 0.0f, 1.0f),
             0.5f + 0.4f * noise(p.along / 40.0f, p.across * 9.0f, seed + 1) };
}

/// Water with pigment, which settles in the grain of the paper and dries to a dark rim.
Paint wash_paint(Place p, std::uint32_t seed)
{
    const float x = std::max(0.0f, 1.0f - std::min(p.along, p.to_end()) / kCap);
    const float bay = 0.12f * noise(p.along / 20.0f, p.across * 2.0f, seed);
    const float r = std::sqrt(x * x + p.across * p.across) + bay;
    const float cloud = noise(p.along / 30.0f, p.across * 2.5f, seed + 1);
    const float rim = smooth_step(0.62f, 0.84f, r);
    return { (1.0f - smooth_step(0.84f, 0.92f, r)) * (0.72f + 0.12f * cloud + 0.2f * rim),
             std::clamp(0.6f - 0.25f * rim - 0.15f * cloud, 0.0f, 1.0f) };
}

std::vector<Paint> draw(Paint (*paint)(Place, std::uint32_t), std::uint32_t seed)
{
    std::vector<Paint> mask;
    mask.reserve(std::size_t(Brush::kColumns) * Brush::kRows);
    for (int y = 0; y < Brush::kRows; ++y)
        for (int x = 0; x < Brush::kColumns; ++x)
            mask.push_back(paint({ float(x) + 0.5f, (float(y) + 0.5f) * (2.0f / Brush::kRows) - 1.0f }, seed));
    return mask;
}

}  // namespace

Brush Brush::named(const std::string& name)
{
    struct Kind {
        const char* name;
        Paint (*paint)(Place, std::uint32_t);
        float grain;  ///< by eye; without any, frames of a film change less but paint spills more (internals.md)
        float tooth;
        int variants;
    };
    static constexpr Kind kKinds[] = { { "round", round_paint, 0.0f, 0.0f, 1 },
                                       { "flat", flat_paint, 0.15f, 0.0f, kVariants },
                                       { "bristle", bristle_paint, 0.16f, 0.0f, kVariants },
                                       { "knife", knife_paint, 0.12f, 0.0f, kVariants },
                                       { "chalk", chalk_paint, 0.16f, 0.9f, kVariants },
                                       { "wash", wash_paint, 0.3f, 0.0f, kVariants } };
    Brush brush;
    for (const Kind& kind : kKinds)
        if (name == kind.name) {
            brush.m_grain = kind.grain;
            brush.m_tooth = kind.tooth;
            for (int k = 0; k < kind.variants; ++k)
                brush.add_variant(draw(kind.paint, scramble(std::uint32_t(k) + 17u)));
        }
    return brush;
}

Brush Brush::from_picture(int width, int height, const float* alpha, const float* heights)
{
    std::vector<Paint> mask;
    mask.reserve(std::size_t(kColumns) * kRows);
    for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < kColumns; ++x) {
            // The mean of the picture's pixels in this cell, or the nearest one of a small picture.
            const int x0 = x * width / kColumns, x1 = std::max(x0 + 1, (x + 1) * width / kColumns);
            const int y0 = y * height / kRows, y1 = std::max(y0 + 1, (y + 1) * height / kRows);
            float a = 0.0f, h = 0.0f;
            for (int py = y0; py < y1; ++py)
                for (int px = x0; px < x1; ++px) {
                    const std::size_t at = std::size_t(py) * std::size_t(width) + std::size_t(px);
                    a += std::clamp(alpha ? alpha[at] : heights ? heights[at] : 1.0f, 0.0f, 1.0f);
                    h += std::clamp(heights ? heights[at] : 0.5f, 0.0f, 1.0f);
                }
            const float share = 1.0f / float((x1 - x0) * (y1 - y0));
            mask.push_back({ share * a, share * h });
        }
    Brush brush;
    brush.m_stretched = true;
    brush.m_grain = heights && alpha ? 0.3f : 0.0f;
    brush.add_variant(std::move(mask));
    return brush;
}

void Brush::add_variant(std::vector<Paint> finest)
{
    std::vector<std::vector<Paint>> levels { std::move(finest) };
    for (int columns = kColumns / 2, rows = kRows / 2; rows >= 2; columns /= 2, rows /= 2) {
        const std::vector<Paint>& fine = levels.back();
        std::vector<Paint> half;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                const Paint *a = fine.data() + (2 * y) * 2 * columns + 2 * x, *b = a + 2 * columns;
                half.push_back({ 0.25f * (a[0].alpha + a[1].alpha + b[0].alpha + b[1].alpha),
                                 0.25f * (a[0].height + a[1].height + b[0].height + b[1].height) });
            }
        levels.push_back(std::move(half));
    }
    m_levels.push_back(std::move(levels));
    ++m_variants;
}

Brush::Mask Brush::mask(float width, std::uint32_t variation) const
{
    const auto& levels = m_levels[variation % std::uint32_t(m_variants)];
    std::size_t level = 0;
    while (level + 1 < levels.size() && width < 0.75f * float(kRows >> level))
        ++level;
    return { kColumns >> level, kRows >> level, levels[level].data() };
}

}  // namespace PIMG_ABI
}  // namespace pimg
