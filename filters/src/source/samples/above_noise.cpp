// SPDX-License-Identifier: BSD-3-Clause
#include "source/samples/above_noise.h"

#include <algorithm>
#include <cstddef>

#include <pimg/detail/parallel.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kReach = 3;        ///< pixels to each side of one: fewer, and chance makes texture of noise
constexpr float kMargin = 2.0f;  ///< times the noise

/// Sums over 2 * kReach + 1 numbers, `step` apart, of `count` that lie so; those outside count as the ones at the end.
void sum_line(const float* from, std::size_t count, std::size_t step, float* to)
{
    const auto last = std::ptrdiff_t(count) - 1;
    for (std::ptrdiff_t i = 0; i <= last; ++i) {
        float sum = 0.0f;
        for (std::ptrdiff_t k = i - kReach; k <= i + kReach; ++k)
            sum += from[std::size_t(std::clamp(k, std::ptrdiff_t(0), last)) * step];
        to[std::size_t(i) * step] = sum;
    }
}

}  // namespace

std::vector<float> share_above_noise(const Channels& texture, const std::vector<float>& noise, int width, int height,
                                     const ParallelFor& parallel)
{
    const auto w = std::size_t(width), h = std::size_t(height);
    std::vector<float> squares(w * h, 0.0f), sums(w * h);
    for_rows(parallel, 0, height, [&](int y) {
        const std::size_t first = std::size_t(y) * w;
        for (const std::vector<float>& channel : texture)
            for (std::size_t i = first; i < first + w; ++i)
                squares[i] += channel[i] * channel[i];
        sum_line(&squares[first], w, 1, &sums[first]);
    });
    run(parallel, w, [&](std::size_t x) { sum_line(&sums[x], h, w, &squares[x]); });
    const float numbers = float((2 * kReach + 1) * (2 * kReach + 1)) * float(texture.size());
    for (std::size_t i = 0; i < squares.size(); ++i) {
        const float n = kMargin * noise[i];
        squares[i] = n > 0.0f ? std::max(1.0f - n * n * numbers / std::max(squares[i], n * n), 0.0f) : 1.0f;
    }
    return squares;
}

}  // namespace PIMG_ABI
}  // namespace pimg
