// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/inks.h>

#include <algorithm>
#include <cmath>

#include <pimg/detail/rec709.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

using Colour = std::array<float, 3>;

// Chosen by eye; after each number stands what more of it does.
constexpr int kRounds = 16;           ///< of Lloyd's method; the inks of photographs no longer change after ten
constexpr float kLeastDepth = 0.05f;  ///< distance from white below which a region needs no ink
constexpr float kDeep = 0.8f;         ///< share of its regions' area that an ink is darker than; more: darker inks
constexpr float kPalest = 0.6f;       ///< least distance of an ink from white: paler ones do not show as lines
constexpr float kSame = 0.01f;        ///< squared distance of directions that need no ink of their own

float encoded(float light)
{
    return float(elementary::srgb_encoded(double(std::clamp(light, 0.0f, 1.0f))));
}

/// The inverse of the lightness function of CIE 15.
float light_of(float f)
{
    return f > 6.0f / 29.0f ? f * f * f : 3.0f * (6.0f / 29.0f) * (6.0f / 29.0f) * (f - 4.0f / 29.0f);
}

float lightness_of(const Colour& srgb)
{
    float luminance = 0.0f;
    for (std::size_t c = 0; c < 3; ++c)
        luminance += elementary::kRec709Weights[c] * float(elementary::srgb_decoded(double(srgb[c])));
    return elementary::lightness(luminance);
}

/// From CIELAB to encoded sRGB (IEC 61966-2-1).
Colour srgb_of(const Colour& lab)
{
    const float fy = (lab[0] + 16.0f) / 116.0f;
    const float x = 0.95047f * light_of(fy + lab[1] / 500.0f), y = light_of(fy),
                z = 1.08883f * light_of(fy - lab[2] / 200.0f);
    return { encoded(3.2406f * x - 1.5372f * y - 0.4986f * z), encoded(-0.9689f * x + 1.8758f * y + 0.0415f * z),
             encoded(0.0557f * x - 0.2040f * y + 1.0570f * z) };
}

/// The colour of a region as a direction from white and a distance.
struct Tint {
    Colour direction;  ///< the largest of the three is 1
    float depth;       ///< how far the region is from white in that direction, 0..1
    float area;
};

Tint tint_of(const RegionColour& region)
{
    Colour away = srgb_of(region.lab);
    for (float& v : away)
        v = 1.0f - v;
    const float depth = *std::max_element(away.begin(), away.end());
    for (float& v : away)
        v = depth > 0.0f ? v / depth : 1.0f;
    return { away, depth, region.area };
}

float square_distance(const Colour& a, const Colour& b)
{
    const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

std::size_t nearest(const std::vector<Colour>& directions, const Colour& direction)
{
    std::size_t best = 0;
    for (std::size_t i = 1; i < directions.size(); ++i)
        if (square_distance(directions[i], direction) < square_distance(directions[best], direction))
            best = i;
    return best;
}

/// Adds the most important direction among those that are far from all that are chosen already; false if there is none.
bool add_direction(const std::vector<Tint>& tints, std::vector<Colour>& directions)
{
    float most = 0.0f;
    Colour next {};
    for (const Tint& t : tints) {
        const float off = square_distance(directions[nearest(directions, t.direction)], t.direction);
        if (off > kSame && t.depth > kLeastDepth && off * t.depth * t.area > most) {
            most = off * t.depth * t.area;
            next = t.direction;
        }
    }
    if (most > 0.0f)
        directions.push_back(next);
    return most > 0.0f;
}

/// Moves each direction, except the first, which is black, to the mean of the tints that are nearest to it.
void centre(const std::vector<Tint>& tints, std::vector<Colour>& directions)
{
    for (int round = 0; round < kRounds; ++round) {
        std::vector<Colour> sums(directions.size(), Colour {});
        std::vector<float> weights(directions.size(), 0.0f);
        for (const Tint& t : tints) {
            const std::size_t ink = nearest(directions, t.direction);
            const float weight = t.depth * t.area;
            weights[ink] += weight;
            for (std::size_t c = 0; c < 3; ++c)
                sums[ink][c] += weight * t.direction[c];
        }
        for (std::size_t i = 1; i < directions.size(); ++i)
            for (std::size_t c = 0; c < 3 && weights[i] > 0.0f; ++c)
                directions[i][c] = sums[i][c] / weights[i];
    }
}

/// The depth of an ink: the share kDeep of the area of its regions is no deeper.
float depth_of(std::vector<std::pair<float, float>> depths_and_areas)
{
    std::sort(depths_and_areas.begin(), depths_and_areas.end());
    float all = 0.0f, below = 0.0f;
    for (const auto& [depth, area] : depths_and_areas)
        all += area;
    for (const auto& [depth, area] : depths_and_areas)
        if ((below += area) >= kDeep * all)
            return std::max(depth, kPalest);
    return kPalest;
}

}  // namespace

InkChoice choose_inks(const std::vector<RegionColour>& regions, int count)
{
    std::vector<Tint> tints(regions.size());
    std::transform(regions.begin(), regions.end(), tints.begin(), tint_of);
    std::vector<Colour> directions { Colour { 1.0f, 1.0f, 1.0f } };
    while (int(directions.size()) < count && add_direction(tints, directions))
        centre(tints, directions);
    InkChoice choice;
    std::vector<std::vector<std::pair<float, float>>> depths(directions.size());
    for (const Tint& t : tints) {
        choice.ink_of_region.push_back(std::uint8_t(nearest(directions, t.direction)));
        depths[choice.ink_of_region.back()].emplace_back(t.depth, t.area);
    }
    choice.inks.push_back({ { 0.0f, 0.0f, 0.0f }, 0.0f });
    for (std::size_t i = 1; i < directions.size(); ++i) {
        const float depth = depth_of(depths[i]);
        Ink ink;
        for (std::size_t c = 0; c < 3; ++c)
            ink.colour[c] = 1.0f - depth * directions[i][c];
        ink.lightness = lightness_of(ink.colour);
        choice.inks.push_back(ink);
    }
    return choice;
}

}  // namespace PIMG_ABI
}  // namespace pimg
