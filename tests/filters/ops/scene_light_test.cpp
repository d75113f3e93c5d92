// SPDX-License-Identifier: BSD-3-Clause
// Tone mapping for what comes before a display: gain, scene-linear light, and the layers that add up to it.
#include <algorithm>
#include <cmath>
#include <limits>

#include <pimg/imagebufalgo.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using namespace test;
using OIIO::ImageBuf;

HdrCompressOptions with_output(const char* output)
{
    HdrCompressOptions options;
    options.output = output;
    return options;
}

ImageBuf filtered(const ImageBuf& src, const HdrCompressOptions& options)
{
    ImageBuf dst;
    EXPECT_FILTER(dst, ImageBufAlgo::hdr_compress(dst, src, options));
    return dst;
}

TEST(SceneLight, IsTheSourceTimesTwoToTheGain)
{
    const ImageBuf src = hdr_scene(96, 64, OIIO::TypeFloat, 4);
    const ImageBuf gain = filtered(src, with_output("gain")), scene = filtered(src, with_output("scene"));
    ASSERT_EQ(gain.nchannels(), 1);
    EXPECT_EQ(gain.spec().channelnames[0], "gain");
    ASSERT_EQ(scene.nchannels(), 4);
    const std::vector<float> g = pixels(gain), from = pixels(src), to = pixels(scene);
    for (std::size_t i = 0; i < g.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(to[4 * i + c], from[4 * i + c] * std::exp2(g[i]), 1e-5f * to[4 * i + c]);
        ASSERT_EQ(to[4 * i + 3], from[4 * i + 3]);
    }
    const auto [least, most] = std::minmax_element(g.begin(), g.end());
    EXPECT_GT(*most - *least, 3.0f) << "the scene is compressed";
}

TEST(SceneLight, MiddleGreyStays)
{
    ImageBuf src = picture(96, 64, 3, OIIO::TypeFloat);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            const float light = x < 32 ? 0.001f : x < 64 ? 0.18f : 30.0f, rgb[3] = { light, light, light };
            src.setpixel(x, y, rgb);
        }
    const ImageBuf scene = filtered(src, with_output("scene"));
    EXPECT_NEAR(scene.getchannel(48, 32, 0, 1), 0.18f, 0.002f);
    EXPECT_GT(scene.getchannel(10, 32, 0, 1), 0.002f);
    EXPECT_LT(scene.getchannel(90, 32, 0, 1), 15.0f);
}

TEST(SceneLight, LayersStillAddUp)
{
    ImageBuf src = picture(48, 40, 13, OIIO::TypeHalf);
    src.specmod().channelnames = { "R",      "G",      "B",      "A", "diffuse.R", "diffuse.G", "diffuse.B",
                                   "spec.R", "spec.G", "spec.B", "Z", "DiffCol.R", "N.X" };
    const ImageBuf light = hdr_scene(48, 40);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 48; ++x) {
            float sample[13] = {};
            for (int c = 0; c < 3; ++c) {
                const float all = light.getchannel(x + light.xbegin(), y + light.ybegin(), 0, c);
                sample[4 + c] = 0.75f * all;
                sample[7 + c] = 0.25f * all;
                sample[c] = all;
            }
            sample[3] = 1.0f;
            sample[10] = 20.0f;
            sample[11] = sample[12] = 0.5f;
            src.setpixel(x, y, sample);
        }
    HdrCompressOptions options = with_output("scene");
    options.aovs = true;
    ImageBuf as_half(src.spec());
    EXPECT_FILTER(as_half, ImageBufAlgo::hdr_compress(as_half, src, options));
    const std::vector<float> from = pixels(src), to = pixels(as_half),
                             gain = pixels(filtered(src, with_output("gain")));
    for (std::size_t i = 0; i < to.size(); i += 13) {
        for (const std::size_t c : { 0, 1, 2, 4, 5, 6, 7, 8, 9 }) {
            const float exact = from[i + c] * std::exp2(gain[i / 13]);
            ASSERT_NEAR(to[i + c], exact, 0x1p-11f * exact + 0x1p-24f) << "more than the rounding of a half";
        }
        for (const std::size_t c : { 3, 10, 11, 12 })
            ASSERT_EQ(to[i + c], from[i + c]) << "alpha, depth, surfaces and normals are no light";
    }
}

