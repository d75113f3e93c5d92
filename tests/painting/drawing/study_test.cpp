// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/study.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/pictures.h"
#include "painting/drawing/rasters.h"
#include "painting/scene.h"

using namespace pimg;

namespace {

constexpr int kSize = 160;

/// A disk and a small one on a ground with fine noise.
Raster disks()
{
    return test::raster_of(kSize, kSize, [](int x, int y) {
        const bool large = std::hypot(x - 60, y - 80) < 40, little = std::hypot(x - 130, y - 30) < 5;
        return 90.0f + (large ? 70.0f : 0.0f) + (little ? 14.0f : 0.0f)
            + 4.0f * test::noise(std::uint32_t(x), std::uint32_t(y));
    });
}

TEST(Study, BordersOfLargeSegmentsLastLonger)
{
    const Study study = make_study({ disks() }, {});
    const auto at = [&](int x, int y) {
        return study.borders.samples[std::size_t(y * kSize + x)];
    };
    EXPECT_GT(at(60, 40), 2.0f * at(130, 25));
    EXPECT_GT(at(130, 25), 0.0f);
    // Ground and noise have none that lasts.
    float most = 0.0f;
    for (int y = 60; y < kSize - 10; ++y)
        for (int x = 115; x < kSize - 10; ++x)
            most = std::max(most, at(x, y));
    EXPECT_LT(most, 0.5f * at(60, 40));
}

TEST(Study, KeepsFeaturesAndRemovesNoise)
{
    const Raster picture = disks();
    const Study study = make_study({ picture }, {});
    const auto deviation = [](const Raster& raster) {
        double sum = 0.0, squares = 0.0, count = 0.0;
        for (int y = 120; y < 155; ++y)
            for (int x = 115; x < 155; ++x) {
                const double v = double(raster.samples[std::size_t(y * kSize + x)]);
                sum += v;
                squares += v * v;
                count += 1.0;
            }
        return std::sqrt(squares / count - sum / count * sum / count);
    };
    EXPECT_LT(deviation(study.features[0]), 0.4 * deviation(picture));
    EXPECT_NEAR(study.base[0].samples[80 * kSize + 60], 160.0f, 5.0f);
    EXPECT_EQ(study.mean.samples, picture.samples);
}

TEST(Study, CopesWithTheSmallestAndWithMoreThanItLooksAt)
{
    for (const auto& [w, h] : { std::pair { 2, 2 }, { 2, 50 }, { 1500, 1450 } }) {
        const Study study = make_study({ make_raster(w, h, 50.0f) }, {});
        for (const Raster* r : { &study.mean, &study.features[0], &study.base[0], &study.borders })
            EXPECT_TRUE(r->width == w && r->height == h && r->samples.size() == std::size_t(w) * std::size_t(h));
        EXPECT_EQ(*std::max_element(study.borders.samples.begin(), study.borders.samples.end()), 0.0f);
    }
}

TEST(Study, DoesNotDependOnTheLoop)
{
    const Study a = make_study({ disks() }, {}), b = make_study({ disks() }, test::backwards);
    EXPECT_EQ(a.features[0].samples, b.features[0].samples);
    EXPECT_EQ(a.base[0].samples, b.base[0].samples);
    EXPECT_EQ(a.borders.samples, b.borders.samples);
}

}  // namespace
