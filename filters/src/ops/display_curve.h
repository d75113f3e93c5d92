// SPDX-License-Identifier: BSD-3-Clause
// From compressed luminance to what a display shows, on vectors of pixels. Every instruction set gives the same bits.
#pragma once

#include <array>
#include <cstddef>

namespace pimg {

/// Display luminance of middle grey.
constexpr float kMiddleGrey = 0.18f;

/// Rolls highlights off: the identity up to a knee, then a smooth rise that reaches 1 at `white`.
struct Shoulder {
    static constexpr float kKnee = 0.6f;
    float white, inverse_square;

    explicit Shoulder(float reaches_one_at);  ///< 1 or more
};

/// How pixels get another luminance and keep their colour.
struct Recolour {
    std::array<float, 3> weights;  ///< of luminance: see Colour::luminance()
    float slope, offset;           ///< log2 of the factor = slope * compressed - guide / kUnitsPerStop + offset
    float saturation;
    bool fit;  ///< to the display's range: shoulder, and mixed with grey of that luminance until in gamut
    Shoulder shoulder;
};

/// Recolours `count` linear RGB triples in place, from their compressed and their scene's log luminances.
void recolour(const Recolour& how, const float* compressed, const float* guide, std::size_t count, float* rgb);

/// From log2 of display luminances, before the shoulder, to their cube roots behind it, which are lightness but for
/// constants.
void lightness_in_place(const Shoulder& shoulder, float* stops, std::size_t count);

}  // namespace pimg
