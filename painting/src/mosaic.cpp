// SPDX-License-Identifier: BSD-3-Clause
// Works with distances to the sides of the pieces' polygons. These polygons share their sides and cover the plane.
// Where a star is very concave they may overlap; there a pixel belongs to the tile that it lies deeper in, so that it
// is on one.
#include <pimg/detail/parallel.h>
#include <pimg/mosaic.h>

#include <algorithm>
#include <cmath>

#include <pimg/strokes.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kStrip = 64;  ///< rows of a task

/// Largest change of a slope's brightness at relief = 1, as a share of it. Chosen by eye; more: deeper tiles.
constexpr float kLight = 0.6f;

constexpr float kRootOfHalf = 0.7071f;  ///< the light comes from the upper left, at 45 degrees

/// Change of brightness of a slope that faces the light: it falls towards the joint.
float slope(float depth, const TileOptions& options)
{
    if (options.bevel <= 0.0f || depth >= options.bevel)
        return 0.0f;
    return kLight * options.relief * std::clamp(1.0f - depth / options.bevel, 0.0f, 1.0f);
}

/// Brightness of glass: light that falls through the middle of a pane is not held back by the lead. By eye.
float glow(float depth)
{
    constexpr float kRim = 0.35f, kReach = 9.0f;  // share that the lead takes at most; how far, in pixels
    return 1.1f - kRim * kReach / (kReach + std::max(0.0f, depth));
}

/// Brightness of lead, which is round: its side towards the light is bright. By eye.
float lead(float inside, float half, float facing)
{
    constexpr float kShine = 0.9f;
    const float slope = std::clamp(half > 0.0f ? inside / half : 0.0f, 0.0f, 1.0f);
    return 1.0f - kShine * slope * facing;
}

struct Depth {
    float inside, x, y;
};

/// How deep `p` is inside the polygon: negative outside.
Depth depth_of(Vec2 p, const std::vector<Vec2>& polygon, Vec2 far_corner)
{
    bool in = false;
    Depth nearest { 1e30f, 0.0f, 0.0f };
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Vec2 a = polygon[j], b = polygon[i];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y))
            in = !in;
        // Sides on the picture's border are no joints.
        if ((a.x <= 0 && b.x <= 0) || (a.y <= 0 && b.y <= 0) || (a.x >= far_corner.x && b.x >= far_corner.x)
            || (a.y >= far_corner.y && b.y >= far_corner.y))
            continue;
        const float dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
        const float t = square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0f, 1.0f) : 0.0f;
        const float ox = p.x - (a.x + t * dx), oy = p.y - (a.y + t * dy), distance = std::sqrt(ox * ox + oy * oy);
        if (distance < nearest.inside)
            nearest = { distance, distance > 0 ? ox / distance : 0.0f, distance > 0 ? oy / distance : 0.0f };
    }
    return in ? nearest : Depth { -nearest.inside, -nearest.x, -nearest.y };
}

/// The mean colour of every tile in each channel, changed by chance; that of glass is also more saturated.
std::vector<std::vector<float>> tile_colours(const Tiling& tiling, Index tiles, const TileOptions& options,
                                             const std::vector<float*>& channels)
{
    constexpr float kWarmth = 0.6f;      // change of warmth as a share of that of brightness; by eye
    constexpr float kSaturation = 1.3f;  // of glass; by eye
    std::vector<std::vector<float>> colours(channels.size(), std::vector<float>(tiles));
    run(options.parallel, channels.size(), [&](std::size_t c) {
        std::vector<double> sums(tiles, 0.0), counts(tiles, 0.0);
        for (std::size_t i = 0; i < tiling.tile.size(); ++i) {
            sums[tiling.tile[i]] += double(channels[c][i]);
            counts[tiling.tile[i]] += 1.0;
        }
        for (Index t = 0; t < tiles; ++t)
            colours[c][t] = counts[t] > 0.0 ? float(sums[t] / counts[t]) : 0.0f;
    });
    const bool coloured = channels.size() > 2;
    for (Index t = 0; t < tiles; ++t) {
        const std::uint32_t chance = scramble(t + scramble(options.seed));
        const float light = 1.0f + options.variation * signed_unit(chance);
        const float warm = coloured ? kWarmth * options.variation * signed_unit(scramble(chance)) : 0.0f;
        const float grey = coloured ? (colours[0][t] + colours[1][t] + colours[2][t]) / 3.0f : 0.0f;
        for (std::size_t c = 0; c < channels.size(); ++c) {
            float& colour = colours[c][t];
            if (options.leading > 0.0f && coloured && c < 3)  // no light becomes less than none
                colour = std::max(grey + kSaturation * (colour - grey), std::min(colour, 0.0f));
            colour *= light * (c == 0 ? 1.0f + warm : c == 2 ? 1.0f - warm : 1.0f);
        }
    }
    return colours;
}

