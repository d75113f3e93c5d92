// SPDX-License-Identifier: BSD-3-Clause
//     features, base -> slopes -> structure tensor -> direction along the edge -> slope across it, mean along it
//     mean of the channels -> second differences -> direction of least bend -> depth across it, mean along it
//
// The mean along the line, as in flow-based differences of Gaussians (Kang, Lee and Chui 2007), keeps edges that run on
// and removes texture.
#include "drawing/line_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// Chosen by eye on photographs of 0.1 to 1 megapixel, on a grid of two cells to a pen; after each number stands what more
// of it does.
constexpr float kSlopeSigma = 1.0f;   ///< of the filter before slopes are taken, cells; more: fewer, smoother lines
constexpr float kTensorSigma = 2.0f;  ///< of the filter of the structure tensor, cells; more: straighter lines
constexpr int kAlong = 6;             ///< steps to either side over which slopes are averaged; more: only long edges
constexpr float kAlongSigma = 2.5f;   ///< of the weights of these steps
constexpr int kFarAlong = 12;         ///< the same for thin lines, which need more of it to stand out from texture
constexpr float kFarAlongSigma = 6.0f;
constexpr float kLeastEnergy = 1.0f;  ///< squared slope below which nothing is looked at; more: faster
constexpr float kLeastDepth = 1.5f;   ///< the same for how much darker a thin line is
constexpr float kAround = 8.0f;       ///< standard deviation in cells of what is around a line
// The share of its importance that a line keeps is kAlone - kInhibition r, where r is the mean strength around it over
// its own: 0.12 for an edge that is alone, which keeps all.
constexpr float kAlone = 1.3f;           ///< more: busier places
constexpr float kInhibition = 1.4f;      ///< more: calmer places
constexpr float kThinInhibition = 4.0f;  ///< the same for thin lines
constexpr float kLeastAlone = 0.15f;     ///< the least share of an edge; more: busier places
constexpr float kLasting = 110.0f;       ///< what borders survive (Study::borders) that count; more: calmer places
constexpr float kDoublings = 2.5f;       ///< of it until they count fully
constexpr float kBorderAlone = 0.45f;    ///< share that an edge on such a border keeps among others
constexpr float kCarried = 3.0f;         ///< importance of such a border where it is faint; more: longer lines
constexpr float kThinCounts = 1.7f;      ///< importance of a depth beside that of a slope; more: more thin lines
constexpr float kCarriedFrom = 0.5f;     ///< 1 / the slope from which it is; more: lines in soft shading
constexpr float kBeside = 2.0f;     ///< cells from the middle of a thin line to where it is not; more: thicker ones
constexpr float kStraight = 0.45f;  ///< cosine of the sharpest turn in a step

/// Derivatives of one channel.
struct Slopes {
    Raster x, y;
};

/// Calls body(index, pointer to the sample, offsets of the neighbours) for every cell of a raster; at the border, the
/// cell itself takes the place of a neighbour.
template<class Body>
void for_neighbours(const Raster& raster, const ParallelFor& parallel, Body&& body)
{
    const int w = raster.width, h = raster.height;
    for_rows(parallel, 0, h, [&](int y) {
        const std::ptrdiff_t up = y > 0 ? -w : 0, down = y + 1 < h ? w : 0;
        for (int x = 0; x < w; ++x) {
            const std::size_t at = std::size_t(y) * std::size_t(w) + std::size_t(x);
            body(at, raster.samples.data() + at, x > 0 ? -1 : 0, x + 1 < w ? 1 : 0, up, down);
        }
    });
}

Slopes slopes_of(const Raster& channel, const ParallelFor& parallel)
{
    const Raster smooth = blurred(channel, kSlopeSigma, parallel);
    Slopes slopes { make_raster(channel.width, channel.height), make_raster(channel.width, channel.height) };
    for_neighbours(smooth, parallel,
                   [&](std::size_t at, const float* p, std::ptrdiff_t left, std::ptrdiff_t right, std::ptrdiff_t up,
                       std::ptrdiff_t down) {
                       slopes.x.samples[at] = 0.5f * (p[right] - p[left]);
                       slopes.y.samples[at] = 0.5f * (p[down] - p[up]);
                   });
    return slopes;
}

