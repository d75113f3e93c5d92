// SPDX-License-Identifier: BSD-3-Clause
// From compressed luminance to what a display shows, on vectors of pixels. Every instruction set gives the same bits.
#pragma once

#include <array>
#include <cstddef>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Display luminance of middle grey.
constexpr float kMiddleGrey = 0.18f;

/// The tone curve of a display, on luminances. The toe takes the haze from shadows; it is y^2 / (y + toe), a
/// subtraction of `toe` that never reaches 0. The shoulder rolls highlights off: the identity up to a knee, then a
/// smooth rise that reaches `most` at `white`.
struct ToneCurve {
    static constexpr float kKnee = 0.3f;
    float toe, white, most, inverse_square;

    /// 0 or more; `most` or more; above kKnee: 1, the white of a picture, is all that an SDR display shows.
    ToneCurve(float toe_luminance, float reaches_most_at, float most_luminance);
};

/// How pixels are given another luminance while they keep their colour.
struct Recolour {
    std::array<float, 3> weights;  ///< of luminance: see Colour::luminance()
    float slope, offset;           ///< log2 of the factor = slope * compressed - guide / kUnitsPerStop + offset
    float saturation;              ///< exponent on the ratio of a channel to luminance
    bool fit;                      ///< whether results fit a display: tone curve, colours moved into its gamut
    ToneCurve curve;
    float read, photon;  ///< variance of the luminance of noise: colour fades where light is no more than that
    bool wide = false;   ///< the gamut is that of Display P3 instead of Rec. 709
};

/// Recolours `count` linear RGB triples in place; with `fit` they are Rec. 709. `compressed` and `guide` are their log luminances after compression
/// and before. Colours that the display cannot show move towards the grey of their luminance, along a line of constant
/// hue in Oklab (B. Ottosson, "A perceptual color space for image processing", 2020). Colours near the limits of the
/// display move a little, too, so that no edge shows where a channel reaches its maximum.
void recolour(const Recolour& how, const float* compressed, const float* guide, std::size_t count, float* rgb);

/// Replaces log2 of display luminances by the cube roots of what the tone curve makes of them: lightness, apart from
/// constants.
void lightness_in_place(const ToneCurve& curve, float* stops, std::size_t count);

}  // namespace PIMG_ABI
}  // namespace pimg
