// SPDX-License-Identifier: BSD-3-Clause
// The sizes of features: the bands of an equaliser.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/bands.h>
#include <pimg/detail/sweep_plan.h>

namespace pimg {
inline namespace PIMG_ABI {

/// How far the features that a split adds are fine, of middle size and coarse, in 255ths. Together they are less than 255
/// where the split has much contrast.
struct FeatureSize {
    std::uint8_t fine, medium, coarse;
};

/// What raises features, in stops, by their size.
struct SizeGains {
    float fine = 0.0f, medium = 0.0f, coarse = 0.0f;

    bool none() const { return fine == 0.0f && medium == 0.0f && coarse == 0.0f; }
    float of(FeatureSize size) const
    {
        return (float(size.fine) * fine + float(size.medium) * medium + float(size.coarse) * coarse) * (1.0f / 255.0f);
    }
};

/// The size of the features of every split of a plan, by the pixels that its vertices stand for, in a picture with that
/// diagonal and with a dynamic range of `range` guide units. What has the contrast of a large edge, whose corrections come
/// in all sizes, is left as it is: else there would be halos.
std::vector<FeatureSize> feature_sizes(const SweepPlan& plan, const std::vector<float>& base, const Detail* details,
                                       float diagonal, float range, const ParallelFor& parallel);

/// For each split, how many pixels the smaller of its two vertices stands for.
std::vector<float> pixels_of_splits(const SweepPlan& plan);

}  // namespace PIMG_ABI
}  // namespace pimg