template<int kSteps>
std::array<float, std::size_t(kSteps)> bell(float sigma)
{
    std::array<float, std::size_t(kSteps)> weights {};
    for (int k = 0; k < kSteps; ++k)
        weights[std::size_t(k)] =
            float(elementary::exp2(-0.5 / elementary::kLn2 * k * k / (double(sigma) * double(sigma))));
    return weights;
}

/// Walks along the line through a cell, to both sides. Calls visit(cell, unit vector across the line, weight) for every
/// step; the vector keeps its side. Returns the sum of the weights.
template<std::size_t kSteps, class Visit>
float walk_along(const LineMap& map, int x, int y, const std::array<float, kSteps>& weights, Visit&& visit)
{
    float total = 0.0f;
    for (const float sign : { -1.0f, 1.0f }) {
        Vec2 p { float(x), float(y) };
        Vec2 d = map.along(p);
        d = { sign * d.x, sign * d.y };
        for (std::size_t k = sign < 0.0f ? 1 : 0; k < kSteps; ++k) {
            if (k > 0) {
                p = { p.x + d.x, p.y + d.y };
                const Vec2 next = map.along(p);
                const float cosine = next.x * d.x + next.y * d.y;
                if (std::fabs(cosine) < kStraight)
                    break;
                d = cosine < 0.0f ? Vec2 { -next.x, -next.y } : next;
            }
            total += weights[k];
            visit(pixel_at(map.strength, p), Vec2 { -sign * d.y, sign * d.x }, weights[k]);
        }
    }
    return total;
}

LineMap empty_map(int width, int height)
{
    const Raster zero = make_raster(width, height);
    return { zero, zero, zero, zero };
}

/// The sum of the squared slopes of all channels, and the direction in which they are least.
Raster find_directions(const std::vector<Slopes>& slopes, const ParallelFor& parallel, LineMap& map)
{
    Raster xx = map.strength, yy = xx, xy = xx;
    for (const Slopes& s : slopes)
        in_batches(parallel, xx.samples.size(), [&](std::size_t i) {
            xx.samples[i] += s.x.samples[i] * s.x.samples[i];
            yy.samples[i] += s.y.samples[i] * s.y.samples[i];
            xy.samples[i] += s.x.samples[i] * s.y.samples[i];
        });
    xx = blurred(xx, kTensorSigma, parallel);
    yy = blurred(yy, kTensorSigma, parallel);
    xy = blurred(xy, kTensorSigma, parallel);
    in_batches(parallel, xx.samples.size(), [&](std::size_t i) {
        // The directions along and across an edge are at 90 degrees, so twice their angles point in opposite directions.
        const Vec2 d = half_angle(yy.samples[i] - xx.samples[i], -2.0f * xy.samples[i]);
        xx.samples[i] += yy.samples[i];
        map.along_x.samples[i] = d.x;
        map.along_y.samples[i] = d.y;
    });
    return xx;
}

float alone(float around, float strength, float inhibition)
{
    return std::min(1.0f, kAlone - inhibition * around / std::max(strength, 1e-3f));
}

/// How far a border counts, 0..1.
float lasting(float survived)
{
    if (survived <= kLasting)
        return 0.0f;
    return std::min(1.0f, float(elementary::log2(double(survived / kLasting))) / kDoublings);
}

using Sums = std::array<float, 3>;

float length_of(const Sums& v)
{
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

}  // namespace

