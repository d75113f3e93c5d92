// SPDX-License-Identifier: BSD-3-Clause
// Histogram and waveform of a rendering.
#pragma once

#include <array>
#include <vector>

#include "render/renderer.h"

namespace pimgview {

/// Shares of the pixels by luminance, between kLeast and kMost stops around 1, kBinsPerStop to a stop. What is darker or
/// brighter is in the first or last bin.
struct Histogram {
    static constexpr int kLeast = -16, kMost = 8, kBinsPerStop = 4;
    static constexpr int kBins = (kMost - kLeast) * kBinsPerStop;
    std::array<float, kBins> bins {};
};

/// How many pixels of each column have each code, as shares of the fullest: `columns` x kRows, the brightest code first.
struct Waveform {
    static constexpr int kRows = 64;  ///< a code in four: finer rows would be thinner than a pixel of the panel
    int columns = 0;
    std::vector<float> shares;
};

/// At most a quarter of a million pixels are looked at, evenly spread.
Histogram histogram_of(const Rendering& rendering);
Waveform waveform_of(const Rendering& rendering, int columns);

}  // namespace pimgview
