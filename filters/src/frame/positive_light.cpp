// SPDX-License-Identifier: BSD-3-Clause
#include "frame/positive_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// What is known of the piece of a vertex.
struct Piece {
    double inverse_sum = 0.0;  ///< of 1 / sample; infinite if one is not above 0
    double count = 0.0;
    float least = std::numeric_limits<float>::max();

    void add(float sample)
    {
        inverse_sum += sample > 0.0f ? 1.0 / double(sample) : std::numeric_limits<double>::infinity();
        count += 1.0;
        least = std::min(least, sample);
    }
};

/// For each mesh pixel that is a vertex, the vertex of `level` whose piece it is in; kGhost for the others.
std::vector<Index> pieces_of_pixels(const Hierarchy& h, Level level)
{
    std::vector<Index> piece(h.vertices()), of_pixels(h.mesh_pixels(), kGhost);
    const Index coarse = h.base_vertices() + level;
    for (Index v = 0; v < h.vertices(); ++v) {
        if (v % kBetweenStops == 0)
            stop_point();
        piece[v] = v < coarse ? v : piece[h.splits[v - h.base_vertices()].s];
        of_pixels[h.pixels[v]] = piece[v];
    }
    return of_pixels;
}

/// Of one channel of the source, times 2^-exponent, for the vertices of `level`. Pixels are taken row by row: those of a
/// piece are neighbours, but the vertices are in no order in memory.
std::vector<Piece> sums_over_pieces(const ProgressiveImage::Data& data, int channel, int exponent,
                                    const std::vector<Index>& of_pixels, Level level)
{
    const Hierarchy& h = data.hierarchy;
    const float factor = std::ldexp(1.0f, -exponent);
    const std::size_t stride = std::size_t(data.source.nchannels());
    std::vector<Piece> sums(h.base_vertices() + level);
    const Index* piece = of_pixels.data();
    for (int y = 0; y < h.mesh_height(); ++y) {
        const std::size_t row = std::size_t(std::min(y, h.height - 1)) * std::size_t(h.width);
        const float* source = static_cast<const float*>(data.source.localpixels()) + row * stride + channel;
        for (int x = 0; x < h.mesh_width(); ++x, ++piece)
            if (*piece != kGhost)
                sums[*piece].add(factor * source[std::size_t(std::min(x, h.width - 1)) * stride]);
    }
    return sums;
}

/// The least sample of the source around pixel (x, y), itself included.
float least_around(const ProgressiveImage::Data& data, int channel, int x, int y)
{
    const OIIO::ImageSpec& spec = data.source.spec();
    float least = std::numeric_limits<float>::max();
    for (int j = std::max(y - 1, 0); j < std::min(y + 2, spec.height); ++j)
        for (int i = std::max(x - 1, 0); i < std::min(x + 2, spec.width); ++i) {
            const void* pixel = data.source.pixeladdr(spec.x + i, spec.y + j);
            least = std::min(least, static_cast<const float*>(pixel)[channel]);
        }
    return least;
}

}  // namespace

float raised_to_shade(float value, float expected)
{
    const float share = value / expected;
    // A hyperbola that has slope 1 at the knee, like the line above, and tends to half of the knee.
    return expected * (0.5f * kKnee + 0.25f * kKnee * kKnee / (1.5f * kKnee - share));
}

void shade_vertices(const ProgressiveImage::Data& data, int exponent, Level level, const ParallelFor& parallel,
                    Channels& values)
{
    const std::vector<Index> pieces = pieces_of_pixels(data.hierarchy, level);
    run(parallel, values.size(), [&](std::size_t c) {
        const std::vector<Piece> sums = sums_over_pieces(data, data.colour.channel(int(c)), exponent, pieces, level);
        for (std::size_t v = 0; v < sums.size(); ++v) {
            const Piece& piece = sums[v];
            const float expected = float(piece.count / piece.inverse_sum);
            float& value = values[c][v];
            value = expected > 0.0f ? shaded(value, expected) : std::max(value, std::min(piece.least, 0.0f));
        }
    });
}

bool is_scene_linear(const ProgressiveImage::Data& data)
{
    return !data.colour.encoded() && !data.whole_numbers;
}

void bound_below(const ProgressiveImage::Data& data, const ParallelFor& parallel, Channels& results)
{
    if (!is_scene_linear(data))
        return;
    const std::size_t width = std::size_t(data.spec.width);
    for (std::size_t c = 0; c < results.size(); ++c) {
        const int channel = data.colour.channel(int(c));
        for_rows(parallel, 0, data.spec.height, [&](int y) {
            float* row = &results[c][std::size_t(y) * width];
            for (std::size_t x = 0; x < width; ++x)
                if (row[x] < 0.0f)
                    row[x] = std::max(row[x], std::min(0.0f, least_around(data, channel, int(x), y)));
        });
    }
}

}  // namespace PIMG_ABI
}  // namespace pimg
