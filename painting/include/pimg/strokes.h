// SPDX-License-Identifier: BSD-3-Clause
// Where the brush strokes of a painting go (paper, section 5.2): one for every base vertex and for the two
// vertices of every split, each placed and sized by its dual piece, laid from coarse to fine.
//
//   hierarchy --replay--> dabs --coarse first--> bend along edges --> keep what improves the picture --> strokes
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <pimg/direction.h>
#include <pimg/hierarchy.h>
#include <pimg/types.h>

namespace pimg {

/// Dual piece of a vertex as the paper draws it: the polyline through the centres of the triangles around it. A
/// border vertex adds itself and the middles of its two border edges. In order, pixels.
std::vector<Vec2> piece_polygon(const Mesh& mesh, Index vertex);

/// What a piece offers a brush: a rectangle of the piece's area, as long as the piece is along the edges.
struct Dab {
    Vec2 centre;
    float width, length;  ///< across and along the direction field, pixels
    Index vertex;
    Level level;  ///< splits applied when the piece was measured; 0 for base vertices
};

struct DabOptions {
    float min = 3.0f, max = 32.0f;  ///< range of the width in pixels; nothing outside it is returned
    /// Detail map, row-major, size of the picture, 0..1, or null: the range is scaled by 4^(1 - 2 m), so that
    /// 1 asks for strokes a quarter of the size, 0 for four times, 0.5 leaves it alone.
    const float* detail = nullptr;

    /// Factor on the range at `p` of a picture of the given size.
    float scale(Vec2 p, int width, int height) const;
};

/// Replays the splits and measures the pieces of the base vertices and of both vertices of every split. A piece
/// still too large is measured again whenever a split near it changes it, until it fits: so no part of the
/// picture is left without a dab. In order of the splits.
Status collect_dabs(const Hierarchy& hierarchy, const DirectionField& field, const DabOptions& options,
                    std::vector<Dab>& dabs);

/// One stroke: a brush drawn along a polyline.
struct Stroke {
    Index first = 0, count = 0;  ///< its points in Strokes::points; at least 2
    float width = 0.0f;          ///< of the brush, pixels
    Index vertex = kGhost;       ///< it stands for; kGhost for one that only covers what others left
    Level level = 0;
    std::uint32_t variation = 0;  ///< random bits of its own; the same place has the same in any frame
};

/// Strokes in the order they are painted. The ends of a brush stand half a width beyond the ends of its polyline.
struct Strokes {
    int width = 0, height = 0;  ///< of the picture
    std::vector<Stroke> strokes;
    std::vector<Vec2> points;

    const Vec2* begin(const Stroke& s) const { return points.data() + s.first; }
};

struct StrokeOptions : DabOptions {
    float length = 1.0f;        ///< factor on the length pieces suggest, 0..10
    float tolerance = 3.0f;     ///< least mean improvement over what is already painted, 8-bit units; 0 paints all
    float crossing = 14.0f;     ///< colour difference no stroke runs across, 8-bit units
    float jitter_angle = 0.0f;  ///< 0..1: largest random turn as a share of 45 degrees
    float jitter_size = 0.0f;   ///< 0..1: largest random change of the width, as a share of it
    std::uint32_t seed = 1;
    ParallelFor parallel;
};

/// Plans the strokes of a painting. `guides` are up to three channels in steps of an 8-bit picture: what
/// they tell apart, strokes keep apart.
Status plan_strokes(const Hierarchy& hierarchy, const ChannelsView& guides, const DirectionField& field,
                    const StrokeOptions& options, Strokes& strokes);

/// Colour of every stroke on each channel of `picture`: the mean of the samples under its middle line that are
/// like those at its centre by `guides`. colours[c][i] is of channel c, stroke i. Never leaves the samples' range.
std::vector<std::vector<float>> stroke_colors(const Strokes& strokes, const ChannelsView& picture,
                                              const ChannelsView& guides, const ParallelFor& parallel = {});

/// Mixes the bits of a number: equal numbers give equal results. It is the library's only source of randomness.
inline std::uint32_t scramble(std::uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/// `bits` as a number in -1..1.
inline float signed_unit(std::uint32_t bits)
{
    return float(bits >> 8) * (2.0f / 16777215.0f) - 1.0f;
}

}  // namespace pimg
