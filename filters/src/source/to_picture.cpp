// SPDX-License-Identifier: BSD-3-Clause
#include "source/to_picture.h"

#include <algorithm>
#include <cmath>

#include <pimg/bands.h>

namespace pimg {
inline namespace PIMG_ABI {

std::vector<float> to_picture(const Hierarchy& hierarchy, const float* values, int exponent,
                              const std::vector<float>* residual, float factor)
{
    std::vector<float> samples(hierarchy.mesh_pixels());
    scatter(hierarchy, values, samples.data());
    if (residual != nullptr)
        for (std::size_t i = 0; i < residual->size(); ++i)
            samples[i] += factor * (*residual)[i];
    crop_to_picture(hierarchy, samples);
    scale_by_power(exponent, samples);
    return samples;
}

void scale_by_power(int exponent, std::vector<float>& samples)
{
    if (exponent != 0)
        for (float& sample : samples)
            sample = std::ldexp(sample, exponent);
}

void crop_to_picture(const Hierarchy& hierarchy, std::vector<float>& samples)
{
    const std::size_t width = std::size_t(hierarchy.width), height = std::size_t(hierarchy.height);
    const std::size_t mesh_width = std::size_t(hierarchy.mesh_width());
    if (samples.size() == width * height)
        return;
    for (std::size_t y = 0; y < height; ++y)
        std::copy_n(samples.begin() + std::ptrdiff_t(y * mesh_width), width,
                    samples.begin() + std::ptrdiff_t(y * width));
    samples.resize(width * height);
}

}  // namespace PIMG_ABI
}  // namespace pimg
