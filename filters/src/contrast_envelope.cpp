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

std::vector<float> contrast_envelope(const Hierarchy& hierarchy, const Bands& bands, float coherence, float range)
{
    const Index base = hierarchy.base_vertices();
    std::vector<float> envelope(hierarchy.levels()), values(hierarchy.vertices());
    std::vector<float> contrast(hierarchy.vertices(), range);  // of the vertices, as far as they exist
    sweep(hierarchy, bands, values.data(), hierarchy.levels(), [&](Level i, Detail d) {
        const Stencil& k = hierarchy.stencils[i];
        const auto [least, most] = std::minmax({ values[k.s], values[k.at], values[k.bt], values[k.au], values[k.bu] });
        const float own = std::max({ std::fabs(d.t), std::fabs(d.u), most - least });
        const float s = contrast[k.s];
        const float t = s + k.wat * (contrast[k.at] - s) + k.wbt * (contrast[k.bt] - s);
        const float u = s + k.wau * (contrast[k.au] - s) + k.wbu * (contrast[k.bu] - s);
        envelope[i] = own + coherence * (0.5f * (t + u) - own);
        contrast[k.s] = contrast[base + i] = envelope[i];
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

void compress_residual(const Hierarchy& hierarchy, const Bands& bands, const DetailGain& gain, float coherence,
                       const std::vector<float>& picture, std::vector<float>& compressed)
{
    if (bands.residual.empty())
        return;
    // At the vertices the residual is rounding only.
    for (const PixelStencil& k : hierarchy.between) {
        const float r = bands.residual[k.pixel];
        const auto [least, most] = std::minmax({ picture[k.a], picture[k.b], picture[k.c] });
        compressed[k.pixel] += gain(coherence > 0.0f ? std::max(std::fabs(r), most - least) : std::fabs(r)) * r;
    }
}

}  // namespace pimg
