// SPDX-License-Identifier: BSD-3-Clause
// The part of analysis that a reader of files and simplification share with it.
#pragma once

#include <pimg/bands.h>

namespace pimg {

/// Subtracts from the values of all t and u what the coarser meshes predict: on entry they stand in bands.details; on
/// return the details do. It also fills the residual from the channel's samples, one per mesh pixel. Predictions are made
/// from the values that synthesis will compute, so that rounding errors do not add up over the levels.
void subtract_predictions(const Hierarchy& hierarchy, const float* samples, Bands& bands);

}  // namespace pimg
