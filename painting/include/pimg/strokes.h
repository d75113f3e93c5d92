// SPDX-License-Identifier: BSD-3-Clause
// Where the brush strokes of a painting go (paper, section 5.2). There is one for every base vertex and for both vertices
// of every split. Its dual piece gives its place and size. Strokes are painted from coarse to fine.
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
inline namespace PIMG_ABI {

/// The dual piece of a vertex as the paper draws it: the polygon through the centres of the triangles around it, in order,
/// in pixels. That of a border vertex also passes through the middles of its two border edges and through itself.
PIMG_EXPORT std::vector<Vec2> piece_polygon(const Mesh& mesh, Index vertex);

/// A place for one stroke: a rectangle with the area of a piece, as long as the piece is along the edges.
struct Dab {
    Vec2 centre;
    float width, length;  ///< in pixels, across and along the direction field
    Index vertex;         ///< whose piece it is
    Level level;          ///< level at which the piece was measured; 0 for base vertices
};

/// Which dabs are wanted.
struct PIMG_EXPORT DabOptions {
    float min = 3.0f, max = 32.0f;  ///< narrowest and widest dab in pixels; others are left out
    /// A map, row-major, of the picture's size, with values m of 0..1, by which the range of widths is multiplied by
    /// 4^(1 - 2 m): 1 asks for strokes a quarter as wide, 0 for strokes four times as wide, and 0.5 changes nothing.
    /// Null: none.
    const float* detail = nullptr;
    Level last = kGhost;  ///< splits after this level are not replayed; above the finest: all are

    /// The factor that `detail` gives at place `p` of a picture of the given size; 1 without a map.
    float scale(Vec2 p, int width, int height) const;
};

/// Replays all splits, and measures the pieces of the base vertices and of both vertices of every split. A piece that is
/// too large is measured again whenever a split next to it changes it, until it fits, so that no part of the picture is
/// left without a dab. `dabs` are in the order of the splits. Fails only on a damaged hierarchy.
PIMG_EXPORT Status collect_dabs(const Hierarchy& hierarchy, const DirectionField& field, const DabOptions& options,
                                std::vector<Dab>& dabs);

/// One stroke: a brush drawn along a polyline.
struct Stroke {
    Index first = 0, count = 0;   ///< its points in Strokes::points: from `first` on, `count` of them, 2 or more
    float width = 0.0f;           ///< of the brush in pixels
    Index vertex = kGhost;        ///< the vertex it stands for; kGhost if it only covers canvas
    Level level = 0;              ///< level at which its piece was measured
    std::uint32_t variation = 0;  ///< random bits; plan_strokes() makes them of place, size and seed, except for gaps
    float opacity = 1.0f;         ///< 0..1: how much of its paint the stroke leaves
};

/// Strokes in the order in which they are painted. A stroke reaches half its width beyond the ends of its polyline.
struct Strokes {
    int width = 0, height = 0;  ///< size of the picture in pixels
    std::vector<Stroke> strokes;
    std::vector<Vec2> points;  ///< those of all strokes

    const Vec2* begin(const Stroke& s) const { return points.data() + s.first; }
};

/// How strokes are planned.
struct StrokeOptions : DabOptions {
    float length = 1.0f;  ///< factor on the length of strokes, which is about four widths, 0..10
    /// Mean improvement of the picture by a stroke, in 8-bit steps, from which on it is painted: thinly at first, and fully
    /// from twice as much on. 0: all are painted.
    float tolerance = 3.0f;
    float cover = 1.0f;         ///< share of the places that get a stroke, 0..1; below 1, gaps are left
    float crossing = 14.0f;     ///< colour difference that no stroke runs across, in 8-bit steps
    float jitter_angle = 0.0f;  ///< largest random turn, as a share 0..1 of 45 degrees
    float jitter_size = 0.0f;   ///< largest random change of the width, as a share 0..1 of it
    std::uint32_t seed = 1;     ///< another seed gives other random changes
    ParallelFor parallel;       ///< the result does not depend on it
};

/// Plans the strokes of a painting. `guides` are up to three channels in units of one step of an 8-bit picture; strokes
/// do not run across differences in them. Fails only on a damaged hierarchy.
PIMG_EXPORT Status plan_strokes(const Hierarchy& hierarchy, const ChannelsView& guides, const DirectionField& field,
                                const StrokeOptions& options, Strokes& strokes);

/// The colour of every stroke in each channel of `picture`: entry [c][i] is that of channel c and stroke i. It is the mean
/// of those samples under the stroke's middle line whose `guides` are like those at its centre, so it lies within the
/// range of the samples.
PIMG_EXPORT std::vector<std::vector<float>> stroke_colours(const Strokes& strokes, const ChannelsView& picture,
                                                           const ChannelsView& guides,
                                                           const ParallelFor& parallel = {});

[[deprecated("renamed: stroke_colours()")]] inline std::vector<std::vector<float>> stroke_colors(
    const Strokes& strokes, const ChannelsView& picture, const ChannelsView& guides, const ParallelFor& parallel = {})
{
    return stroke_colours(strokes, picture, guides, parallel);
}

/// Mixes the bits of a number. Equal numbers give equal results. All randomness of the library comes from here.
inline std::uint32_t scramble(std::uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/// Random bits as a number in -1..1.
inline float signed_unit(std::uint32_t bits)
{
    return float(bits >> 8) * (2.0f / 16777215.0f) - 1.0f;
}

}  // namespace PIMG_ABI
}  // namespace pimg
