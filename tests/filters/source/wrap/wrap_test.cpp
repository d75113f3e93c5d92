// SPDX-License-Identifier: BSD-3-Clause
// Margins of panoramas and tiles: what asks for them, what is in them, how what they show is mixed and counted.
#include "source/wrap/wrap.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "source/wrap/latitude.h"
#include "source/wrap/wrapped_pieces.h"

namespace pimg {
namespace {

OIIO::ImageSpec spec_of(int width, int height)
{
    return OIIO::ImageSpec(width, height, 1, OIIO::TypeFloat);
}

Wrap found(const OIIO::ImageSpec& spec, const std::string& asked)
{
    Wrap wrap;
    std::string error;
    EXPECT_TRUE(find_wrap(spec, asked, wrap, error)) << error;
    return wrap;
}

TEST(Wrap, IsNothingUnlessAskedFor)
{
    EXPECT_FALSE(found(spec_of(64, 32), ""));
    EXPECT_STREQ(name_of(found(spec_of(64, 32), "")), "none");
    EXPECT_STREQ(name_of(found(spec_of(64, 32), "x")), "x");
    EXPECT_STREQ(name_of(found(spec_of(64, 32), "xy")), "xy");
}

TEST(Wrap, BelievesMetadata)
{
    OIIO::ImageSpec spec = spec_of(64, 32);
    spec.attribute("textureformat", "LatLong Environment");
    EXPECT_STREQ(name_of(found(spec, "")), "x");
    EXPECT_STREQ(name_of(found(spec, "none")), "none");
    spec.attribute("textureformat", "CubeFace Environment");
    EXPECT_STREQ(name_of(found(spec, "")), "none");
    spec.attribute("GPano:ProjectionType", "equirectangular");
    EXPECT_STREQ(name_of(found(spec, "")), "x");
    spec.attribute("GPano:FullPanoWidthPixels", "128");
    spec.attribute("GPano:CroppedAreaImageWidthPixels", 64);
    EXPECT_STREQ(name_of(found(spec, "")), "none") << "a part of a panorama";
}

TEST(Wrap, NeedsTheWholePeriod)
{
    OIIO::ImageSpec spec = spec_of(64, 32);
    spec.full_width = 80;
    Wrap wrap;
    std::string error;
    EXPECT_FALSE(find_wrap(spec, "x", wrap, error));
    EXPECT_EQ(error, "wrap=x: expected a picture that fills its display window");
    spec.attribute("textureformat", "LatLong Environment");
    EXPECT_FALSE(found(spec, "")) << "a crop of a panorama";
}

TEST(Wrap, RepeatsWhatIsBeyondASide)
{
    for (const char* asked : { "x", "xy" })
        for (const auto& [width, height] : { std::pair(1, 7), { 7, 1 }, { 2, 2 }, { 5, 3 }, { 300, 40 } }) {
            const Wrap wrap = found(spec_of(width, height), asked);
            std::vector<int> raster(wrap.pixels());
            std::iota(raster.begin(), raster.end(), 0);
            const std::vector<int> all = with_margins(wrap, raster);
            EXPECT_EQ(without_margins(wrap, all), raster);
            for (int y = -wrap.margin_y; y < height + wrap.margin_y; ++y)
                for (int x = -wrap.margin_x; x < width + wrap.margin_x; ++x)
                    if (wrap) {
                        EXPECT_EQ(all[wrap.place(x, y)], modulo(y, height) * width + modulo(x, width));
                    }
        }
}

TEST(Wrap, PadsPictures)
{
    OIIO::ImageSpec spec = spec_of(6, 4);
    spec.x = spec.full_x = 10;
    OIIO::ImageBuf picture(spec);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x) {
            const float value = float(10 * y + x);
            picture.setpixel(10 + x, y, &value);
        }
    const OIIO::ImageBuf all = padded(picture, found(spec, "xy"));
    EXPECT_EQ(all.roi().xbegin, 7);
    EXPECT_EQ(all.roi().yend, 6);
    EXPECT_EQ(all.roi_full().xbegin, 10);
    EXPECT_EQ(all.getchannel(9, 0, 0, 0), 5.0f);
    EXPECT_EQ(all.getchannel(18, 5, 0, 0), 12.0f);
}

TEST(Wrap, FadesFromOneMarginToTheOther)
{
    constexpr int kSize = 100, kMargin = 20;
    float before = 0.0f;
    for (int x = -kMargin; x < kMargin; ++x) {  // through the seam, at which 100 is 0
        const int at = modulo(x, kSize);
        const Fade fade = fade_at(at, kSize, kMargin);
        EXPECT_EQ(std::abs(fade.other - at), kSize);
        EXPECT_GT(fade.share, 0.0f);
        EXPECT_LT(fade.share, 0.5f);
        const float of_left_end = at == x ? 1.0f - fade.share : fade.share;
        EXPECT_GT(of_left_end, before);
        EXPECT_LT(of_left_end - before, 1.5f / (2 * kMargin));
        before = of_left_end;
    }
    EXPECT_EQ(fade_at(kMargin, kSize, kMargin).share, 0.0f);
    EXPECT_EQ(fade_at(0, kSize, 0).share, 0.0f);
}

TEST(Latitude, CountsThePolesLittle)
{
    const std::vector<float> weights = latitude_weights(found(spec_of(200, 100), "x"));
    ASSERT_EQ(weights.size(), 100u);
    EXPECT_NEAR(weights[50], 1.0, 1e-3);
    EXPECT_NEAR(weights[25], std::sqrt(0.5), 0.02);
    EXPECT_NEAR(weights[0], 0.0157, 1e-3);
    EXPECT_GT(*std::min_element(weights.begin(), weights.end()), 0.0f);
    // A strip all around shows no poles; a picture higher than wide for its width ends at them.
    EXPECT_NEAR(latitude_weights(found(spec_of(400, 20), "x"))[0], 1.0, 0.02);
    const std::vector<float> high = latitude_weights(found(spec_of(20, 40), "x"));
    EXPECT_GT(*std::min_element(high.begin(), high.end()), 0.0f);
}

TEST(WrappedPieces, ContinueAcrossASeam)
{
    // Columns of five pixels, which do not fit: in the margins they are others than at the other end.
    const Wrap wrap = found(spec_of(64, 8), "x");
    std::vector<Index> labels;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < wrap.padded_width(); ++x)
            labels.push_back(Index(x / 5));
    Index count = Index(wrap.padded_width() / 5 + 1);
    const std::vector<Index> pieces = wrapped_pieces(wrap, labels, count);
    ASSERT_EQ(pieces.size(), wrap.pixels());
    EXPECT_GE(count, 12u);
    EXPECT_LE(count, 13u);
    std::vector<int> sizes(count);
    for (const Index piece : pieces) {
        ASSERT_LT(piece, count);
        ++sizes[piece];
    }
    for (const int size : sizes) {
        EXPECT_GE(size, 8 * 2);
        EXPECT_LE(size, 8 * 7);
    }
}

TEST(WrappedPieces, OneForAllStaysOne)
{
    const Wrap wrap = found(spec_of(20, 10), "xy");
    Index count = 1;
    const std::vector<Index> labels(std::size_t(wrap.padded_width()) * std::size_t(wrap.padded_height()), 0);
    EXPECT_EQ(wrapped_pieces(wrap, labels, count), std::vector<Index>(wrap.pixels(), 0));
    EXPECT_EQ(count, 1u);
}

}  // namespace
}  // namespace pimg
