// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/stipple.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "drawing/raster_ops.h"

using namespace pimg;

namespace {

Drawing dots(const Raster& cover, const StippleOptions& options = {})
{
    Drawing drawing;
    drawing.width = cover.width;
    drawing.height = cover.height;
    add_stipple(cover, options, drawing);
    return drawing;
}

TEST(Stipple, CoversWhatIsWanted)
{
    for (const float tone : { 0.06f, 0.2f, 0.5f }) {
        const Raster cover = make_raster(200, 150, tone);
        float area = 0.0f;
        for (const InkPoint& p : dots(cover).points)
            area += 0.7854f * p.width * p.width;
        EXPECT_NEAR(area / (200.0f * 150.0f), tone, 0.05f * tone) << tone;
    }
    EXPECT_TRUE(dots(make_raster(50, 50, 0.03f)).lines.empty());
    EXPECT_TRUE(dots(make_raster(1, 1)).lines.empty());
}

TEST(Stipple, DotsAreEvenlySpread)
{
    const Drawing drawing = dots(make_raster(200, 200, 0.15f));
    std::vector<float> nearest;
    for (const InkPoint& p : drawing.points) {
        if (p.x < 15 || p.y < 15 || p.x > 185 || p.y > 185)
            continue;
        float least = 1e9f;
        for (const InkPoint& q : drawing.points)
            if (&q != &p)
                least = std::min(least, std::hypot(p.x - q.x, p.y - q.y));
        nearest.push_back(least);
    }
    double sum = 0.0, squares = 0.0;
    for (const float d : nearest) {
        sum += double(d);
        squares += double(d) * double(d);
    }
    const double mean = sum / double(nearest.size());
    // For dots thrown at random it is 0.52.
    EXPECT_LT(std::sqrt(squares / double(nearest.size()) - mean * mean) / mean, 0.15);
}

TEST(Stipple, TakesTheInkOfThePlace)
{
    const Raster cover = make_raster(100, 100, 0.2f);
    std::vector<std::uint8_t> inks(10000);
    for (std::size_t i = 0; i < inks.size(); ++i)
        inks[i] = i % 100 < 50 ? 2 : 1;
    StippleOptions options;
    options.ink_of = &inks;
    const Drawing drawing = dots(cover, options);
    for (const InkLine& line : drawing.lines)
        EXPECT_EQ(line.ink, drawing.begin(line)->x < 49.5f ? 2u : 1u);
}

}  // namespace
