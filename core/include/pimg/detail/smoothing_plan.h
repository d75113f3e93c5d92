// SPDX-License-Identifier: BSD-3-Clause
// Smoothing with many strengths.
#pragma once

#include <memory>

#include <pimg/detail/sweep_plan.h>
#include <pimg/smoothing.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Puts what `source` has for each split into the order of the plan, so that a strength takes a fraction of the time. The
/// results are the same.
PIMG_EXPORT_DETAIL void plan_sweeps(std::shared_ptr<const SweepPlan> plan, SmoothingSource& source,
                                    const ParallelFor& parallel = {});

}  // namespace PIMG_ABI
}  // namespace pimg