TEST(SceneLight, OnlyLayersOfLightGetTheGain)
{
    for (const char* layer : { "diffuse", "matte_painting_light", "mattepainting", "fog", "VRayZDepth", "WorldPosition",
                               "shadingNormal", "baseColor", "uCryptoAsset00", "Ng", "albedo", "DiffCol" }) {
        ImageBuf src = picture(24, 20, 6, OIIO::TypeFloat);
        const std::string name = layer;
        src.specmod().channelnames = { "R", "G", "B", name + ".R", name + ".G", name + ".B" };
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 24; ++x) {
                const float light = x < 12 ? 0.01f : 10.0f, sample[6] = { light, light, light, 1.0f, 1.0f, 1.0f };
                src.setpixel(x, y, sample);
            }
        HdrCompressOptions options = with_output("scene");
        options.aovs = true;
        options.s0 = 0.3f;
        const bool is_light =
            name.find("light") != name.npos || name.find("painting") != name.npos || name == "diffuse" || name == "fog";
        EXPECT_EQ(filtered(src, options).getchannel(4, 4, 0, 3) != 1.0f, is_light) << name;
    }
}

/// What is to add up is not stored by lossy compression; see ask_for_lossless().
TEST(SceneLight, IsStoredWithoutLoss)
{
    ImageBuf src = hdr_scene();
    for (const char* compression : { "dwab:60", "b44", "pxr24" }) {
        src.specmod().attribute("compression", compression);
        EXPECT_EQ(filtered(src, with_output("scene")).spec().get_string_attribute("compression"), "zip");
        EXPECT_EQ(filtered(src, with_output("gain")).spec().get_string_attribute("compression"), "zip");
        EXPECT_EQ(filtered(src, {}).spec().get_string_attribute("compression"), compression);
    }
}

TEST(SceneLight, LayersNeedSceneLinearOutput)
{
    HdrCompressOptions options;
    options.aovs = true;
    ImageBuf dst;
    EXPECT_FALSE(ImageBufAlgo::hdr_compress(dst, hdr_scene(), options));
    EXPECT_NE(dst.geterror().find("output=scene"), std::string::npos);
}

TEST(SceneLight, WhatIsNotFiniteComesBack)
{
    ImageBuf src = hdr_scene();
    const float inf = std::numeric_limits<float>::infinity(), rgb[3] = { inf, 1.0f, std::nanf("") };
    src.setpixel(src.xbegin() + 4, src.ybegin() + 4, rgb);
    const ImageBuf scene = filtered(src, with_output("scene")), gain = filtered(src, with_output("gain"));
    EXPECT_EQ(scene.getchannel(src.xbegin() + 4, src.ybegin() + 4, 0, 0), inf);
    EXPECT_TRUE(std::isnan(scene.getchannel(src.xbegin() + 4, src.ybegin() + 4, 0, 2)));
    for (const float g : pixels(gain))
        ASSERT_TRUE(std::isfinite(g));
}

TEST(SceneLight, AWindowHasThePixelsOfTheWhole)
{
    const ImageBuf src = hdr_scene();
    for (const char* output : { "gain", "scene" }) {
        const ImageBuf whole = filtered(src, with_output(output));
        ImageBuf part;
        OIIO::ROI window = window_of(src);
        window.chend = whole.nchannels();
        EXPECT_FILTER(part, ImageBufAlgo::hdr_compress(part, src, with_output(output), window, 3));
        EXPECT_TRUE(identical(pixels(part, window), pixels(whole, window))) << output;
    }
}

TEST(SceneLight, EncodedPicturesAreDecoded)
{
    ImageBuf src = picture(32, 32, 3, OIIO::TypeUInt8);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const float v = x < 16 ? 0.2f : 0.8f, rgb[3] = { v, v, v };
            src.setpixel(x, y, rgb);
        }
    const float g = filtered(src, with_output("gain")).getchannel(src.xbegin() + 4, src.ybegin() + 4, 0, 0);
    const float linear = float(std::pow((51.0 / 255.0 + 0.055) / 1.055, 2.4));
    EXPECT_NEAR(filtered(src, with_output("scene")).getchannel(src.xbegin() + 4, src.ybegin() + 4, 0, 0),
                linear * std::exp2(g), 1e-4f);
}

}  // namespace
}  // namespace pimg
