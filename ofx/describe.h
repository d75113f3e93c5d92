// SPDX-License-Identifier: BSD-3-Clause
// The actions that tell a host what an effect is: describe and describe in context.
#pragma once

#include "effect.h"
#include "host/host.h"

namespace pimg_ofx {

OfxStatus describe(const Host& host, const Effect& effect, OfxImageEffectHandle descriptor);
OfxStatus describe_in_context(const Host& host, const Effect& effect, OfxImageEffectHandle descriptor);

}  // namespace pimg_ofx
