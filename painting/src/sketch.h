// SPDX-License-Identifier: BSD-3-Clause
// A small picture of the painting in progress, to judge strokes by before they are really painted.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <pimg/strokes.h>

namespace pimg {
inline namespace PIMG_ABI {

/// A colour in guide units; channels the guides do not have are 0.
using Shade = std::array<float, 3>;

/// Root mean square difference over `channels`.
inline float difference(const Shade& a, const Shade& b, float per_channel)
{
    const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return std::sqrt((x * x + y * y + z * z) * per_channel);
}

/// Guides with a little smoothing (sigma one pixel), interleaved for quick reading at any place. It may be smaller than the
/// guides; places are in pixels of the guides all the same.
class ShadePicture {
    static constexpr std::size_t kChannels = std::tuple_size<Shade>::value;

public:
    explicit ShadePicture(const ChannelsView& guides, const ParallelFor& parallel);

    /// The same at half the resolution.
    ShadePicture half(const ParallelFor& parallel) const;

    /// That of the nearest pixel.
    const Shade& at(Vec2 p) const
    {
        const Vec2 q = own(p);
        const int x = q.x > 0.0f ? int(q.x + 0.5f) : 0, y = q.y > 0.0f ? int(q.y + 0.5f) : 0;
        return pixel(x < m_width ? x : m_width - 1, y < m_height ? y : m_height - 1);
    }
    /// Bilinear.
    Shade between(Vec2 p) const;
    const Shade& pixel(int x, int y) const { return m_shades[std::size_t(y) * std::size_t(m_width) + std::size_t(x)]; }
    /// Difference between the two sides of an edge through the pixel; small where there is none.
    float contrast(int x, int y) const;

    float distance(const Shade& a, const Shade& b) const { return difference(a, b, m_per_channel); }
    int width() const { return m_width; }
    int height() const { return m_height; }
    /// Pixels of the guides that are one pixel of this picture, across.
    int shrunk() const { return m_shrunk; }

private:
    ShadePicture(int width, int height, int shrunk, float per_channel);
    Vec2 own(Vec2 p) const { return { (p.x + 0.5f) * m_inverse - 0.5f, (p.y + 0.5f) * m_inverse - 0.5f }; }

    int m_width, m_height, m_shrunk = 1;
    float m_per_channel, m_inverse = 1.0f;
    std::vector<Shade> m_shades;
};

/// Shade pictures at all resolutions that strokes need.
class ShadePyramid {
public:
    explicit ShadePyramid(const ChannelsView& guides, const ParallelFor& parallel);

    const ShadePicture& finest() const { return m_levels[0]; }
    /// The picture by which a stroke of that width is planned.
    const ShadePicture& for_width(float width) const;

private:
    std::vector<ShadePicture> m_levels;
};

/// The canvas in cells of some pixels: what the picture has there and what has been painted.
class Sketch {
public:
    Sketch(const ShadePicture& picture, int cell);

    /// What a stroke would improve: the mean of |picture - painted| - |picture - shade| over the cells under it, where
    /// |picture - painted| is `bare` for cells without paint. Negative if the stroke would do harm.
    float gain(const Vec2* points, int count, float width, const Shade& shade, float bare) const;
    void put(const Vec2* points, int count, float width, const Shade& shade, float opacity);
    /// Paints the cells under a stroke that have no paint yet, as if the stroke were put below all others.
    void put_below(const Vec2* points, int count, float width, const Shade& shade);

    bool is_covered(Vec2 p) const;
    /// Centres, in pixels, of cells nothing has been painted on.
    std::vector<Vec2> bare_cells() const;

private:
    template<class Visit>
    void visit(const Vec2* points, int count, float width, Visit&& visit) const;

    const ShadePicture& m_picture;
    int m_cell, m_columns, m_rows;
    std::vector<Shade> m_wanted, m_painted;
    std::vector<char> m_covered;
};

}  // namespace PIMG_ABI
}  // namespace pimg
