// SPDX-License-Identifier: BSD-3-Clause
// Detail curves: a gain that depends on the position in the hierarchy, of which the other filters are cases.
#include <pimg/imagebufalgo.h>

#include <cmath>

#include <gtest/gtest.h>
#include <OpenImageIO/imagebufalgo.h>

#include "core/pictures.h"

namespace pimg {
namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
namespace iba = pimg::ImageBufAlgo;

class DetailCurve : public testing::Test {
protected:
    void SetUp() override
    {
        m_source.reset(ImageSpec(80, 60, 1, TypeDesc::FLOAT));
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 80; ++x) {
                // Far from black, where gains would be less than linear.
                const float p = 1.0f + test::scene(x, y, 80, 60) / 255.0f;
                m_source.setpixel(x, y, &p);
            }
        ASSERT_TRUE(m_image.build(m_source));
    }

    ImageBuf with(const std::string& curve, float denoise = 1.0f) const
    {
        DetailEnhanceOptions options;
        options.denoise = denoise;
        options.curve = curve;
        return iba::detail_enhance(m_image, options);
    }

    static double difference(const ImageBuf& a, const ImageBuf& b)
    {
        EXPECT_FALSE(a.has_error()) << a.geterror();
        EXPECT_FALSE(b.has_error()) << b.geterror();
        return OIIO::ImageBufAlgo::compare(a, b, 0, 0).maxerror;
    }

    ImageBuf m_source;
    ProgressiveImage m_image;
};

TEST_F(DetailCurve, OfOneIsTheSource)
{
    EXPECT_EQ(difference(with("0:1"), m_source), 0.0);
    EXPECT_EQ(difference(with("0:1,0.3:1,1:1"), m_source), 0.0);
}

TEST_F(DetailCurve, IsGainFromToWithJumps)
{
    DetailEnhanceOptions options;
    options.gain = 3.0f;
    options.from = 0.25f;
    options.to = 0.75f;
    EXPECT_EQ(difference(with("0:1,0.25:1,0.25:3,0.75:3,0.75:1"), iba::detail_enhance(m_image, options)), 0.0);
}

TEST_F(DetailCurve, IsTheLowPassWithGainZero)
{
    FeatureLowpassOptions options;
    options.fraction = 0.2f;
    EXPECT_LT(difference(with("0:1,0.2:1,0.2:0"), iba::feature_lowpass(m_image, options)), 1e-5);
}

TEST_F(DetailCurve, IsLinearBetweenItsPoints)
{
    // Synthesis is linear in the gains: the ramp 0..2 and its mirror add up to twice a gain of 1.
    const ImageBuf up = with("0:0,1:2", 0.0f), down = with("0:2,1:0", 0.0f);
    const ImageBuf mean = OIIO::ImageBufAlgo::mul(OIIO::ImageBufAlgo::add(up, down), 0.5f);
    EXPECT_LT(difference(mean, m_source), 1e-5);
    EXPECT_GT(difference(up, m_source), 1e-2);
}

TEST_F(DetailCurve, CountsPositionsAboveOneInSplits)
{
    const double splits = double(m_image.hierarchy().levels());
    const std::string half = std::to_string(std::lround(0.5 * splits));
    EXPECT_EQ(difference(with("0:1," + half + ":1," + half + ":2"), with("0:1,0.5:1,0.5:2")), 0.0);
}

TEST_F(DetailCurve, RefusesWhatIsNoCurve)
{
    for (const char* curve : { "1", "0:1,", ":", "0:1,0.5", "0.5:1,0.2:1", "0:-1", "0:101", "-1:1", "0:nan", "nan:1",
                               "a:b", "0:1;1:2", "0:1 1:2" }) {
        ImageBuf result = with(curve);
        EXPECT_TRUE(result.has_error()) << curve;
        EXPECT_NE(result.geterror().find("curve="), std::string::npos) << curve;
    }
}

}  // namespace
}  // namespace pimg
