// SPDX-License-Identifier: BSD-3-Clause
// Gain-map JPEG files: what is put in comes out, the base is untouched, and damage is told.
#include <pimg/gain_map.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <pimg/display.h>

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;

constexpr int kWidth = 97, kHeight = 61;  // no multiple of a map's scale

/// Display-linear light: slopes of colour, and a lamp up to `peak` times as bright as SDR white.
ImageBuf scene(float peak)
{
    ImageBuf picture(ImageSpec(kWidth, kHeight, 3, OIIO::TypeFloat));
    picture.specmod().attribute("oiio:ColorSpace", "lin_rec709");
    for (ImageBuf::Iterator<float> p(picture); !p.done(); ++p) {
        const float u = float(p.x()) / kWidth, v = float(p.y()) / kHeight;
        const float lamp = std::exp(-12.0f * ((u - 0.6f) * (u - 0.6f) + (v - 0.4f) * (v - 0.4f)));
        p[0] = 0.05f + 0.3f * u + peak * lamp;
        p[1] = 0.08f + 0.2f * v + 0.8f * peak * lamp;
        p[2] = 0.1f + 0.2f * (1.0f - u) + 0.5f * peak * lamp;
    }
    return picture;
}

/// As an SDR display shows it: rolled off to white.
ImageBuf tone_mapped(const ImageBuf& picture)
{
    ImageBuf result = picture;
    for (ImageBuf::Iterator<float> p(result); !p.done(); ++p)
        for (int c = 0; c < 3; ++c)
            p[c] = p[c] / (1.0f + p[c] / 1.5f);
    return result;
}

std::string jpeg_of(const ImageBuf& linear, int width = kWidth, int height = kHeight)
{
    const ImageBuf encoded = pimg::srgb_encoded(linear);
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto out = OIIO::ImageOutput::create("base.jpg");
    ImageSpec spec(width, height, 3, OIIO::TypeUInt8);
    spec.attribute("Compression", "jpeg:98");
    spec.attribute("Artist", "nobody");
    spec.attribute("Orientation", 6);
    EXPECT_TRUE(out->set_ioproxy(&memory) && out->open("base.jpg", spec)
                && out->write_image(OIIO::TypeFloat, encoded.localpixels()) && out->close())
        << out->geterror();
    return std::string(bytes.begin(), bytes.end());
}

std::vector<float> decoded(const std::string& file)
{
    OIIO::Filesystem::IOMemReader memory(const_cast<char*>(file.data()), file.size());
    const auto in = OIIO::ImageInput::open("file.jpg", nullptr, &memory);
    EXPECT_TRUE(in) << OIIO::geterror();
    std::vector<float> pixels(std::size_t(kWidth * kHeight * 3));
    EXPECT_TRUE(in && in->read_image(0, 0, 0, 3, OIIO::TypeFloat, pixels.data()));
    return pixels;
}

std::string made(const ImageBuf& rendition, const pimg::GainMapOptions& options = {})
{
    std::string file, error;
    EXPECT_TRUE(pimg::add_gain_map(jpeg_of(tone_mapped(rendition)), rendition, options, file, error)) << error;
    return file;
}

/// The 95th percentile of the difference of two pictures' luminances, in stops.
double difference(const ImageBuf& a, const ImageBuf& b)
{
    std::vector<double> stops;
    ImageBuf::ConstIterator<float> q(b);
    for (ImageBuf::ConstIterator<float> p(a); !p.done(); ++p, ++q) {
        const auto light = [](const ImageBuf::ConstIterator<float>& s) {
            return 0.2126 * s[0] + 0.7152 * s[1] + 0.0722 * s[2];
        };
        stops.push_back(std::fabs(std::log2(light(p) / light(q))));
    }
    std::sort(stops.begin(), stops.end());
    return stops[stops.size() * 95 / 100];
}

