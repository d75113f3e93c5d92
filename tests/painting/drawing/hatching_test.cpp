// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/hatching.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "drawing/raster_ops.h"

using namespace pimg;

namespace {

constexpr int kSize = 240;

/// Hatching of one tone, or of one that changes from column to column.
class Hatching : public testing::Test {
protected:
    template<class Cover>
    Drawing hatched(Cover&& cover, HatchLayer layer = {})
    {
        m_cover = m_base = make_raster(kSize, kSize);
        if (m_stops.samples.empty())
            m_stops = m_base;
        for (std::size_t i = 0; i < m_cover.samples.size(); ++i)
            m_cover.samples[i] = cover(int(i % kSize));
        layer.cover = &m_cover;
        layer.stops = &m_stops;
        Drawing drawing;
        drawing.width = drawing.height = kSize;
        add_hatching(FormField({ m_base }, 1.0f, {}), layer, drawing);
        return drawing;
    }

    static float covered(const Drawing& drawing)
    {
        float area = 0.0f;
        for (const InkLine& line : drawing.lines)
            for (const InkPoint* p = drawing.begin(line); p != drawing.begin(line) + line.count; ++p)
                area += p->width;  // points are a pixel apart
        return area / float(kSize * kSize);
    }

    Raster m_cover, m_base, m_stops;
};

TEST_F(Hatching, IsAboutAsDarkAsWanted)
{
    for (const float tone : { 0.08f, 0.2f, 0.4f }) {
        const float is = covered(hatched([&](int) { return tone; }));
        EXPECT_NEAR(is, tone, 0.25f * tone) << tone;  // match_tone() does the rest
    }
    EXPECT_TRUE(hatched([](int) { return 0.03f; }).lines.empty());
}

TEST_F(Hatching, LinesKeepTheirDistance)
{
    HatchLayer layer;
    layer.spacing = 3.0f;
    const Drawing drawing = hatched([](int) { return 0.9f; }, layer);
    ASSERT_GT(drawing.lines.size(), 30u);
    float least = 1e9f;
    for (const InkLine& a : drawing.lines)
        for (const InkLine& b : drawing.lines)
            if (a.first < b.first)
                for (Index k = 0; k < a.count; ++k)
                    for (Index j = 0; j < b.count; ++j)
                        least = std::min(least,
                                         std::hypot(drawing.begin(a)[k].x - drawing.begin(b)[j].x,
                                                    drawing.begin(a)[k].y - drawing.begin(b)[j].y));
    EXPECT_GT(least, 0.5f * layer.spacing * layer.pen);
}

TEST_F(Hatching, EndsAtEdgesAndAtOtherInks)
{
    m_stops = make_raster(kSize, kSize);
    for (int y = 0; y < kSize; ++y)
        m_stops.samples[std::size_t(y * kSize + 100)] = m_stops.samples[std::size_t(y * kSize + 101)] = 1.0f;
    std::vector<std::uint8_t> inks(std::size_t(kSize) * kSize);
    for (std::size_t i = 0; i < inks.size(); ++i)
        inks[i] = i % kSize < 180 ? 0 : 1;
    HatchLayer layer;
    layer.ink_of = &inks;
    const Drawing drawing = hatched([](int) { return 0.3f; }, layer);
    ASSERT_GT(drawing.lines.size(), 30u);
    for (const InkLine& line : drawing.lines) {
        const auto zone = [&](float x) {
            return x < 100.0f ? 0 : x < 179.5f ? 1 : 2;
        };
        const int first = zone(drawing.begin(line)->x);
        EXPECT_EQ(line.ink, first == 2 ? 1u : 0u);
        for (Index k = 1; k < line.count; ++k)
            ASSERT_EQ(zone(drawing.begin(line)[k].x), first) << drawing.begin(line)[k].x;
    }
}

TEST_F(Hatching, EndsOfLinesTaper)
{
    for (const float cover : { 0.1f, 0.9f })
        for (const Index count : { 5u, 60u }) {
            float before = 0.0f;
            for (Index k = 0; k < count / 2; ++k) {
                EXPECT_GE(taper_at(k, count, 2.0f, cover), before);
                EXPECT_EQ(taper_at(k, count, 2.0f, cover), taper_at(count - 1 - k, count, 2.0f, cover));
                before = taper_at(k, count, 2.0f, cover);
            }
            EXPECT_LE(before, 1.0f);
        }
    EXPECT_EQ(taper_at(30, 60, 2.0f, 0.1f), 1.0f);
    EXPECT_LT(taper_at(0, 60, 2.0f, 0.1f), taper_at(0, 60, 2.0f, 0.9f));
}

TEST(FormField, IsTheDiagonalWhereThereIsNoForm)
{
    const FormField field({ make_raster(160, 120, 7.0f) }, 0.5f, {});
    for (const Vec2 p : { Vec2 { 0, 0 }, Vec2 { 80, 60 }, Vec2 { 159, 119 } }) {
        EXPECT_NEAR(field.at(p).x, 0.643f, 0.03f);  // up to the right, 50 degrees
        EXPECT_NEAR(field.at(p).y, -0.766f, 0.03f);
    }
}

TEST(FormField, FollowsFormsUnlessItIsCalm)
{
    Raster bars = make_raster(160, 160);
    for (int y = 0; y < 160; ++y)
        for (int x = 0; x < 160; ++x)
            bars.samples[std::size_t(y * 160 + x)] = y / 40 % 2 ? 200.0f : 20.0f;
    EXPECT_LT(std::fabs(FormField({ bars }, 0.1f, {}).at({ 80, 80 }).y), 0.15f);
    EXPECT_GT(std::fabs(FormField({ bars }, 20.0f, {}).at({ 80, 80 }).y), 0.7f);
}

}  // namespace
