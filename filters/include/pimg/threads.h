// SPDX-License-Identifier: BSD-3-Clause
// OpenImageIO's thread pool for the engine.
#pragma once

#include <functional>

#include <pimg/types.h>

namespace pimg {

/// Loops that use up to `nthreads` threads of OpenImageIO's pool, the calling thread among them; 0 = OpenImageIO's
/// "threads" attribute. Within a task of the pool they run on the calling thread alone. The calling thread never takes
/// up any other task of the pool while it waits, so it may hold a lock. An exception of a body ends the loop and is
/// thrown again by it.
ParallelFor pool_loop(int nthreads);

/// Calls body() on this thread. OpenImageIO's own parallel loops in it run on this thread alone, so that none of them
/// waits for the pool and takes up a foreign task meanwhile; loops of pool_loop() still use the pool. This is for
/// callers that hold a lock while they use functions of OpenImageIO. Throws what the body throws.
void run_without_foreign_tasks(const std::function<void()>& body);

}  // namespace pimg
