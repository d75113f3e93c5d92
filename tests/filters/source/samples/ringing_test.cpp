// SPDX-License-Identifier: BSD-3-Clause
// Dark rings beside lights are filled; what is black in the scene stays.
#include "source/samples/ringing.h"

#include "filters/pictures.h"

namespace pimg {
namespace {

using OIIO::ImageBuf;

/// A wall of 0.3 on which samples are set by hand.
class Wall {
public:
    Wall() : m_buf(OIIO::ImageSpec(40, 40, 3, OIIO::TypeFloat))
    {
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                set(x, y, 0.3f);
    }

    void set(int x, int y, float value)
    {
        const float rgb[3] = { value, value, value };
        m_buf.setpixel(x, y, rgb);
    }

    std::vector<FilledPixel> ringing() const
    {
        Colour colour;
        std::string error;
        EXPECT_TRUE(Colour::resolve(m_buf.spec(), "", colour, error)) << error;
        Raster luminance { 40, 40, {} };
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                luminance.samples.push_back(m_buf.getchannel(x, y, 0, 0));
        return find_ringing(m_buf, colour, luminance, {});
    }

private:
    ImageBuf m_buf;
};

TEST(Ringing, NegativeSamplesAreFilled)
{
    Wall wall;
    wall.set(10, 12, -0.02f);
    const std::vector<FilledPixel> found = wall.ringing();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].pixel, Index(12 * 40 + 10));
    EXPECT_GT(found[0].rgb[0], 0.1f);
    EXPECT_LT(found[0].rgb[0], 0.3f);
}

TEST(Ringing, DarkSamplesBesideALightAreFilled)
{
    Wall wall;
    for (int y = 18; y < 22; ++y)
        wall.set(20, y, 400.0f);
    wall.set(22, 20, 0.01f);
    EXPECT_EQ(wall.ringing().size(), 1u);
}

TEST(Ringing, BlackOfTheSceneStays)
{
    Wall wall;
    for (int i = 0; i < 40; ++i)
        wall.set(i, 5, 0.0f);  // a line
    for (int y = 20; y < 30; ++y)
        for (int x = 20; x < 30; ++x)
            wall.set(x, y, 0.0f);  // an area
    EXPECT_TRUE(wall.ringing().empty());
}

}  // namespace
}  // namespace pimg
