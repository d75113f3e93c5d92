// SPDX-License-Identifier: BSD-3-Clause
// When a filter changes nothing, so that a host need not render it.
#pragma once

#include "instance.h"

namespace pimg_ofx {

/// Whether the result at `time` is the source, bit for bit, because of the options.
bool is_identity(const Instance& instance, OfxTime time);

}  // namespace pimg_ofx
