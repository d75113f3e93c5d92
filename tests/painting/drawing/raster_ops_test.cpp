// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/raster_ops.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "painting/drawing/rasters.h"

using namespace pimg;

namespace {

Raster ramp(int width, int height)
{
    return test::raster_of(width, height, [](int x, int y) { return 3.0f * float(x) - 2.0f * float(y); });
}

float mean(const Raster& raster)
{
    return std::accumulate(raster.samples.begin(), raster.samples.end(), 0.0f) / float(raster.samples.size());
}

TEST(RasterOps, SamplesBetweenPixelsOfARampAreExact)
{
    const Raster raster = ramp(9, 7);
    EXPECT_FLOAT_EQ(between(raster, { 2.25f, 3.5f }), 3.0f * 2.25f - 2.0f * 3.5f);
    EXPECT_FLOAT_EQ(between(raster, { -5.0f, 90.0f }), -12.0f);
    EXPECT_FLOAT_EQ(nearest(raster, { 2.4f, 2.6f }), 0.0f);
}

TEST(RasterOps, BlurKeepsTheMeanAndHasItsVariance)
{
    Raster dot = make_raster(61, 61);
    dot.samples[30 * 61 + 30] = 1.0f;
    for (const float sigma : { 0.7f, 2.0f, 5.0f }) {
        const Raster smooth = blurred(dot, sigma, {});
        double variance = 0.0;
        for (int y = 0; y < 61; ++y)
            for (int x = 0; x < 61; ++x)
                variance += double(smooth.samples[std::size_t(y * 61 + x)]) * (x - 30) * (x - 30);
        EXPECT_NEAR(std::sqrt(variance), double(sigma), 0.03 * double(sigma));
    }
    const Raster raster = ramp(20, 13);
    EXPECT_NEAR(mean(blurred(raster, 3.0f, {})), mean(raster), 1e-3f);
    EXPECT_NEAR(mean(blurred(raster, 30.0f, {})), mean(raster), 1e-3f);  // wider than the picture
}

TEST(RasterOps, OtherSizesKeepRampsAndMeans)
{
    const Raster raster = ramp(40, 30);
    const Raster small = resampled(raster.samples.data(), 40, 30, 10, 6, {});
    EXPECT_NEAR(small.samples[3 * 10 + 5], 3.0f * 21.5f - 2.0f * 17.0f, 0.3f);
    EXPECT_NEAR(mean(small), mean(raster), 1.0f);
    const Raster large = resampled(raster.samples.data(), 40, 30, 80, 60, {});
    EXPECT_NEAR(large.samples[31 * 80 + 41], 3.0f * 20.25f - 2.0f * 15.25f, 1e-3f);
    const Raster same = resampled(raster.samples.data(), 40, 30, 40, 30, {});
    for (std::size_t i = 0; i < same.samples.size(); ++i)
        EXPECT_NEAR(same.samples[i], raster.samples[i], 1e-4f);
}

TEST(RasterOps, HalfOfAnAngle)
{
    for (float a = -1.5f; a < 1.55f; a += 0.1f) {
        const Vec2 d = half_angle(7.0f * std::cos(2.0f * a), 7.0f * std::sin(2.0f * a));
        EXPECT_NEAR(d.x, std::cos(a), 1e-3f);
        EXPECT_NEAR(d.y, std::sin(a), 1e-3f);
    }
    EXPECT_EQ(half_angle(0.0f, 0.0f).x, 1.0f);
}

}  // namespace
