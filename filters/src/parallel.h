// SPDX-License-Identifier: BSD-3-Clause
// OpenImageIO's thread pool for the engine and for loops over rows.
#pragma once

#include <pimg/types.h>

namespace pimg {

/// Loops that use up to `nthreads` threads of OpenImageIO's pool; 0 = its "threads" attribute.
ParallelFor pool_loop(int nthreads);

/// Calls body(y) for every y in [begin, end), several rows to a task.
void for_rows(const ParallelFor& parallel, int begin, int end, const std::function<void(int)>& body);

}  // namespace pimg
