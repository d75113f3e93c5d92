// SPDX-License-Identifier: BSD-3-Clause
// The picture from afar, from which compression and exposure are found. It is as coarse for a preview as for the final
// picture, and means of light are the same in both, so they come out alike; noise and single pixels hardly count.
#pragma once

#include <memory>
#include <vector>

#include <pimg/hierarchy.h>
#include <pimg/types.h>

#include "source/gains/contrast_envelope.h"
#include "source/guide.h"
#include "source/wrap/wrap.h"

namespace pimg {
inline namespace PIMG_ABI {

struct Overview {
    std::vector<float> log;     ///< log2 of the mean luminance in every cell of a coarse grid, in guide units
    std::vector<char> lit;      ///< whether a cell shows light of the scene: neither black nor noise in the dark
    std::vector<float> weight;  ///< how much a cell says of the scene: little where nothing is but one tone and noise
    float range = 0.0f;         ///< dynamic range of the lit cells, in guide units
    Hierarchy hierarchy;        ///< of the cells
    std::vector<Bands> log_bands;
    std::unique_ptr<PlannedBands> bands;  ///< these, to be swept
};

Status look_from_afar(const LogLuminance& luminance, const Wrap& wrap, const ParallelFor& parallel, Overview& overview);

/// A number and how much it counts.
struct Weighted {
    float value, weight;
};

/// The number at a quantile, 0..1, by weight; 0 if there are none. Sorts `numbers`.
float quantile(std::vector<Weighted>& numbers, double q);

}  // namespace PIMG_ABI
}  // namespace pimg