TEST(GainMap, RenditionComesBack)
{
    const ImageBuf rendition = scene(5.0f);
    for (const int scale : { 1, 2, 4 })
        for (const int channels : { 1, 3 }) {
            const ImageBuf back = pimg::gain_map_rendition(made(rendition, { scale, channels, 90 }));
            ASSERT_FALSE(back.has_error()) << back.geterror();
            ASSERT_EQ(back.spec().width, kWidth);
            EXPECT_LT(difference(back, rendition), 0.1) << scale << " " << channels;
        }
}

TEST(GainMap, BaseIsUntouched)
{
    const ImageBuf rendition = scene(5.0f);
    const std::string base = jpeg_of(tone_mapped(rendition)), file = made(rendition);
    EXPECT_EQ(decoded(base), decoded(file));
    const ImageBuf sdr = pimg::gain_map_rendition(file, 0.0f);
    EXPECT_LT(difference(sdr, tone_mapped(rendition)), 0.1);
    EXPECT_EQ(sdr.spec().get_string_attribute("Artist"), "nobody");
    EXPECT_EQ(sdr.spec().get_int_attribute("Orientation"), 6);
}

TEST(GainMap, HeadroomIsBetweenBaseAndRendition)
{
    const std::string file = made(scene(5.0f));
    float before = 0.0f;
    for (const float headroom : { 0.0f, 0.5f, 1.0f, 2.0f, -1.0f }) {
        const ImageBuf shown = pimg::gain_map_rendition(file, headroom);
        const float lamp = shown.getchannel(int(0.6 * kWidth), int(0.4 * kHeight), 0, 0);
        EXPECT_GT(lamp, before);
        before = lamp;
    }
}

TEST(GainMap, OlderReadersFindTheXmpPacketAndTheIndex)
{
    const std::string file = made(scene(5.0f));
    EXPECT_NE(file.find("hdrgm:Version=\"1.0\""), std::string::npos);
    EXPECT_NE(file.find("Item:Semantic=\"GainMap\""), std::string::npos);
    EXPECT_NE(file.find("hdrgm:HDRCapacityMax"), std::string::npos);

    // Files of before ISO 21496-1 have no binary metadata, and some have no index.
    std::string older = file;
    for (std::size_t at; (at = older.find("urn:iso:std:iso:ts:21496")) != std::string::npos;)
        older[at] = 'x';
    const ImageBuf back = pimg::gain_map_rendition(older);
    ASSERT_FALSE(back.has_error()) << back.geterror();
    EXPECT_LT(difference(back, pimg::gain_map_rendition(file)), 0.001);
    older[older.find(std::string("MPF\0", 4))] = 'x';
    EXPECT_FALSE(pimg::gain_map_rendition(older).has_error());
}

TEST(GainMap, WhatCannotBeIsToldInALine)
{
    const ImageBuf rendition = scene(2.0f);
    const std::string base = jpeg_of(tone_mapped(rendition));
    std::string file, error;
    EXPECT_FALSE(pimg::add_gain_map("no picture", rendition, {}, file, error));
    EXPECT_NE(error.find("JPEG"), std::string::npos);
    EXPECT_FALSE(pimg::add_gain_map(made(rendition), rendition, {}, file, error));
    EXPECT_NE(error.find("already"), std::string::npos);
    EXPECT_FALSE(pimg::add_gain_map(base, ImageBuf(ImageSpec(3, 4, 3, OIIO::TypeFloat)), {}, file, error));
    EXPECT_NE(error.find("3 x 4"), std::string::npos);
    EXPECT_FALSE(pimg::add_gain_map(base, rendition, { 3, 3, 90 }, file, error));
    EXPECT_NE(error.find("scale"), std::string::npos);
    EXPECT_TRUE(pimg::gain_map_rendition(base).has_error());
    EXPECT_FALSE(pimg::has_gain_map(base));
    EXPECT_TRUE(pimg::has_gain_map(made(rendition)));
}

