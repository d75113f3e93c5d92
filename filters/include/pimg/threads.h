// SPDX-License-Identifier: BSD-3-Clause
// OpenImageIO's thread pool for the engine.
#pragma once

#include <pimg/types.h>

namespace pimg {

/// Loops that use up to `nthreads` threads of OpenImageIO's pool; 0 = its "threads" attribute.
ParallelFor pool_loop(int nthreads);

}  // namespace pimg