LineMap edges_of(const Study& study, const ParallelFor& parallel)
{
    const int w = study.borders.width, h = study.borders.height;
    std::vector<Slopes> features, base;
    for (std::size_t c = 0; c < study.features.size(); ++c) {
        features.push_back(slopes_of(study.features[c], parallel));
        base.push_back(slopes_of(study.base[c], parallel));
    }
    LineMap map = empty_map(w, h);
    const Raster energy = find_directions(features, parallel, map);
    const auto weights = bell<kAlong>(kAlongSigma);
    Raster of_base = map.strength;
    // Slopes are averaged with their signs, channel by channel, so that the slopes of texture cancel.
    for_rows(parallel, 0, h, [&](int y) {
        for (int x = 0; x < w; ++x) {
            const std::size_t centre = std::size_t(y) * std::size_t(w) + std::size_t(x);
            if (energy.samples[centre] < kLeastEnergy)
                continue;
            Sums sums {}, base_sums {};
            const float total = walk_along(map, x, y, weights, [&](std::size_t at, Vec2 n, float weight) {
                for (std::size_t c = 0; c < features.size(); ++c) {
                    sums[c] += weight * (n.x * features[c].x.samples[at] + n.y * features[c].y.samples[at]);
                    base_sums[c] += weight * (n.x * base[c].x.samples[at] + n.y * base[c].y.samples[at]);
                }
            });
            const float scale = 1.0f / (total * std::sqrt(float(features.size())));
            map.strength.samples[centre] = scale * length_of(sums);
            of_base.samples[centre] = scale * length_of(base_sums);
        }
    });
    const Raster around = blurred(map.strength, kAround, parallel);
    in_batches(parallel, map.strength.samples.size(), [&](std::size_t i) {
        const float slope = map.strength.samples[i];
        if (slope <= 0.0f)
            return;
        const float lasts = lasting(study.borders.samples[i]);
        const float share =
            std::max({ alone(around.samples[i], slope, kInhibition), kLeastAlone, kBorderAlone * lasts });
        const float carried = kCarried * lasts * std::min(1.0f, kCarriedFrom * slope);
        map.importance.samples[i] =
            std::max(carried, share * std::sqrt(slope * std::max(of_base.samples[i], lasts * slope)));
    });
    return map;
}

LineMap thin_lines_of(const Study& study, bool light, const ParallelFor& parallel)
{
    const int w = study.borders.width, h = study.borders.height;
    const float sign = light ? -1.0f : 1.0f;
    const Raster mean = blurred(study.mean, kSlopeSigma, parallel);
    LineMap map = empty_map(w, h);
    Raster depth = map.strength;
    for_neighbours(mean, parallel,
                   [&](std::size_t at, const float* p, std::ptrdiff_t left, std::ptrdiff_t right, std::ptrdiff_t up,
                       std::ptrdiff_t down) {
                       const float xx = sign * (p[left] - 2.0f * p[0] + p[right]);
                       const float yy = sign * (p[up] - 2.0f * p[0] + p[down]);
                       const float xy =
                           0.25f * sign * (p[up + left] + p[down + right] - p[up + right] - p[down + left]);
                       const Vec2 d = half_angle(yy - xx, -2.0f * xy);
                       map.along_x.samples[at] = d.x;
                       map.along_y.samples[at] = d.y;
                   });
    // Both sides must be lighter: beside an edge, the bend alone would do.
    for_rows(parallel, 0, h, [&](int y) {
        for (int x = 0; x < w; ++x) {
            const Vec2 p { float(x), float(y) }, d = map.along(p);
            const float left = between(mean, { p.x - kBeside * d.y, p.y + kBeside * d.x });
            const float right = between(mean, { p.x + kBeside * d.y, p.y - kBeside * d.x });
            const float here = nearest(mean, p);
            depth.samples[pixel_at(depth, p)] = std::min(sign * (left - here), sign * (right - here));
        }
    });
    const auto weights = bell<kFarAlong>(kFarAlongSigma);
    for_rows(parallel, 0, h, [&](int y) {
        for (int x = 0; x < w; ++x) {
            const std::size_t centre = std::size_t(y) * std::size_t(w) + std::size_t(x);
            if (depth.samples[centre] < kLeastDepth)
                continue;
            float sum = 0.0f;
            const float total = walk_along(map, x, y, weights, [&](std::size_t at, Vec2, float weight) {
                sum += weight * std::min(depth.samples[at], 2.0f * depth.samples[centre]);
            });
            map.strength.samples[centre] = std::max(0.0f, sum / total);
        }
    });
    const Raster around = blurred(map.strength, kAround, parallel);
    in_batches(parallel, map.strength.samples.size(), [&](std::size_t i) {
        const float strength = map.strength.samples[i];
        map.importance.samples[i] =
            kThinCounts * strength * std::max(0.0f, alone(around.samples[i], strength, kThinInhibition));
    });
    return map;
}

}  // namespace PIMG_ABI
}  // namespace pimg
