// SPDX-License-Identifier: BSD-3-Clause
#include "source/wrap/latitude.h"

#include <algorithm>
#include <numeric>

#include <pimg/detail/elementary.h>

namespace pimg {
inline namespace PIMG_ABI {

std::vector<float> latitude_weights(const Wrap& wrap)
{
    constexpr double kPi = 3.14159265358979323846;
    const double radians = std::min(2.0 * kPi / wrap.width, kPi / wrap.height);
    std::vector<float> weights;
    for (int y = -wrap.margin_y; y < wrap.height + wrap.margin_y; ++y)
        weights.push_back(float(elementary::sine_cosine(radians * (y + 0.5 - 0.5 * wrap.height)).cosine));
    return weights;
}

std::vector<Raster> weighted_by_latitude(const std::vector<Raster>& channels, const Wrap& wrap)
{
    const std::vector<float> weights = latitude_weights(wrap);
    std::vector<Raster> result = channels;
    for (Raster& channel : result) {
        const double sum = std::accumulate(channel.samples.begin(), channel.samples.end(), 0.0);
        const float mean = float(sum / double(channel.samples.size()));
        for (std::size_t i = 0; i < channel.samples.size(); ++i)
            channel.samples[i] = (channel.samples[i] - mean) * weights[i / std::size_t(channel.width)];
    }
    return result;
}

}  // namespace PIMG_ABI
}  // namespace pimg
