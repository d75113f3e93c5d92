// SPDX-License-Identifier: BSD-3-Clause
// Loops of the engine on OpenImageIO's thread pool.
#pragma once

#include <functional>

#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Returns a loop that uses up to `nthreads` threads of OpenImageIO's pool, the calling thread among them; 0 =
/// OpenImageIO's "threads" attribute. Inside a task of the pool, it runs on the calling thread alone. While the calling
/// thread waits, it never takes up another task of the pool; so it may hold a lock. An exception of a body ends the loop,
/// which then throws it again.
PIMG_EXPORT ParallelFor pool_loop(int nthreads);

/// Calls body() on this thread, for callers that hold a lock while they use functions of OpenImageIO. Inside it,
/// OpenImageIO's own parallel loops run on this thread alone; so none of them waits for the pool and takes up a task of
/// somebody else meanwhile. Loops of pool_loop() still use the pool. Throws what the body throws.
PIMG_EXPORT void run_without_foreign_tasks(const std::function<void()>& body);

}  // namespace PIMG_ABI
}  // namespace pimg
