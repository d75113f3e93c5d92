// SPDX-License-Identifier: BSD-3-Clause
#include "frame/positive_light.h"

#include <algorithm>
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
    float least = 0.0f;

    explicit Piece(float sample)
        : inverse_sum(sample > 0.0f ? 1.0 / double(sample) : std::numeric_limits<double>::infinity()),
          count(1.0),
          least(sample)
    {
    }

    void add(const Piece& other)
    {
        inverse_sum += other.inverse_sum;
        count += other.count;
        least = std::min(least, other.least);
    }
};

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

void shade_vertices(const Hierarchy& hierarchy, const Bands& bands, Level level, float* values)
{
    const std::vector<float> finest = values_at(hierarchy, bands, hierarchy.levels());
    std::vector<Piece> pieces(finest.begin(), finest.end());
    const Index made = hierarchy.base_vertices();
    for (Level i = hierarchy.levels(); i-- > level;) {
        if (i % kBetweenStops == 0)
            stop_point();
        pieces[hierarchy.stencils[i].s].add(pieces[made + i]);
    }
    for (Index v = 0; v < made + level; ++v) {
        const Piece& piece = pieces[v];
        const float expected = float(piece.count / piece.inverse_sum);
        values[v] = expected > 0.0f ? shaded(values[v], expected) : std::max(values[v], std::min(piece.least, 0.0f));
    }
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
