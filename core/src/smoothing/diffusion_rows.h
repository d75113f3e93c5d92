// SPDX-License-Identifier: BSD-3-Clause
// What diffusion does with rows, in vectors. Every instruction set gives the same bits.
#pragma once

#include <cstddef>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Adds (b - a)^2 to the sums of `count` pixels.
void add_squares(const float* a, const float* b, std::size_t count, float* sums);

/// Turns `count` squared differences d^2 of the guide into conductances 1 / (1 + scale d^2)^2.
void to_conductances(float scale, std::size_t count, float* squares);

/// A row that diffuses, the rows around it, and the conductances of the edges between them. right[-1] is read, too, and
/// row[-1] and row[count].
struct DiffusingRow {
    const float *row, *above, *below;
    const float *right, *up, *down;
};

/// One step of the given length; `to` receives the row after it.
void diffuse_row(const DiffusingRow& rows, float length, std::size_t count, float* to);

/// guide + share (picture - guide)
void mix_rows(const float* guide, const float* picture, float share, std::size_t count, float* to);

}  // namespace PIMG_ABI
}  // namespace pimg
