// SPDX-License-Identifier: BSD-3-Clause
#include "source/gains/detail_gain.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "source/gains/detail_gain.cpp"
#include <hwy/foreach_target.h>

#include "colour/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pimg {
inline namespace PIMG_ABI {
namespace HWY_NAMESPACE {

/// x^exponent for x >= 0 by squaring.
HWY_INLINE Vector whole_power(Vector x, unsigned exponent)
{
    Vector result = hn::Set(Lanes(), 1.0f);
    for (; exponent > 0; exponent /= 2) {
        if (exponent % 2 == 1)
            result = result * x;
        x = x * x;
    }
    return result;
}

class Gain {
public:
    explicit Gain(const DetailGain& gain)
        : m_gain(gain),
          m_is_whole(gain.beta == std::floor(gain.beta) && gain.beta <= 64.0f)
    {
    }

    HWY_INLINE Vector operator()(Vector contrast) const { return between(contrast, set(m_gain.detail)); }

    /// The gain of the smallest details of the splits from number `i` on.
    HWY_INLINE Vector of_smallest(const SplitTraits& traits, std::size_t i, std::size_t n) const
    {
        return traits.visibility == nullptr
            ? set(m_gain.detail)
            : set(m_gain.quiet) + load(traits.visibility + i, n) * set(m_gain.detail - m_gain.quiet);
    }

    HWY_INLINE Vector between(Vector contrast, Vector of_smallest) const
    {
        const Vector rest = set(1.0f) - hn::Min(contrast / set(m_gain.dmax), set(1.0f));
        const Vector raised = m_is_whole ? whole_power(rest, unsigned(m_gain.beta)) : power(rest, m_gain.beta);
        return set(m_gain.s0) + (of_smallest - set(m_gain.s0)) * raised;
    }

private:
    static HWY_INLINE Vector set(float value) { return hn::Set(Lanes(), value); }

    DetailGain m_gain;
    bool m_is_whole;
};

void gains_of(const DetailGain& parameters, float* contrasts, std::size_t count)
{
    const Gain gain(parameters);
    for_vectors(count, [&](std::size_t i, std::size_t n) { store(gain(load(contrasts + i, n)), n, contrasts + i); });
}

/// Multiplies both numbers of a detail by the gain of their split: one vector of splits is two of details.
void compress_details(const DetailGain& parameters, const float* details, const SplitTraits& traits, std::size_t count,
                      float* compressed)
{
    const Lanes d;
    const Gain gain(parameters);
    for_vectors(count, [&](std::size_t i, std::size_t n) {
        // The gains of the splits or, if those are not known yet, of their smallest details.
        Vector g = gain.of_smallest(traits, i, n);
        if (traits.contrast != nullptr)
            g = gain.between(load(traits.contrast + i, n), g);
        const Vector factor = traits.factor != nullptr ? load(traits.factor + i, n) : hn::Set(d, 1.0f);
        HWY_ALIGN float gains[2 * 8], factors[2 * 8];
        hn::StoreInterleaved2(g, g, d, gains);
        hn::StoreInterleaved2(factor, factor, d, factors);
        for_vectors(2 * n, [&](std::size_t k, std::size_t lanes) {
            const Vector detail = load(details + 2 * i + k, lanes);
            Vector its_gain = hn::Load(d, gains + k);
            if (traits.contrast == nullptr)
                its_gain = gain.between(hn::Abs(detail), its_gain);
            store(detail * (its_gain * hn::Load(d, factors + k)), lanes, compressed + 2 * i + k);
        });
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace PIMG_ABI
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pimg {
inline namespace PIMG_ABI {

HWY_EXPORT(gains_of);
HWY_EXPORT(compress_details);

static_assert(sizeof(Detail) == 2 * sizeof(float), "details are taken for numbers, two each");

void DetailGain::apply(float* contrasts, std::size_t count) const
{
    HWY_DYNAMIC_DISPATCH(gains_of)(*this, contrasts, count);
}

void DetailGain::apply(const Detail* details, const SplitTraits& traits, std::size_t count, Detail* compressed) const
{
    HWY_DYNAMIC_DISPATCH(compress_details)(*this, &details->t, traits, count, &compressed->t);
}

}  // namespace PIMG_ABI
}  // namespace pimg
#endif
