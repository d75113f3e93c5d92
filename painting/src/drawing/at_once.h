// SPDX-License-Identifier: BSD-3-Clause
// Planning a drawing has steps that go on from line to line or from merge to merge, which threads cannot share.
#pragma once

#include <pimg/detail/parallel.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Does two different things, at once if there are threads for it. They must not use `parallel` themselves.
template<class First, class Second>
void at_once(const ParallelFor& parallel, First&& first, Second&& second)
{
    run(parallel, 2, [&](std::size_t task) { task == 0 ? first() : second(); });
}

}  // namespace PIMG_ABI
}  // namespace pimg
