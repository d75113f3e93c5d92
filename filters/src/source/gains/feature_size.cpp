// SPDX-License-Identifier: BSD-3-Clause
#include "source/gains/feature_size.h"

#include <algorithm>
#include <cmath>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Octaves below the diagonal between which fine becomes medium, and medium coarse: around 1/400 and 1/40 of it. In a
/// picture of a megapixel these are 4 and 36 pixels: leaves and skin below, faces and windows between, and the masses of
/// a composition above. In between sizes blend into each other, so that a feature does not change visibly when it grows
/// by a pixel.
constexpr float kFine = 9.1f, kMediumFine = 8.1f, kMediumCoarse = 5.8f, kCoarse = 4.8f;

/// Smaller pictures are taken for parts of one with this diagonal, in pixels: else nothing in them would be fine.
constexpr float kLeastDiagonal = 1000.0f;

/// Contrasts take part by (1 - contrast / range)^4: 0.7 for one stop of twelve, 0.2 for four. Chosen by eye: with 2,
/// medium = -1.5 leaves a glow round branches before the sky.

/// 0 up to `begin`, 1 from `end` on.
float between(float value, float begin, float end)
{
    return std::clamp((value - begin) / (end - begin), 0.0f, 1.0f);
}

FeatureSize size_of(float pixels, float diagonal, float how_much)
{
    const float octaves = 0.5f * std::log2(diagonal * diagonal / pixels);
    const float fine = between(octaves, kMediumFine, kFine), coarse = between(octaves, kMediumCoarse, kCoarse);
    const auto share = [&](float part) {
        return std::uint8_t(std::lround(255.0f * how_much * part));
    };
    return { share(fine), share(1.0f - fine - coarse), share(coarse) };
}

}  // namespace

std::vector<float> pixels_of_splits(const SweepPlan& plan)
{
    std::vector<float> smaller(plan.levels()), pixels(plan.places(), 1.0f);
    for (Level i = plan.levels(); i-- > 0;) {
        const PlannedSplit k = plan.split(i);
        smaller[i] = std::min(pixels[k.s], pixels[k.u]);
        pixels[k.s] += pixels[k.u];
    }
    return smaller;
}

std::vector<FeatureSize> feature_sizes(const SweepPlan& plan, const std::vector<float>& base, const Detail* details,
                                       float diagonal, float range, const ParallelFor& parallel)
{
    const std::vector<float> pixels = pixels_of_splits(plan);
    const float whole = std::max(diagonal, kLeastDiagonal);
    std::vector<FeatureSize> sizes(plan.levels());
    std::vector<float> values(plan.places());
    plan.set_base(base, 1.0f, values.data());
    plan.for_splits(parallel, [&](Level first, Level last) {
        plan.sweep(first, last, values.data(), [&](Level i) {
            const PlannedSplit k = plan.split(i);
            const Detail d = details[i];
            const auto [least, most] =
                std::minmax({ values[k.s], values[k.at], values[k.bt], values[k.au], values[k.bu] });
            const float contrast = std::max({ std::fabs(d.t), std::fabs(d.u), most - least });
            const float rest = 1.0f - between(contrast, 0.0f, range);
            sizes[i] = size_of(pixels[i], whole, rest * rest);
            return d;
        });
    });
    return sizes;
}

}  // namespace PIMG_ABI
}  // namespace pimg
