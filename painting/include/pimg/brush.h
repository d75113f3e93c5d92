// SPDX-License-Identifier: BSD-3-Clause
// Brushes: what one stroke leaves on the canvas, as a mask over (along, across).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pimg {

/// Paint at one place of a stroke.
struct Paint {
    float alpha;   ///< share of the canvas it covers, 0..1
    float height;  ///< thickness, 0..1; also makes the paint a little lighter or darker
};

/// A mask with a few variants, so that strokes are not all alike, and coarser copies of each, so that small strokes are
/// anti-aliased. Its columns run along the stroke, its rows across. The first and last quarter
/// are the stroke's ends, each as long as the stroke is wide; the middle is stretched.
class Brush {
public:
    static constexpr int kColumns = 128, kRows = 64;

    /// round, flat, bristle or knife; an empty brush for any other name.
    static Brush named(const std::string& name);

    /// From a picture: `alpha` and `height` are row-major, width x height; either may be null (then height is flat, or
    /// alpha is what the height says). Stretched over the whole stroke without keeping its ends.
    static Brush from_picture(int width, int height, const float* alpha, const float* heights);

    /// Whether there is such a brush, and what to call the choices.
    bool empty() const { return m_levels.empty(); }
    static const char* names() { return "round|flat|bristle|knife"; }

    /// Share by which the colour follows the height: paint of height h is 1 + grain (h - 1/2) times as bright.
    float grain() const { return m_grain; }
    bool stretched() const { return m_stretched; }

    /// One variant at one resolution.
    struct Mask {
        int columns, rows;
        const Paint* paint;  ///< row-major

        /// Bilinear; along and across in 0..1.
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

    /// The mask for a stroke `width` pixels wide; `variation` picks the variant.
    Mask mask(float width, std::uint32_t variation) const;

private:
    void add_variant(std::vector<Paint> finest);

    float m_grain = 0.0f;
    bool m_stretched = false;
    int m_variants = 0;
    std::vector<std::vector<std::vector<Paint>>> m_levels;  ///< [variant][level]
};

}  // namespace pimg
