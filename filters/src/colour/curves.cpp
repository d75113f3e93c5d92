// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/colour.h>
#include <pimg/display.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "colour/curves.cpp"
#include <hwy/foreach_target.h>

#include "colour/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pimg {
inline namespace PIMG_ABI {
namespace HWY_NAMESPACE {

void exp2_in_place(float* values, std::size_t count)
{
    for_vectors(count, [&](std::size_t i, std::size_t n) { store(exp2(load(values + i, n)), n, values + i); });
}

void srgb_in_place(float* values, std::size_t count)
{
    const Lanes d;
    for_vectors(count, [&](std::size_t i, std::size_t n) {
        const Vector x = load(values + i, n);
        const Vector curved = hn::Set(d, 1.055f) * power(x, 1.0f / 2.4f) - hn::Set(d, 0.055f);
        store(hn::IfThenElse(x > hn::Set(d, 0.0031308f), curved, hn::Set(d, 12.92f) * x), n, values + i);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace PIMG_ABI
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pimg {
inline namespace PIMG_ABI {

HWY_EXPORT(exp2_in_place);
HWY_EXPORT(srgb_in_place);

void exp2_in_place(float* values, std::size_t count)
{
    HWY_DYNAMIC_DISPATCH(exp2_in_place)(values, count);
}

void srgb_in_place(float* values, std::size_t count)
{
    HWY_DYNAMIC_DISPATCH(srgb_in_place)(values, count);
}

}  // namespace PIMG_ABI
}  // namespace pimg
#endif
