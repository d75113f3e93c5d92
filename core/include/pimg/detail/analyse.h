// SPDX-License-Identifier: BSD-3-Clause
// The last step of analysis, which simplification and the reader of files share with analyse().
#pragma once

#include <pimg/bands.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Turns values into details. On entry bands.details holds the values of t and u of every split. From each the function
/// subtracts what the coarser mesh predicts there. It also fills the residual from the channel's samples, one per mesh
/// pixel. Predictions are made from the values that synthesis will compute, so that rounding errors do not add up over
/// the levels.
PIMG_EXPORT_DETAIL void subtract_predictions(const Hierarchy& hierarchy, const float* samples, Bands& bands);

}  // namespace PIMG_ABI
}  // namespace pimg
