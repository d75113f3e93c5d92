// SPDX-License-Identifier: BSD-3-Clause
// The hatching of a drawing: evenly spaced lines, the closer together the darker it is.
#pragma once

#include <cstdint>

#include <pimg/drawing.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Directions of hatching: those of the large forms of a picture, without its grain, with a preference for a diagonal.
class FormField {
public:
    /// `base` are up to three channels in 8-bit steps. `calm`, 0 or more, is how much the diagonal counts beside a
    /// clear direction of the picture, which counts 1.
    FormField(const std::vector<Raster>& base, float calm, const ParallelFor& parallel);

    /// The unit vector of the direction at p, without a sign.
    Vec2 at(Vec2 p) const;

private:
    Vec2 m_scale;             ///< pixels of the field to one of the picture
    Raster m_cosine, m_sine;  ///< of twice the angle
};

/// One layer of hatching.
struct HatchLayer {
    const Raster* cover = nullptr;  ///< share of the paper that lines are to cover, 0..1; below `least` there are none
    const Raster* stops = nullptr;  ///< above 0 where lines end
    const std::vector<std::uint8_t>* ink_of = nullptr;  ///< ink of each pixel; null: the first
    float turn = 0.0f;                                  ///< angle to the field in radians, 0..pi/2
    float pen = 2.0f;                                   ///< width of the pen in pixels
    float spacing = 2.0f;                               ///< least distance of lines in pens
    float length = 1.0f;                                ///< factor on the length of lines
    float least = 0.04f;
    std::uint32_t seed = 1;
};

/// Adds a layer of lines to a drawing of the rasters' size, as wide as the tone asks for.
void add_hatching(const FormField& field, const HatchLayer& layer, Drawing& drawing);

/// Factor on the width of a line at its k-th of `count` points, which are a pixel apart: the ends of lines taper, the
/// less so the larger the share `cover` of the paper that the drawing is to cover there.
float taper_at(Index k, Index count, float pen, float cover);

}  // namespace PIMG_ABI
}  // namespace pimg
