// SPDX-License-Identifier: BSD-3-Clause
// What planning a drawing does with rasters: samples between pixels, Gaussian filters, other sizes.
#pragma once

#include <algorithm>
#include <cmath>

#include <pimg/channels.h>
#include <pimg/direction.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

inline Raster make_raster(int width, int height, float value = 0.0f)
{
    return { width, height, std::vector<float>(std::size_t(width) * std::size_t(height), value) };
}

/// Number of the pixel nearest to p, the nearest at the border if p is outside.
inline std::size_t pixel_at(const Raster& raster, Vec2 p)
{
    const int x = std::clamp(int(p.x + 0.5f), 0, raster.width - 1),
              y = std::clamp(int(p.y + 0.5f), 0, raster.height - 1);
    return std::size_t(y) * std::size_t(raster.width) + std::size_t(x);
}

/// The sample of the pixel nearest to p.
inline float nearest(const Raster& raster, Vec2 p)
{
    return raster.samples[pixel_at(raster, p)];
}

/// The bilinear sample at p; outside, that of the nearest place at the border.
inline float between(const Raster& raster, Vec2 p)
{
    const float fx = std::clamp(p.x, 0.0f, float(raster.width - 1)),
                fy = std::clamp(p.y, 0.0f, float(raster.height - 1));
    const int x = int(fx), y = int(fy), right = x + 1 < raster.width ? 1 : 0;
    const float wx = fx - float(x), wy = fy - float(y);
    const float* a = raster.samples.data() + std::size_t(y) * std::size_t(raster.width) + std::size_t(x);
    const float* b = y + 1 < raster.height ? a + raster.width : a;
    return (1 - wy) * ((1 - wx) * a[0] + wx * a[right]) + wy * ((1 - wx) * b[0] + wx * b[right]);
}

/// The unit vector of a direction that is stored as (cos 2a, sin 2a) times any number above 0: half of its angle, by
/// the half-angle formulas. (1, 0) for (0, 0).
inline Vec2 half_angle(float doubled_cosine, float doubled_sine)
{
    const float length = std::sqrt(doubled_cosine * doubled_cosine + doubled_sine * doubled_sine);
    const float c = length > 1e-20f ? doubled_cosine / length : 1.0f;
    const float x = std::sqrt(std::max(0.0f, 0.5f * (1.0f + c))), y = std::sqrt(std::max(0.0f, 0.5f * (1.0f - c)));
    return { x, doubled_sine < 0.0f ? -y : y };
}

/// A Gaussian filter with a standard deviation of `sigma` pixels, above 0. Beyond its border the picture goes on as
/// its mirror image, so that the mean at the border is one of places near it, not of the border's own pixels.
Raster blurred(const Raster& raster, float sigma, const ParallelFor& parallel);

/// Resizes a picture of width x height samples, with tent filters as wide as the larger of the two pixels.
Raster resampled(const float* samples, int width, int height, int new_width, int new_height,
                 const ParallelFor& parallel);

}  // namespace PIMG_ABI
}  // namespace pimg
