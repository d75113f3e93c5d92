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
inline namespace PIMG_ABI {
namespace HWY_NAMESPACE {

// A pixel never depends on the other pixels of its vector, because their number depends on the instruction set.

struct Pixels {
    Vector r, g, b;
};

HWY_INLINE Vector set(float value)
{
    return hn::Set(Lanes(), value);
}

HWY_INLINE Vector tone(const ToneCurve& curve, Vector y)
{
    const float rest = curve.most - ToneCurve::kKnee;
    const Vector knee = set(ToneCurve::kKnee), one = set(1.0f);
    y = hn::Min(y, set(1e18f));  // the square must be finite
    y = y * (y / (y + set(curve.toe + 1e-30f)));
    const Vector t = (y - knee) * set(1.0f / rest);
    const Vector curved = knee + set(rest) * (t * (one + t * set(curve.inverse_square)) / (one + t));
    return hn::IfThenElse(y <= knee, y, hn::IfThenElse(y < set(curve.white), curved, set(curve.most)));
}

HWY_INLINE Vector weighted(const float* weights, Vector x, Vector y, Vector z)
{
    return set(weights[0]) * x + set(weights[1]) * y + set(weights[2]) * z;
}

HWY_INLINE Vector luminance(const Recolour& how, const Pixels& p)
{
    const Vector y = weighted(how.weights.data(), p.r, p.g, p.b);
    const Vector floor = set(0.03f) * hn::Max(hn::Max(p.r, p.g), p.b);
    return hn::Min(hn::Max(y, floor), set(std::numeric_limits<float>::max()));
}

HWY_INLINE Vector saturated(Vector sample, Vector y, float saturation)
{
    return hn::CopySign(y * power(hn::Abs(sample / y), saturation), sample);
}

HWY_INLINE void scale(Vector factor, Pixels& p)
{
    for (Vector* channel : { &p.r, &p.g, &p.b })
        *channel = *channel * factor;
}

struct Lab {
    Vector l, a, b;
};

// The matrices of Oklab for linear Rec. 709.
constexpr float kLms[3][3] = { { 0.4122214708f, 0.5363325363f, 0.0514459929f },
                               { 0.2119034982f, 0.6806995451f, 0.1073969566f },
                               { 0.0883024619f, 0.2817188376f, 0.6299787005f } };
constexpr float kLab[3][3] = { { 0.2104542553f, 0.7936177850f, -0.0040720468f },
                               { 1.9779984951f, -2.4285922050f, 0.4505937099f },
                               { 0.0259040371f, 0.7827717662f, -0.8086757660f } };
constexpr float kLmsOfAb[3][2] = { { 0.3963377774f, 0.2158037573f },
                                   { -0.1055613458f, -0.0638541728f },
                                   { -0.0894841775f, -1.2914855480f } };
constexpr float kRgb[3][3] = { { 4.0767416621f, -3.3077115913f, 0.2309699292f },
                               { -1.2684380046f, 2.6097574011f, -0.3413193965f },
                               { -0.0041960863f, -0.7034186147f, 1.7076147010f } };

HWY_INLINE Lab to_oklab(const Pixels& p)
{
    const Vector l = power(weighted(kLms[0], p.r, p.g, p.b), 1.0f / 3.0f);
    const Vector m = power(weighted(kLms[1], p.r, p.g, p.b), 1.0f / 3.0f);
    const Vector s = power(weighted(kLms[2], p.r, p.g, p.b), 1.0f / 3.0f);
    return { weighted(kLab[0], l, m, s), weighted(kLab[1], l, m, s), weighted(kLab[2], l, m, s) };
}

HWY_INLINE Pixels from_oklab(const Lab& lab)
{
    const auto cube = [](Vector x) {
        return x * x * x;
    };
    const Vector l = cube(lab.l + set(kLmsOfAb[0][0]) * lab.a + set(kLmsOfAb[0][1]) * lab.b);
    const Vector m = cube(lab.l + set(kLmsOfAb[1][0]) * lab.a + set(kLmsOfAb[1][1]) * lab.b);
    const Vector s = cube(lab.l + set(kLmsOfAb[2][0]) * lab.a + set(kLmsOfAb[2][1]) * lab.b);
    return { weighted(kRgb[0], l, m, s), weighted(kRgb[1], l, m, s), weighted(kRgb[2], l, m, s) };
}

// Between linear Rec. 709 and Display P3, which have one white.
constexpr float kToP3[3][3] = { { 0.8224619688f, 0.1775380312f, 0.0f },
                                { 0.0331941989f, 0.9668058011f, 0.0f },
                                { 0.0170826307f, 0.0723974407f, 0.9105199286f } };
constexpr float kFromP3[3][3] = { { 1.2249401763f, -0.2249401763f, 0.0f },
                                  { -0.0420569547f, 1.0420569547f, 0.0f },
                                  { -0.0196375546f, -0.0786360456f, 1.0982736001f } };

HWY_INLINE Pixels converted(const float (&matrix)[3][3], const Pixels& p)
{
    return { weighted(matrix[0], p.r, p.g, p.b), weighted(matrix[1], p.r, p.g, p.b),
             weighted(matrix[2], p.r, p.g, p.b) };
}

struct Range {
    Vector least, most;
};

/// Of the linear samples of a colour by the primaries of the display.
HWY_INLINE Range range_of(const Recolour& how, const Pixels& rec709)
{
    const Pixels p = how.wide ? converted(kToP3, rec709) : rec709;
    return { hn::Min(hn::Min(p.r, p.g), p.b), hn::Max(hn::Max(p.r, p.g), p.b) };
}

/// Colours of more than this share of the greatest saturation that the gamut allows become less saturated. Chosen by
/// eye.
constexpr float kFullSaturation = 0.85f;

/// Colours on the line from the grey of a luminance to a colour of that luminance, at constant hue.
class HueLine {
public:
    HWY_INLINE HueLine(const Recolour& how, Vector y, const Pixels& p)
        : m_how(how),
          m_y(y),
          m_grey(power(y, 1.0f / 3.0f)),
          m_lab(to_oklab(p))
    {
    }

    /// At `share` of the way to the colour.
    HWY_INLINE Pixels at(Vector share) const
    {
        Pixels p = of_any_luminance(share);
        scale(m_y / hn::Max(luminance_of(p), set(1e-30f)), p);
        return p;
    }

    /// How far the colour at `share` is outside the display's gamut: negative inside, continuous, in no unit.
    HWY_INLINE Vector excess(Vector share) const
    {
        // Of what at() returns, times a number that is positive where any colour is inside: no division.
        const Pixels p = of_any_luminance(share);
        const Range range = range_of(m_how, p);
        return hn::Max(range.most * m_y - luminance_of(p), set(0.0f) - range.least);
    }

private:
    HWY_INLINE Pixels of_any_luminance(Vector share) const
    {
        return from_oklab({ m_grey + share * (m_lab.l - m_grey), share * m_lab.a, share * m_lab.b });
    }
    HWY_INLINE Vector luminance_of(const Pixels& p) const { return weighted(m_how.weights.data(), p.r, p.g, p.b); }

    const Recolour& m_how;
    Vector m_y, m_grey;
    Lab m_lab;
};

HWY_INLINE Mask outside(const Recolour& how, const Pixels& rec709)
{
    const Range range = range_of(how, rec709);
    return hn::Or(range.least<set(0.0f), range.most> set(1.0f));
}

/// Draws the colours of `near` that are outside the display's gamut, or almost, into it. A function of its own, because
/// few pixels need it and its code is long.
HWY_NOINLINE void draw_into_gamut(const Recolour& how, Vector y, Mask near, Pixels& p)
{
    const HueLine line(how, y, p);
    // The share at which the line leaves the gamut, if that is before 1 / kFullSaturation: halvings, then a straight line
    // between the last two. Median error 4e-6; for one line in a hundred it is above 1e-3.
    constexpr int kHalvings = 7;
    Vector in = set(0.0f), out = set(1.0f / kFullSaturation);
    Vector at_in = line.excess(in), at_out = line.excess(out);
    const Mask leaves = hn::And(near, at_out > set(0.0f));
    if (hn::AllFalse(Lanes(), leaves))
        return;
    for (int i = 0; i < kHalvings; ++i) {
        const Vector middle = set(0.5f) * (in + out), at_middle = line.excess(middle);
        const Mask is_out = at_middle > set(0.0f);
        out = hn::IfThenElse(is_out, middle, out);
        at_out = hn::IfThenElse(is_out, at_middle, at_out);
        in = hn::IfThenElse(is_out, in, middle);
        at_in = hn::IfThenElse(is_out, at_in, at_middle);
    }
    in = in + (out - in) * hn::Max(at_in / (at_in - at_out), set(0.0f));
    const Vector full = set(kFullSaturation), rest = set(1.0f - kFullSaturation), one = set(1.0f);
    const Vector too_much = (one / hn::Max(in, set(1e-6f)) - full) / rest;
    const Vector share = in * (full + rest * (too_much / (one + too_much)));
    const Pixels drawn = line.at(share);
    p.r = hn::IfThenElse(leaves, drawn.r, p.r);
    p.g = hn::IfThenElse(leaves, drawn.g, p.g);
    p.b = hn::IfThenElse(leaves, drawn.b, p.b);
    if (how.wide)
        p = converted(kToP3, p);
    for (Vector* channel : { &p.r, &p.g, &p.b })
        *channel = hn::Min(hn::Max(*channel, set(0.0f)), set(1.0f));
    if (how.wide)
        p = converted(kFromP3, p);
}

/// Draws colours of luminance y, which is positive and at most 1, into the display's gamut.
HWY_INLINE void into_gamut(const Recolour& how, Vector y, Pixels& p)
{
    // Most colours are far inside the gamut. A quick test finds them: it moves them away from grey along a straight
    // line, which is near to the line of constant hue.
    constexpr float kMargin = 1.6f;
    Pixels beyond = p;
    for (Vector* channel : { &beyond.r, &beyond.g, &beyond.b })
        *channel = y + set(kMargin) * (*channel - y);
    const Mask near = outside(how, beyond);
    if (!hn::AllFalse(Lanes(), near))
        draw_into_gamut(how, y, near, p);
}

/// Mixes colours with the grey of their luminance; the more, the more of their light is noise.
HWY_INLINE void fade(const Recolour& how, Vector y, Pixels& p)
{
    constexpr float kFaded = 4.0f;  // at two standard deviations of the noise, half of the colour is left
    const Vector light = hn::Min(y, set(1e18f));
    const Vector square = light * light;
    const Vector noise = set(kFaded) * (set(how.read) + set(how.photon) * light);
    const Vector share = square / hn::Max(square + noise, set(1e-37f));
    for (Vector* channel : { &p.r, &p.g, &p.b })
        *channel = y + share * (*channel - y);
}

/// Scales colours from luminance `from` to display luminance y, both positive, and brings them into the gamut.
HWY_INLINE void fit(const Recolour& how, Vector from, Vector y, Pixels& p)
{
    // Very large colours are divided first, because the ratio would be too small for a float.
    const auto is_huge = from > set(1e30f);
    const bool any_huge = !hn::AllFalse(Lanes(), is_huge);
    const Vector ratio = y / from;
    for (Vector* channel : { &p.r, &p.g, &p.b }) {
        const Vector scaled = *channel * ratio;
        *channel = any_huge ? hn::IfThenElse(is_huge, *channel / from * y, scaled) : scaled;
    }
    scale(set(1.0f / how.curve.most), p);
    into_gamut(how, y * set(1.0f / how.curve.most), p);
    scale(set(how.curve.most), p);
}

HWY_INLINE void recolour_vector(const Recolour& how, Vector compressed, Vector guide, Pixels& p)
{
    const Vector factor = exp2(set(how.slope) * compressed - guide * set(1.0f / kUnitsPerStop) + set(how.offset));
    Vector from = luminance(how, p);
    const auto lit = from > set(0.0f);
    const Vector y = how.fit ? tone(how.curve, from * factor) : from;
    if (how.fit && how.read + how.photon > 0.0f)
        fade(how, from, p);
    if (how.saturation != 1.0f) {
        for (Vector* channel : { &p.r, &p.g, &p.b })
            *channel = hn::IfThenElse(lit, saturated(*channel, from, how.saturation), *channel);
        if (how.fit)  // the changed colours have another luminance
            from = luminance(how, p);
    }
    if (how.fit)
        fit(how, from, y, p);
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

void lightness_in_place(const ToneCurve& curve, float* stops, std::size_t count)
{
    for_vectors(count, [&](std::size_t i, std::size_t n) {
        store(power(tone(curve, exp2(load(stops + i, n))), 1.0f / 3.0f), n, stops + i);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace PIMG_ABI
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pimg {
inline namespace PIMG_ABI {

HWY_EXPORT(recolour);
HWY_EXPORT(lightness_in_place);

ToneCurve::ToneCurve(float toe_luminance, float reaches_most_at, float most_luminance)
    : toe(toe_luminance),
      white(std::max(reaches_most_at, 1.000001f * most_luminance)),
      most(most_luminance)
{
    const float t = (white - kKnee) / (most - kKnee);
    inverse_square = 1.0f / (t * t);
}

void recolour(const Recolour& how, const float* compressed, const float* guide, std::size_t count, float* rgb)
{
    HWY_DYNAMIC_DISPATCH(recolour)(how, compressed, guide, count, rgb);
}

void lightness_in_place(const ToneCurve& curve, float* stops, std::size_t count)
{
    HWY_DYNAMIC_DISPATCH(lightness_in_place)(curve, stops, count);
}

}  // namespace PIMG_ABI
}  // namespace pimg
#endif
