// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/colour.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exp2.cpp"
#include <hwy/foreach_target.h>

#include "vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pimg {
namespace HWY_NAMESPACE {

void exp2_in_place(float* values, std::size_t count)
{
    for_vectors(count, [&](std::size_t i, std::size_t n) { store(exp2(load(values + i, n)), n, values + i); });
}

}  // namespace HWY_NAMESPACE
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pimg {

HWY_EXPORT(exp2_in_place);

void exp2_in_place(float* values, std::size_t count)
{
    HWY_DYNAMIC_DISPATCH(exp2_in_place)(values, count);
}

}  // namespace pimg
#endif
