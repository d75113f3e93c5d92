// SPDX-License-Identifier: BSD-3-Clause
// Brushes. A brush is a mask that says how much paint a stroke leaves at each place along and across it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Paint at one place of a stroke.
struct Paint {
    float alpha;   ///< how much of the canvas it covers, 0..1
    float height;  ///< thickness, 0..1; thicker paint is also a little lighter (Brush::grain)
};

/// A mask. It has a few variants, so that strokes do not all look the same, and coarser copies of each, so that small
/// strokes are anti-aliased. Its columns run along the stroke and its rows across it. The first and the last quarter of
/// the columns are the stroke's ends, each as long as the stroke is wide. The middle is stretched to the stroke's
/// length.
class PIMG_EXPORT Brush {
public:
    static constexpr int kColumns = 128, kRows = 64;  ///< size of the finest mask

    /// One of the brushes that come with pimg: round, flat, bristle, knife, chalk or wash. An empty brush for any other name.
    static Brush named(const std::string& name);

    /// Makes a brush from a picture of width x height pixels, each 1 or more, with one variant. `alpha` and `heights` are
    /// row-major; values are clipped to 0..1. Without `alpha` (null), alpha is what `heights` says. Without `heights`,
    /// the paint is 0.5 thick everywhere. The picture is stretched over the whole stroke, its ends included.
    static Brush from_picture(int width, int height, const float* alpha, const float* heights);

    /// Whether named() knew no such brush.
    bool empty() const { return m_levels.empty(); }
    /// The names that named() knows.
    static const char* names() { return "round|flat|bristle|knife|chalk|wash"; }

    /// How far the brightness of paint follows its height: paint of height h is 1 + grain() (h - 1/2) times as bright.
    float grain() const { return m_grain; }
    /// How far the tooth of the canvas keeps paint off: 0 covers all, 1 only the raised half.
    float tooth() const { return m_tooth; }
    /// Whether the ends are stretched, too, as for brushes from pictures.
    bool stretched() const { return m_stretched; }

    /// One variant at one resolution.
    struct Mask {
        int columns, rows;
        const Paint* paint;  ///< row-major

        /// The paint at a place, interpolated bilinearly. `along` and `across` are 0..1.
        Paint at(float along, float across) const
        {
            const float fx = along * float(columns) - 0.5f, fy = across * float(rows) - 0.5f;
            const float cx = fx < 0.0f ? 0.0f : fx > float(columns - 1) ? float(columns - 1) : fx;
            const float cy = fy < 0.0f ? 0.0f : fy > float(rows - 1) ? float(rows - 1) : fy;
            const int x = int(cx), y = int(cy);
            const float wx = cx - float(x), wy = cy - float(y);
            const Paint* a = paint + y * columns + x;
            const Paint* b = y + 1 < rows ? a + columns : a;
            const int right = x + 1 < columns ? 1 : 0;
            const float wa = (1 - wy) * (1 - wx), wb = (1 - wy) * wx, wc = wy * (1 - wx), wd = wy * wx;
            return { wa * a[0].alpha + wb * a[right].alpha + wc * b[0].alpha + wd * b[right].alpha,
                     wa * a[0].height + wb * a[right].height + wc * b[0].height + wd * b[right].height };
        }
    };

    /// The mask for a stroke of `width` pixels. `variation` may be any number and picks the variant. The brush must not be
    /// empty.
    Mask mask(float width, std::uint32_t variation) const;

private:
    void add_variant(std::vector<Paint> finest);

    float m_grain = 0.0f, m_tooth = 0.0f;
    bool m_stretched = false;
    int m_variants = 0;
    std::vector<std::vector<std::vector<Paint>>> m_levels;  ///< [variant][level]
};

}  // namespace PIMG_ABI
}  // namespace pimg
