// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/direction.h>

#include <cmath>

#include "painting/scene.h"

using namespace pimg;
using test::Picture;
using test::view_of;

namespace {

constexpr Vec2 kPlaces[] = { { 48, 40 }, { 47, 41 }, { 3, 3 }, { 90, 75 }, { 95, 0 } };

/// Cosine of the angle between two directions without a sign.
float turn_between(Vec2 a, Vec2 b)
{
    return std::fabs(a.x * b.x + a.y * b.y);
}

TEST(DirectionField, RunsAlongStraightEdgesAndIntoFlatPlaces)
{
    for (const float angle : { 0.0f, 0.4f, 1.2f, 2.3f }) {
        const Vec2 along { std::cos(angle), std::sin(angle) };
        const Picture p = test::make("edge", 96, 80, [&](int x, int y) {
            return (float(x) - 48.0f) * along.y - (float(y) - 40.0f) * along.x > 0 ? 200.0f : 40.0f;
        });
        const DirectionField field(view_of(p));
        for (const Vec2 place : kPlaces)
            EXPECT_GT(turn_between(field.at(place), along), 0.92f) << angle << " at " << place.x << ", " << place.y;
    }
}

TEST(DirectionField, IsAUnitVectorEvenWhereThereIsNothing)
{
    for (const Picture& p : test::awkward_pictures()) {
        const DirectionField field(view_of(p));
        for (const Vec2 place : { Vec2 { 0, 0 }, Vec2 { -5, 3 }, Vec2 { 500, 500 }, Vec2 { 0.4f, 0.9f } }) {
            const Vec2 d = field.at(place);
            EXPECT_NEAR(d.x * d.x + d.y * d.y, 1.0f, 1e-4f) << p.name;
            EXPECT_TRUE(field.certainty(place) >= 0.0f && field.certainty(place) <= 1.0f) << p.name;
        }
    }
}

TEST(DirectionField, IsSureOfAnEdgeAndNotOfAFlatPlace)
{
    const Picture step = test::make("step", 96, 80, [](int x, int) { return x < 48 ? 30 : 220; });
    const Picture flat = test::make("flat", 96, 80, [](int, int) { return 30; });
    EXPECT_GT(DirectionField(view_of(step)).certainty({ 48, 40 }), 0.9f);
    EXPECT_LT(DirectionField(view_of(flat)).certainty({ 48, 40 }), 0.1f);
}

TEST(DirectionField, OfANegativeIsTheSame)
{
    const Picture p = test::scene(96, 80);
    Picture negative = p;
    for (float& v : negative.samples)
        v = -v;
    const DirectionField a(view_of(p)), b(view_of(negative));
    for (const Vec2 place : kPlaces) {
        EXPECT_EQ(a.at(place).x, b.at(place).x);
        EXPECT_EQ(a.at(place).y, b.at(place).y);
    }
}

TEST(DirectionField, DoesNotDependOnTheOrderOfTheRows)
{
    const Picture p = test::scene(131, 77);
    const DirectionField a(view_of(p)), b(view_of(p), test::backwards);
    for (int y = 0; y < 77; y += 3)
        for (int x = 0; x < 131; x += 3) {
            const Vec2 place { float(x), float(y) };
            ASSERT_EQ(a.at(place).x, b.at(place).x);
            ASSERT_EQ(a.at(place).y, b.at(place).y);
        }
}

}  // namespace
