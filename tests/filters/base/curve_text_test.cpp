// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/curve_text.h"

namespace pimg {
namespace {

TEST(CurveText, PairsOfNumbers)
{
    std::vector<CurvePoint> points;
    ASSERT_TRUE(parse_curve("-6:+2, -3:1,0:0,4.5:-1e-1", points));
    ASSERT_EQ(points.size(), 4u);
    EXPECT_EQ(points[0].position, -6.0);
    EXPECT_EQ(points[0].value, 2.0);
    EXPECT_EQ(points[3].position, 4.5);
    EXPECT_EQ(points[3].value, -0.1);
}

TEST(CurveText, NothingElse)
{
    std::vector<CurvePoint> points;
    for (const char* text :
         { "", "1", "1:", ":1", "1:2,", "1:2:3", "+-1:2", "1:inf", "nan:1", "1:1e999", "0x1:1", "1 2:3" })
        EXPECT_FALSE(parse_curve(text, points)) << text;
}

}  // namespace
}  // namespace pimg
