// SPDX-License-Identifier: BSD-3-Clause
#include "source/detail_gain.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "source/detail_gain.cpp"
#include <hwy/foreach_target.h>

#include "colour/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pimg {
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

    HWY_INLINE Vector operator()(Vector contrast, Vector visibility) const
    {
        return between(contrast, set(m_gain.quiet) + visibility * set(m_gain.detail - m_gain.quiet));
    }

private:
    static HWY_INLINE Vector set(float value) { return hn::Set(Lanes(), value); }

    HWY_INLINE Vector between(Vector contrast, Vector of_smallest) const
    {
        const Vector rest = set(1.0f) - hn::Min(contrast / set(m_gain.dmax), set(1.0f));
        const Vector raised = m_is_whole ? whole_power(rest, unsigned(m_gain.beta)) : power(rest, m_gain.beta);
        return set(m_gain.s0) + (of_smallest - set(m_gain.s0)) * raised;
    }

    DetailGain m_gain;
    bool m_is_whole;
};

void gains_of(const DetailGain& parameters, float* contrasts, std::size_t count)
{
    const Gain gain(parameters);
    for_vectors(count, [&](std::size_t i, std::size_t n) { store(gain(load(contrasts + i, n)), n, contrasts + i); });
}

/// Multiplies both numbers of a detail by the gain of its contrast: one vector of gains is for two vectors of details.
void compress_by_contrast(const DetailGain& parameters, const float* details, const float* contrasts,
                          const float* visibilities, std::size_t count, float* compressed)
{
    const Lanes d;
    const Gain gain(parameters);
    for_vectors(count, [&](std::size_t i, std::size_t n) {
        const Vector contrast = load(contrasts + i, n);
        const Vector g = visibilities != nullptr ? gain(contrast, load(visibilities + i, n)) : gain(contrast);
        HWY_ALIGN float twice[2 * 8];
        hn::StoreInterleaved2(g, g, d, twice);
        for_vectors(2 * n, [&](std::size_t k, std::size_t lanes) {
            store(load(details + 2 * i + k, lanes) * hn::Load(d, twice + k), lanes, compressed + 2 * i + k);
        });
    });
}

void compress_by_size(const DetailGain& parameters, const float* details, std::size_t count, float* compressed)
{
    const Gain gain(parameters);
    for_vectors(2 * count, [&](std::size_t i, std::size_t n) {
        const Vector detail = load(details + i, n);
        store(gain(hn::Abs(detail)) * detail, n, compressed + i);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace pimg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pimg {

HWY_EXPORT(gains_of);
HWY_EXPORT(compress_by_contrast);
HWY_EXPORT(compress_by_size);

static_assert(sizeof(Detail) == 2 * sizeof(float), "details are taken for numbers, two each");

void DetailGain::apply(float* contrasts, std::size_t count) const
{
    HWY_DYNAMIC_DISPATCH(gains_of)(*this, contrasts, count);
}

void DetailGain::apply(const Detail* details, const float* contrasts, const float* visibilities, std::size_t count,
                       Detail* compressed) const
{
    const float* from = &details->t;
    float* to = &compressed->t;
    if (contrasts != nullptr)
        HWY_DYNAMIC_DISPATCH(compress_by_contrast)(*this, from, contrasts, visibilities, count, to);
    else
        HWY_DYNAMIC_DISPATCH(compress_by_size)(*this, from, count, to);
}

}  // namespace pimg
#endif
