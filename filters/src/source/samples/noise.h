// SPDX-License-Identifier: BSD-3-Clause
// The noise of a picture: photon noise, whose variance grows with the light, and read noise, whose variance does not.
#pragma once

#include <vector>

#include "source/guide.h"

namespace pimg {
inline namespace PIMG_ABI {

/// The variance of a luminance Y is read + photon * Y, in the squares of the picture's units. Both are 0 for a picture
/// without noise.
struct NoiseModel {
    float read = 0.0f, photon = 0.0f;
    float reference = 1.0f;  ///< luminance at guide value 0

    bool none() const { return read <= 0.0f && photon <= 0.0f; }
    bool operator==(const NoiseModel& other) const
    {
        return read == other.read && photon == other.photon && reference == other.reference;
    }

    /// The same noise with `factor` times its standard deviation.
    NoiseModel times(float factor) const { return { read * factor * factor, photon * factor * factor, reference }; }
};

/// Estimates the noise of a picture from its finest band. Where a picture is smooth, that band is noise alone; so of all
/// parts that are about equally light the smoothest count. Texture that covers everything is taken for noise.
NoiseModel estimate_noise(const LogLuminance& luminance, const ParallelFor& parallel);

/// The standard deviation of the noise in log luminance.
class NoiseTable {
public:
    explicit NoiseTable(const NoiseModel& noise);

    /// In guide units, at a guide value.
    float at(float guide) const
    {
        const float step = (guide - kFirst) * (1.0f / kStep);
        const float inside = step < 0.0f ? 0.0f : step > float(kSteps) ? float(kSteps) : step;
        const int i = int(inside) < kSteps ? int(inside) : kSteps - 1;
        return m_values[std::size_t(i)]
            + (inside - float(i)) * (m_values[std::size_t(i) + 1] - m_values[std::size_t(i)]);
    }

private:
    static constexpr float kFirst = -32.0f * kUnitsPerStop, kStep = 0.25f * kUnitsPerStop;
    static constexpr int kSteps = 256;  ///< 32 stops to both sides of the reference
    std::vector<float> m_values;
};

}  // namespace PIMG_ABI
}  // namespace pimg
