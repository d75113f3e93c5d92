// SPDX-License-Identifier: BSD-3-Clause
#include "ops/display_curve.h"

#include <algorithm>
#include <limits>

#include "source/guide.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ops/display_curve.cpp"
#include <hwy/foreach_target.h>

#include "colour/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pimg {
namespace HWY_NAMESPACE {

// A pixel never depends on the others of its vector, whose number is the instruction set's.

struct Pixels {
    Vector r, g, b;
};

HWY_INLINE Vector set(float value)
{
    return hn::Set(Lanes(), value);
}

HWY_INLINE Vector roll_off(const Shoulder& shoulder, Vector y)
{
    constexpr float kRest = 1.0f - Shoulder::kKnee;
    const Vector knee = set(Shoulder::kKnee), one = set(1.0f);
    const Vector t = (y - knee) * set(1.0f / kRest);
    const Vector curved = knee + set(kRest) * (t * (one + t * set(shoulder.inverse_square)) / (one + t));
    return hn::IfThenElse(y <= knee, y, hn::IfThenElse(y < set(shoulder.white), curved, one));
}

HWY_INLINE Vector luminance(const Recolour& how, const Pixels& p)
{
    const Vector y = set(how.weights[0]) * p.r + set(how.weights[1]) * p.g + set(how.weights[2]) * p.b;
    const Vector floor = set(0.03f) * hn::Max(hn::Max(p.r, p.g), p.b);
    return hn::Min(hn::Max(y, floor), set(std::numeric_limits<float>::max()));
}

HWY_INLINE Vector saturated(Vector sample, Vector y, float saturation)
{
    return hn::CopySign(y * power(hn::Abs(sample / y), saturation), sample);
}

/// Mixes in as much of grey `y` as brings all channels into 0..1: that keeps hue and luminance.
HWY_INLINE void into_gamut(Vector y, Pixels& p)
{
    const Vector zero = set(0.0f), one = set(1.0f);
    const Vector least = hn::Min(hn::Min(p.r, p.g), p.b), most = hn::Max(hn::Max(p.r, p.g), p.b);
    const auto below = least<zero, above = most> one, outside = hn::Or(below, above);
    if (hn::AllFalse(Lanes(), outside))
        return;
    Vector share = hn::IfThenElse(above, (one - y) / (most - y), one);
    share = hn::IfThenElse(below, hn::Min(share, y / (y - least)), share);
    for (Vector* channel : { &p.r, &p.g, &p.b })
        *channel = hn::IfThenElse(outside, hn::Min(hn::Max(y + share * (*channel - y), zero), one), *channel);
}

/// To display luminance y from luminance `from`, both positive.
HWY_INLINE void fit(Vector from, Vector y, Pixels& p)
{
    // Divided first where the ratio would be too small for a float.
    const auto is_huge = from > set(1e30f);
    const bool any_huge = !hn::AllFalse(Lanes(), is_huge);
    const Vector ratio = y / from;
    for (Vector* channel : { &p.r, &p.g, &p.b }) {
        const Vector scaled = *channel * ratio;
        *channel = any_huge ? hn::IfThenElse(is_huge, *channel / from * y, scaled) : scaled;
    }
    into_gamut(y, p);
}

HWY_INLINE void recolour_vector(const Recolour& how, Vector compressed, Vector guide, Pixels& p)
{
    const Vector factor = exp2(set(how.slope) * compressed - guide * set(1.0f / kUnitsPerStop) + set(how.offset));
    const Vector from = luminance(how, p);
    const auto lit = from > set(0.0f);
    if (how.saturation != 1.0f)
        for (Vector* channel : { &p.r, &p.g, &p.b })
            *channel = hn::IfThenElse(lit, saturated(*channel, from, how.saturation), *channel);
    if (how.fit)
        fit(from, roll_off(how.shoulder, from * factor), p);
    for (Vector* channel : { &p.r, &p.g, &p.b })
        *channel = how.fit ? hn::IfThenElseZero(lit, *channel) : *channel * factor;
}

void recolour(const Recolour& how, const float* compressed, const float* guide, std::size_t count, float* rgb)
{
    const Lanes d;
    for_vectors(count, [&](std::size_t i, std::size_t n) {
        HWY_ALIGN float padded[3 * 8] = {};
        const bool whole = n == hn::Lanes(d);
        float* pixels = whole ? rgb + 3 * i : std::copy_n(rgb + 3 * i, 3 * n, padded) - 3 * n;
        Pixels p;
        hn::LoadInterleaved3(d, pixels, p.r, p.g, p.b);
        recolour_vector(how, load(compressed + i, n), load(guide + i, n), p);
        hn::StoreInterleaved3(p.r, p.g, p.b, d, pixels);
        if (!whole)
            std::copy_n(padded, 3 * n, rgb + 3 * i);
    });
}

void lightness_in_place(const Shoulder& shoulder, float* stops, std::size_t count)
{
    for_vectors(count, [&](std::size_t i, std::size_t n) {
        store(power(roll_off(shoulder, exp2(load(stops + i, n))), 1.0f / 3.0f), n, stops + i);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pimg {

HWY_EXPORT(recolour);
HWY_EXPORT(lightness_in_place);

Shoulder::Shoulder(float reaches_one_at) : white(std::max(reaches_one_at, 1.000001f))
{
    const float t = (white - kKnee) / (1.0f - kKnee);
    inverse_square = 1.0f / (t * t);
}

void recolour(const Recolour& how, const float* compressed, const float* guide, std::size_t count, float* rgb)
{
    HWY_DYNAMIC_DISPATCH(recolour)(how, compressed, guide, count, rgb);
}

void lightness_in_place(const Shoulder& shoulder, float* stops, std::size_t count)
{
    HWY_DYNAMIC_DISPATCH(lightness_in_place)(shoulder, stops, count);
}

}  // namespace pimg
#endif
