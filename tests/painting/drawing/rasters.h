// SPDX-License-Identifier: BSD-3-Clause
// Rasters made on the spot for the tests of drawings.
#pragma once

#include "drawing/raster_ops.h"

namespace pimg::test {

/// f(x, y) at every pixel.
template<class F>
Raster raster_of(int width, int height, F&& f)
{
    Raster raster = make_raster(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            raster.samples[std::size_t(y) * std::size_t(width) + std::size_t(x)] = f(x, y);
    return raster;
}

}  // namespace pimg::test
