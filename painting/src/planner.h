// SPDX-License-Identifier: BSD-3-Clause
// One stroke, before it is known whether it will be painted: where it runs and how wide it is.
#pragma once

#include "sketch.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Points of a stroke to either side of its middle: at a step of 0.4 widths enough for 19 widths of length.
constexpr int kMostPoints = 24;

/// A stroke being drawn.
struct Draft {
    Vec2 points[2 * kMostPoints + 1];
    int first = kMostPoints, last = kMostPoints;  ///< of `points`, both in use
    float width = 0.0f;
    Shade shade {};
    std::uint32_t variation = 0;
    float opacity = 1.0f;

    const Vec2* begin() const { return points + first; }
    int size() const { return last - first + 1; }
};

/// Where a stroke is wanted.
struct Site {
    Vec2 place;
    float width;              ///< of the brush, in pixels, before chance changes it
    float narrowest, widest;  ///< limits of the width
    std::uint32_t variation;  ///< random bits of the place
};

/// Bends strokes along the edges, and fits them between edges. Large strokes look at a coarser picture than small ones, so that
/// they neither stop at every leaf nor change with the noise.
class Planner {
public:
    Planner(const ShadePyramid& pictures, const DirectionField& field, const StrokeOptions& options)
        : m_pictures(pictures),
          m_field(field),
          m_options(options)
    {
    }

    /// The stroke at a site, about `length` pixels long, ends included.
    Draft draft(const Site& site, float length) const;

private:
    void fit_between_edges(const ShadePicture& picture, Draft& draft, Vec2 along, float least) const;
    void walk(const ShadePicture& picture, Draft& draft, Vec2 along, float reach, int sign) const;

    const ShadePyramid& m_pictures;
    const DirectionField& m_field;
    const StrokeOptions& m_options;
};

}  // namespace PIMG_ABI
}  // namespace pimg
