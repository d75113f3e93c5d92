// SPDX-License-Identifier: BSD-3-Clause
#include "contrast_envelope.h"

#include <algorithm>
#include <cmath>

#include "sweep.h"

namespace pimg {

namespace {

/// rest^beta. Whole exponents, the default among them, by squaring: the sweep waits for nothing else.
float power(float rest, float beta)
{
    if (beta != std::floor(beta) || beta > 64.0f)
        return std::pow(rest, beta);
    float result = 1.0f;
    for (unsigned n = unsigned(beta); n > 0; n /= 2) {
        if (n % 2 == 1)
            result *= rest;
        rest *= rest;
    }
    return result;
}

}  // namespace

float DetailGain::operator()(float contrast) const
{
    const float rest = contrast < dmax ? 1.0f - contrast / dmax : 0.0f;
    return s0 + (1.0f - s0) * power(rest, beta);
}

std::vector<float> contrast_envelope(const Hierarchy& hierarchy, const Bands& bands, float coherence)
{
    std::vector<float> envelope(hierarchy.levels()), values(hierarchy.vertices());
    sweep(hierarchy, bands, values.data(), hierarchy.levels(), [&](Level i, Detail d) {
        const Stencil& k = hierarchy.stencils[i];
        const auto [least, most] = std::minmax({ values[k.s], values[k.at], values[k.bt], values[k.au], values[k.bu] });
        envelope[i] = std::max({ std::fabs(d.t), std::fabs(d.u), coherence * (most - least) });
        return d;
    });
    return envelope;
}

void compress(const Hierarchy& hierarchy, const Bands& bands, const DetailGain& gain,
              const std::vector<float>* envelope, float* values)
{
    for (Index v = 0; v < hierarchy.base_vertices(); ++v)
        values[v] = gain.s0 * bands.base[v];
    const Detail* details = bands.details.data();
    if (envelope != nullptr) {
        const float* contrast = envelope->data();
        sweep_from(hierarchy, 0, values, [=](Level i) {
            const float g = gain(contrast[i]);
            return Detail { g * details[i].t, g * details[i].u };
        });
    } else {
        sweep_from(hierarchy, 0, values, [=](Level i) {
            const Detail d = details[i];
            return Detail { gain(std::fabs(d.t)) * d.t, gain(std::fabs(d.u)) * d.u };
        });
    }
}

}  // namespace pimg
