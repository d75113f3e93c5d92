// SPDX-License-Identifier: BSD-3-Clause
// Exposure: from log luminance of any range to display luminance, middle grey and white placed.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/options.h>
#include <pimg/types.h>

namespace pimg {

/// Display luminance of middle grey.
constexpr float kMiddleGrey = 0.18f;

/// Rolls highlights off: the identity up to a knee, then a smooth rise that reaches 1 at `white`.
class Shoulder {
public:
    explicit Shoulder(float white);  ///< 1 or more

    float operator()(float y) const
    {
        if (y <= kKnee)
            return y;
        if (!(y < m_white))
            return 1.0f;
        const float t = (y - kKnee) * (1.0f / (1.0f - kKnee));
        return kKnee + (1.0f - kKnee) * (t * (1.0f + t * m_inverse_square) / (1.0f + t));
    }

private:
    static constexpr float kKnee = 0.6f;
    float m_white, m_inverse_square;
};

/// Numbers of pixels by log2 luminance.
class StopHistogram {
public:
    /// Counts `values` / `units` + `offset`, leaving out those whose `guide` is not above `floor`.
    StopHistogram(const std::vector<float>& values, float units, float offset, const std::vector<float>& guide,
                  float floor, const ParallelFor& parallel);

    bool empty() const { return m_count == 0; }
    float quantile(double q) const;  ///< in stops

    /// Calls body(stops, count) for every bin in use.
    template<class Body>
    void for_each(Body&& body) const
    {
        for (std::size_t i = 0; i < m_bins.size(); ++i)
            if (m_bins[i] > 0)
                body((float(i) + 0.5f) / kBinsPerStop - kRange, m_bins[i]);
    }
    std::uint64_t count() const { return m_count; }

private:
    static constexpr float kBinsPerStop = 32.0f, kRange = 256.0f;
    std::vector<std::uint32_t> m_bins;
    std::uint64_t m_count = 0;
};

/// Fills in contrast, key and white of `options` where they are 0. `histogram` is that of the compressed picture.
void find_display_fit(const StopHistogram& histogram, HdrCompressOptions& options);

/// Display luminance at which the shoulder of resolved options reaches white.
float shoulder_white(const HdrCompressOptions& options);

}  // namespace pimg
