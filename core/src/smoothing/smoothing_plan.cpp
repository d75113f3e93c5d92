// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/smoothing_plan.h>

#include <utility>

namespace pimg {
inline namespace PIMG_ABI {

void plan_sweeps(std::shared_ptr<const SweepPlan> plan, SmoothingSource& source, const ParallelFor& parallel)
{
    for (PieceMeans& means : source.means)
        means.splits = plan->in_order(means.splits, parallel);
    source.evidence = plan->in_order(source.evidence, parallel);
    source.plan = std::move(plan);
}

}  // namespace PIMG_ABI
}  // namespace pimg
