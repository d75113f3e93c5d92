// SPDX-License-Identifier: BSD-3-Clause
// Loops over rows in OpenImageIO's thread pool.
#pragma once

#include <functional>

#include <pimg/threads.h>

namespace pimg {

/// Calls body(y) for every y in [begin, end), several rows to a task.
void for_rows(const ParallelFor& parallel, int begin, int end, const std::function<void(int)>& body);

}  // namespace pimg
