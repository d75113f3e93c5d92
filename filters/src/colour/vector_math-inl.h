// SPDX-License-Identifier: BSD-3-Clause
// Powers and logarithms to base 2 on vectors, included once per instruction set. Highway's own use fused multiply-adds
// where there are some; these give the same bits everywhere, to about one unit in the last place.
#if defined(PIMG_VECTOR_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PIMG_VECTOR_MATH_INL_H
#undef PIMG_VECTOR_MATH_INL_H
#else
#define PIMG_VECTOR_MATH_INL_H
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <pimg/abi.h>

HWY_BEFORE_NAMESPACE();
namespace pimg {
inline namespace PIMG_ABI {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 8>;
using Vector = hn::Vec<Lanes>;
using Mask = hn::Mask<Lanes>;

/// 2^x for x of -126 to 127, to which it is clamped: the series of e^x on half an octave to both sides.
HWY_INLINE Vector exp2(Vector x)
{
    constexpr float kLn2 = 0.69314718f;
    constexpr float kInverseFactorials[] = {
        1.0f / 5040, 1.0f / 720, 1.0f / 120, 1.0f / 24, 1.0f / 6, 0.5f, 1.0f, 1.0f
    };
    const Lanes d;
    const hn::RebindToSigned<Lanes> i;
    x = hn::Min(hn::Max(x, hn::Set(d, -126.0f)), hn::Set(d, 127.0f));
    const Vector whole = hn::Round(x);
    const Vector rest = (x - whole) * hn::Set(d, kLn2);
    Vector sum = hn::Zero(d);
    for (const float k : kInverseFactorials)
        sum = sum * rest + hn::Set(d, k);
    return sum * hn::BitCast(d, hn::ShiftLeft<23>(hn::ConvertTo(i, whole) + hn::Set(i, 127)));
}

/// log2 x for positive normal x, about -127 for 0: the series of the inverse hyperbolic tangent on half an octave to
/// both sides of 1.
HWY_INLINE Vector log2(Vector x)
{
    constexpr std::int32_t kRootOfHalf = 0x3f3504f3;
    constexpr float kTwoOverLn2 = 2.88539008f;
    const Lanes d;
    const hn::RebindToSigned<Lanes> i;
    const auto bits = hn::BitCast(i, x);
    const auto exponent = hn::ShiftRight<23>(bits - hn::Set(i, kRootOfHalf));
    const Vector mantissa = hn::BitCast(d, bits - hn::ShiftLeft<23>(exponent));
    const Vector one = hn::Set(d, 1.0f);
    const Vector s = (mantissa - one) / (mantissa + one), square = s * s;
    Vector sum = hn::Zero(d);
    for (const int k : { 9, 7, 5, 3, 1 })
        sum = sum * square + hn::Set(d, kTwoOverLn2 / float(k));
    return hn::ConvertTo(d, exponent) + sum * s;
}

/// x^exponent for x >= 0 and exponent > 0.
HWY_INLINE Vector power(Vector x, float exponent)
{
    const Lanes d;
    return hn::IfThenElseZero(x > hn::Zero(d), exp2(log2(x) * hn::Set(d, exponent)));
}

/// Calls body(i, n) for each vector of numbers. It starts at number i, and n of its lanes count: all lanes except in
/// the last vector.
template<class Body>
HWY_INLINE void for_vectors(std::size_t count, Body&& body)
{
    const std::size_t step = hn::Lanes(Lanes());
    for (std::size_t i = 0; i < count; i += step)
        body(i, count - i < step ? count - i : step);
}

/// The first n of the numbers at `from`; the other lanes are 0.
HWY_INLINE Vector load(const float* from, std::size_t n)
{
    const Lanes d;
    if (n == hn::Lanes(d))
        return hn::LoadU(d, from);
    HWY_ALIGN float padded[8] = {};
    for (std::size_t i = 0; i < n; ++i)
        padded[i] = from[i];
    return hn::Load(d, padded);
}

HWY_INLINE void store(Vector v, std::size_t n, float* to)
{
    const Lanes d;
    if (n == hn::Lanes(d)) {
        hn::StoreU(v, d, to);
        return;
    }
    HWY_ALIGN float padded[8];
    hn::Store(v, d, padded);
    for (std::size_t i = 0; i < n; ++i)
        to[i] = padded[i];
}

}  // namespace HWY_NAMESPACE
}  // namespace PIMG_ABI
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#endif
