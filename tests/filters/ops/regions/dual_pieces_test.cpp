// SPDX-License-Identifier: BSD-3-Clause
// The dual_pieces filter: outputs, levels, awkward sources, errors. The pieces themselves:
// tests/core/dual_pieces_test.cpp.
#include <pimg/imagebufalgo.h>

#include <algorithm>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include <pimg/labels.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
using test::labels_of;
namespace iba = pimg::ImageBufAlgo;

ImageBuf picture(int width, int height)
{
    ImageBuf buf(ImageSpec(width, height, 1, TypeDesc::FLOAT));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float p = test::scene(x, y, width, height) / 255.0f;
            buf.setpixel(x, y, &p);
        }
    return buf;
}

DualPiecesOptions at_fraction(float fraction, const char* output = "labels")
{
    DualPiecesOptions options;
    options.fraction = fraction;
    options.output = output;
    return options;
}

TEST(DualPiecesFilter, GivesEveryVertexOfTheLevelAPiece)
{
    ProgressiveImage progressive;
    ASSERT_TRUE(progressive.build(picture(60, 50)));
    for (const float fraction : { 0.03125f, 0.25f, 1.0f }) {
        const ImageBuf buf = iba::dual_pieces(progressive, at_fraction(fraction));
        const std::vector<Index> labels = labels_of(buf);
        const std::set<Index> numbers(labels.begin(), labels.end());
        EXPECT_EQ(numbers.size(), std::size_t(3000 * fraction));
        EXPECT_EQ(*numbers.rbegin() + 1, numbers.size());
        EXPECT_EQ(buf.spec().get_int_attribute(kLabelCount), int(numbers.size()));
    }
}

TEST(DualPiecesFilter, MeanKeepsTheMean)
{
    const ImageBuf src = picture(60, 50), mean = iba::dual_pieces(src, at_fraction(0.05f, "mean"));
    ASSERT_FALSE(mean.has_error()) << mean.geterror();
    double sums[2] = {};
    std::set<float> values;
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 60; ++x) {
            sums[0] += double(src.getchannel(x, y, 0, 0));
            sums[1] += double(mean.getchannel(x, y, 0, 0));
            values.insert(mean.getchannel(x, y, 0, 0));
        }
    EXPECT_NEAR(sums[0], sums[1], 1e-5 * sums[0]);
    EXPECT_LE(values.size(), 150u);
}

TEST(DualPiecesFilter, TakesThinAndConstantPicturesAndNotANumber)
{
    for (const auto& [width, height] : { std::pair(1, 1), std::pair(1, 9), std::pair(7, 1), std::pair(8, 8) }) {
        ImageBuf src(ImageSpec(width, height, 1, TypeDesc::FLOAT));
        const float nan = std::numeric_limits<float>::quiet_NaN();
        src.setpixel(0, 0, &nan);
        const std::vector<Index> labels = labels_of(iba::dual_pieces(src));
        EXPECT_EQ(std::set<Index>(labels.begin(), labels.end()).size(), labels.size()) << width << " x " << height;
    }
}

TEST(DualPiecesFilter, RefusesWhatItCannotDo)
{
    const ImageBuf src = picture(60, 50);
    EXPECT_TRUE(iba::dual_pieces(src, at_fraction(0.1f, "colours")).has_error());
    DualPiecesOptions two = at_fraction(0.1f);
    two.splits = 5;
    EXPECT_NE(iba::dual_pieces(src, two).geterror().find("splits and fraction"), std::string::npos);
    ImageBuf bytes(ImageSpec(60, 50, 1, TypeDesc::UINT8));
    EXPECT_FALSE(iba::dual_pieces(bytes, src, at_fraction(0.5f)));
    EXPECT_NE(bytes.geterror().find("1500 labels: expected at most 256"), std::string::npos);
}

}  // namespace
}  // namespace pimg