/// Texture of the rendition that the base has not: a map of squares cannot show it, so that one of pixels is made.
TEST(GainMap, FineGainsGetAFineMap)
{
    const ImageBuf smooth = scene(2.0f);
    ImageBuf rough = smooth;
    for (ImageBuf::Iterator<float> p(rough); !p.done(); ++p)
        for (int c = 0; c < 3; ++c)
            p[c] = p[c] * ((p.x() + p.y()) % 2 ? 1.5f : 0.7f);
    std::string found, coarse, error;
    const std::string base = jpeg_of(tone_mapped(smooth));
    ASSERT_TRUE(pimg::add_gain_map(base, rough, {}, found, error)) << error;
    ASSERT_TRUE(pimg::add_gain_map(base, rough, { 2, 3, 90 }, coarse, error)) << error;
    EXPECT_LT(difference(pimg::gain_map_rendition(found), rough), 0.1);
    EXPECT_GT(difference(pimg::gain_map_rendition(coarse), rough), 0.3);
}

TEST(GainMap, MapsLargerThanTheBaseAreRefused)
{
    const std::string file = made(scene(5.0f));
    const std::size_t map = file.find("\xFF\xD8\xFF", 3);
    const ImageBuf small(ImageSpec(16, 8, 3, OIIO::TypeFloat));
    const ImageBuf result = pimg::gain_map_rendition(jpeg_of(small, 16, 8) + file.substr(map));
    EXPECT_NE(result.geterror().find("at most the 16 x 8 of the base"), std::string::npos);
}

/// A header that promises more pixels than the bytes can hold costs no memory.
TEST(GainMap, PromisesAreNotBelieved)
{
    std::string file = made(scene(5.0f));
    const std::size_t frame = file.find(std::string("\xFF\xC0\0\x11\x08", 5));
    ASSERT_NE(frame, std::string::npos);
    file.replace(frame + 5, 4, "\xFF\xDC\xFF\xDC");
    EXPECT_NE(pimg::gain_map_rendition(file).geterror().find("too few"), std::string::npos);
}

TEST(GainMap, DamageEndsInAnErrorOrAPicture)
{
    const std::string file = made(scene(5.0f));
    for (std::size_t size = 0; size < file.size(); size += 41) {
        const ImageBuf result = pimg::gain_map_rendition(file.substr(0, size));
        EXPECT_TRUE(result.has_error()) << "cut off at " << size;
        EXPECT_EQ(result.geterror().find('\n'), std::string::npos);
    }
    const std::size_t header = file.find("MPF");
    const std::size_t map = file.rfind("urn:iso:std:iso:ts:21496");
    for (const std::size_t from : { header, map })
        for (std::size_t at = from; at < from + 150; ++at)
            for (const char value : { char(0), char(0x7F), char(0xFF) }) {
                std::string damaged = file;
                damaged[at] = value;
                const ImageBuf result = pimg::gain_map_rendition(damaged);
                EXPECT_TRUE(result.has_error() || result.spec().width == kWidth);
            }
}

/// A picture without light above SDR white, and a black one, are pictures too.
TEST(GainMap, FlatPictures)
{
    for (const float value : { 0.0f, 0.5f }) {
        ImageBuf flat(ImageSpec(kWidth, kHeight, 3, OIIO::TypeFloat));
        for (ImageBuf::Iterator<float> p(flat); !p.done(); ++p)
            for (int c = 0; c < 3; ++c)
                p[c] = value;
        flat.specmod().attribute("oiio:ColorSpace", "lin_rec709");
        std::string file, error;
        ASSERT_TRUE(pimg::add_gain_map(jpeg_of(flat), flat, {}, file, error)) << error;
        const ImageBuf back = pimg::gain_map_rendition(file);
        ASSERT_FALSE(back.has_error()) << back.geterror();
        EXPECT_NEAR(back.getchannel(40, 30, 0, 1), value, 0.01f);
    }
}

}  // namespace
