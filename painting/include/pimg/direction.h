// SPDX-License-Identifier: BSD-3-Clause
// Which way a painter would move the brush: along the edges, and in flat places as the edges around them
// suggest (paper, section 5.2: directions from the smoothed image gradient).
#pragma once

#include <vector>

#include <pimg/channels.h>
#include <pimg/types.h>

namespace pimg {

/// A place or a direction in pixels, y down; pixel (x, y) has its centre there.
struct Vec2 {
    float x = 0.0f, y = 0.0f;
};

using Planes [[deprecated("use ChannelsView")]] = ChannelsView;

/// A direction without a sign at every place of a picture. Kept at half resolution as (cos 2a, sin 2a) times a
/// certainty, because directions a and a + 180 degrees are the same and must average as such.
class DirectionField {
public:
    /// From `guides`, whose unit is about a step of an 8-bit picture. Colour edges count as much
    /// as edges of brightness: the structure tensors of all channels are added. `noise` is the
    /// gradient, in units per pixel, below which a place is flat and takes its direction from farther away.
    DirectionField(const ChannelsView& guides, const ParallelFor& parallel = {}, float noise = 4.0f);

    /// Unit vector along the edges at `p`, which may lie outside the picture.
    Vec2 at(Vec2 p) const;

    /// How much of the local contrast runs one way, 0..1.
    float certainty(Vec2 p) const;

    int width() const { return m_width; }
    int height() const { return m_height; }

private:
    Vec2 doubled(Vec2 p) const;

    int m_width, m_height;
    int m_columns, m_rows;
    std::vector<Vec2> m_doubled;
};

}  // namespace pimg
