// SPDX-License-Identifier: BSD-3-Clause
#include "source/to_picture.h"

#include <algorithm>
#include <cmath>

namespace pimg {
inline namespace PIMG_ABI {

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

void scale_by_power(int exponent, std::vector<float>& samples)
{
    if (exponent != 0)
        for (float& sample : samples)
            sample = std::ldexp(sample, exponent);
}

}  // namespace PIMG_ABI
}  // namespace pimg
