// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/diffusion_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "smoothing/diffusion_rows.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace pimg {
inline namespace PIMG_ABI {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Calls body(tag, x) for vectors of pixels from x on, and for single ones at the end.
template<class Body>
HWY_INLINE void for_pixels(std::size_t count, Body&& body)
{
    const hn::ScalableTag<float> all;
    const hn::CappedTag<float, 1> one;
    const std::size_t step = hn::Lanes(all);
    std::size_t x = 0;
    for (; x + step <= count; x += step)
        body(all, x);
    for (; x < count; ++x)
        body(one, x);
}

void add_squares(const float* a, const float* b, std::size_t count, float* sums)
{
    for_pixels(count, [&](auto d, std::size_t x) {
        const auto difference = hn::LoadU(d, b + x) - hn::LoadU(d, a + x);
        hn::StoreU(hn::LoadU(d, sums + x) + difference * difference, d, sums + x);
    });
}

void to_conductances(float scale, std::size_t count, float* squares)
{
    for_pixels(count, [&](auto d, std::size_t x) {
        const auto one = hn::Set(d, 1.0f);
        const auto a = one + hn::Set(d, scale) * hn::LoadU(d, squares + x);
        hn::StoreU(one / (a * a), d, squares + x);
    });
}

void diffuse_row(const DiffusingRow& rows, float length, std::size_t count, float* to)
{
    for_pixels(count, [&](auto d, std::size_t x) {
        const auto at = [&](const float* row) {
            return hn::LoadU(d, row + x);
        };
        const auto j = at(rows.row);
        const auto across = at(rows.right - 1) * (at(rows.row - 1) - j) + at(rows.right) * (at(rows.row + 1) - j);
        const auto along = at(rows.up) * (at(rows.above) - j) + at(rows.down) * (at(rows.below) - j);
        hn::StoreU(j + hn::Set(d, length) * (across + along), d, to + x);
    });
}

void mix_rows(const float* guide, const float* picture, float share, std::size_t count, float* to)
{
    for_pixels(count, [&](auto d, std::size_t x) {
        const auto g = hn::LoadU(d, guide + x);
        hn::StoreU(g + hn::Set(d, share) * (hn::LoadU(d, picture + x) - g), d, to + x);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace PIMG_ABI
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pimg {
inline namespace PIMG_ABI {

HWY_EXPORT(add_squares);
HWY_EXPORT(to_conductances);
HWY_EXPORT(diffuse_row);
HWY_EXPORT(mix_rows);

void add_squares(const float* a, const float* b, std::size_t count, float* sums)
{
    HWY_DYNAMIC_DISPATCH(add_squares)(a, b, count, sums);
}

void to_conductances(float scale, std::size_t count, float* squares)
{
    HWY_DYNAMIC_DISPATCH(to_conductances)(scale, count, squares);
}

void diffuse_row(const DiffusingRow& rows, float length, std::size_t count, float* to)
{
    HWY_DYNAMIC_DISPATCH(diffuse_row)(rows, length, count, to);
}

void mix_rows(const float* guide, const float* picture, float share, std::size_t count, float* to)
{
    HWY_DYNAMIC_DISPATCH(mix_rows)(guide, picture, share, count, to);
}

}  // namespace PIMG_ABI
}  // namespace pimg
#endif