Tiling empty_tiling(const Mesh& mesh)
{
    Tiling tiling;
    tiling.width = mesh.extent().x / kSubpixels + 1;
    tiling.height = mesh.extent().y / kSubpixels + 1;
    const std::size_t pixels = std::size_t(tiling.width) * std::size_t(tiling.height);
    tiling.tile.resize(pixels, 0);
    tiling.inside.resize(pixels, -1e30f);
    tiling.away_x.resize(pixels);
    tiling.away_y.resize(pixels);
    return tiling;
}

}  // namespace

Tiling tile(const Mesh& mesh, const ParallelFor& parallel)
{
    Tiling tiling = empty_tiling(mesh);
    const Vec2 corner { float(tiling.width - 1), float(tiling.height - 1) };
    const std::size_t strips = std::size_t(tiling.height + kStrip - 1) / kStrip;
    std::vector<std::vector<Vec2>> polygons(mesh.size());
    std::vector<std::vector<Index>> of_strip(strips);
    for (Index v = 0; v < mesh.size(); ++v) {
        polygons[v] = piece_polygon(mesh, v);
        float top = corner.y, bottom = 0.0f;
        for (Vec2& p : polygons[v]) {
            top = std::min(top, p.y);
            bottom = std::max(bottom, p.y);
            // The border's own pixels must lie inside the tiles at the border.
            p.x += p.x <= 0 ? -1.0f : p.x >= corner.x ? 1.0f : 0.0f;
            p.y += p.y <= 0 ? -1.0f : p.y >= corner.y ? 1.0f : 0.0f;
        }
        for (std::size_t s = std::size_t(std::max(0.0f, top - 2)) / kStrip;
             s < strips && float(s * kStrip) <= bottom + 2; ++s)
            of_strip[s].push_back(v);
    }
    run(parallel, strips, [&](std::size_t s) {
        const int y0 = int(s) * kStrip, y1 = std::min(tiling.height, y0 + kStrip);
        for (Index v : of_strip[s]) {
            Vec2 low = polygons[v][0], high = low;
            for (Vec2 p : polygons[v]) {
                low = { std::min(low.x, p.x), std::min(low.y, p.y) };
                high = { std::max(high.x, p.x), std::max(high.y, p.y) };
            }
            for (int y = std::max(y0, int(low.y) - 1); y < std::min(y1, int(high.y) + 2); ++y)
                for (int x = std::max(0, int(low.x) - 1); x < std::min(tiling.width, int(high.x) + 2); ++x) {
                    const Depth d = depth_of({ float(x), float(y) }, polygons[v], corner);
                    const std::size_t at = std::size_t(y) * std::size_t(tiling.width) + std::size_t(x);
                    if (d.inside > tiling.inside[at]) {
                        tiling.tile[at] = v;
                        tiling.inside[at] = d.inside;
                        tiling.away_x[at] = d.x;
                        tiling.away_y[at] = d.y;
                    }
                }
        }
    });
    return tiling;
}

void lay_mosaic(const Tiling& tiling, Index tiles, const TileOptions& options, const std::vector<float>& grout_colours,
                const std::vector<float*>& channels)
{
    // Half the width of a joint, but less for slivers, of which two thirds must stay tile.
    std::vector<float> joints(tiles, 0.0f);
    for (std::size_t i = 0; i < tiling.tile.size(); ++i)
        joints[tiling.tile[i]] = std::max(joints[tiling.tile[i]], tiling.inside[i]);
    const float width = options.leading > 0.0f ? options.leading : options.grout;
    for (float& joint : joints)
        joint = std::min(0.5f * width, joint / 3.0f);
    const std::vector<std::vector<float>> colours = tile_colours(tiling, tiles, options, channels);
    run(options.parallel, channels.size(), [&](std::size_t c) {
        float* samples = channels[c];
        for (std::size_t i = 0; i < tiling.tile.size(); ++i) {
            const Index t = tiling.tile[i];
            const float depth = tiling.inside[i] - joints[t];
            const float facing = kRootOfHalf * (tiling.away_x[i] + tiling.away_y[i]);
            const float shade =
                colours[c][t] * (options.leading > 0.0f ? glow(depth) : 1.0f + slope(depth, options) * facing);
            const float cover = width > 0.0f ? std::clamp(depth + 0.5f, 0.0f, 1.0f) : 1.0f;
            const float joint =
                grout_colours[c] * (options.leading > 0.0f ? lead(tiling.inside[i], joints[t], facing) : 1.0f);
            samples[i] = joint + cover * (shade - joint);
        }
    });
}

}  // namespace PIMG_ABI
}  // namespace pimg
