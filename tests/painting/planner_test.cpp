// SPDX-License-Identifier: BSD-3-Clause
#include "planner.h"

#include <cmath>

#include "painting/scene.h"

using namespace pimg;
using test::view_of;

namespace {

/// A bar, 12 pixels wide, on a dark ground.
class PlannerOnABar : public testing::Test {
protected:
    static int bar(int x, int) { return x < 50 || x >= 62 ? 30 : 220; }

    Site site(Vec2 place, float width) const { return { place, width, 2.0f, 40.0f, 7u }; }
    static float length_of(const Draft& draft)
    {
        float length = 0.0f;
        for (int i = 0; i + 1 < draft.size(); ++i)
            length +=
                std::hypot(draft.begin()[i + 1].x - draft.begin()[i].x, draft.begin()[i + 1].y - draft.begin()[i].y);
        return length;
    }

    const test::Picture m_picture = test::make("bar", 120, 100, bar);
    const ShadePyramid m_pictures { view_of(m_picture), {} };
    const DirectionField m_field { view_of(m_picture) };
    StrokeOptions m_options;
    const Planner m_planner { m_pictures, m_field, m_options };
};

TEST_F(PlannerOnABar, StrokesFollowTheBar)
{
    const Draft draft = m_planner.draft(site({ 55.5f, 50 }, 6.0f), 40.0f);
    EXPECT_NEAR(length_of(draft), 34.0f, 1.0f) << "a stroke reaches half its width beyond its points";
    EXPECT_NEAR(draft.shade[0], 220.0f, 5.0f);
    for (int i = 0; i < draft.size(); ++i)
        EXPECT_NEAR(draft.begin()[i].x, 55.5f, 1.5f);
}

TEST_F(PlannerOnABar, StrokesAreFittedBetweenEdges)
{
    const Draft wide = m_planner.draft(site({ 55.5f, 50 }, 15.0f), 30.0f);
    EXPECT_LT(wide.width, 14.0f);
    EXPECT_GE(wide.width, 7.5f) << "down to half of the brush";
    // Beside the edge a stroke moves to its own side.
    const Draft beside = m_planner.draft(site({ 46, 50 }, 10.0f), 30.0f);
    EXPECT_LT(beside.begin()[beside.size() / 2].x, 46.0f);
    EXPECT_NEAR(beside.shade[0], 30.0f, 5.0f);
}

TEST_F(PlannerOnABar, WithoutLengthTheyAreDots)
{
    m_options.length = 0.0f;
    const Draft dot = m_planner.draft(site({ 20, 50 }, 8.0f), 0.0f);
    EXPECT_EQ(dot.size(), 2);
    EXPECT_LT(length_of(dot), 0.5f);
}

TEST_F(PlannerOnABar, ChanceTurnsAndResizesWithinTheLimits)
{
    m_options.jitter_angle = m_options.jitter_size = 1.0f;
    bool turned = false, resized = false;
    for (std::uint32_t variation = 0; variation < 50; ++variation) {
        Site site = this->site({ 20, 50 }, 8.0f);
        site.variation = variation;
        site.widest = 9.0f;
        const Draft draft = m_planner.draft(site, 20.0f);
        EXPECT_TRUE(draft.width >= 2.0f && draft.width <= 9.0f) << draft.width;
        resized |= std::fabs(draft.width - 8.0f) > 1.0f;
        turned |= std::fabs(draft.begin()[0].x - 20.0f) > 1.0f;
    }
    EXPECT_TRUE(turned && resized);
}

}  // namespace
