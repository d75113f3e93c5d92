// SPDX-License-Identifier: BSD-3-Clause
// Which way a painter would move the brush: along the edges, and in flat places in the direction that the edges around
// them suggest (paper, section 5.2: directions from the smoothed image gradient).
#pragma once

#include <vector>

#include <pimg/channels.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// A place or a direction, in pixels, y down. The centre of pixel (x, y) is at (x, y).
struct Vec2 {
    float x = 0.0f, y = 0.0f;
};

using Planes [[deprecated("use ChannelsView")]] = ChannelsView;

/// A direction at every place of a picture. Directions have no sign: a and a + 180 degrees are the same. To be averaged
/// correctly, they are stored as (cos 2a, sin 2a) times a certainty, at half the picture's resolution.
class PIMG_EXPORT DirectionField {
public:
    /// Finds the directions of `guides`: one or more channels of finite samples in units of about one step of an 8-bit
    /// picture. Edges of colour count as much as edges of brightness, since the structure tensors of all channels are
    /// added. `noise` is a gradient in units per pixel: a place with less counts as flat, and takes its direction from
    /// farther away. The result does not depend on `parallel`.
    DirectionField(const ChannelsView& guides, const ParallelFor& parallel = {}, float noise = 4.0f);

    /// The unit vector along the edges at `p`, which may lie outside the picture.
    Vec2 at(Vec2 p) const;

    /// How clear the direction at `p` is: 0 if there is none, 1 if all contrast around runs one way.
    float certainty(Vec2 p) const;

    int width() const { return m_width; }
    int height() const { return m_height; }

private:
    Vec2 doubled(Vec2 p) const;

    int m_width, m_height;
    int m_columns, m_rows;
    std::vector<Vec2> m_doubled;
};

}  // namespace PIMG_ABI
}  // namespace pimg
