// SPDX-License-Identifier: BSD-3-Clause
// Texture told from noise.
#pragma once

#include <vector>

#include <pimg/channels.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// For every pixel, how much of the texture there is more than noise, 0 to 1: Wiener's share 1 - (2 n / r)^2, where r is the
/// root mean square of the texture over 7 x 7 pixels and all channels, and n the standard deviation of the noise of a
/// pixel, in the same units. Twice the noise, since its channels have more than its luminance, and its peaks more than
/// its mean.
std::vector<float> share_above_noise(const Channels& texture, const std::vector<float>& noise, int width, int height,
                                     const ParallelFor& parallel);

}  // namespace PIMG_ABI
}  // namespace pimg
