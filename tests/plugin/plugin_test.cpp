// SPDX-License-Identifier: BSD-3-Clause
// pimg.imageio as programs see it: through OpenImageIO, which finds the plugin in $OIIO_LIBRARY_PATH.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <functional>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/texture.h>
#include <OpenImageIO/thread.h>

#include <pimg/detail/oiio_compat.h>

#include "plugin/plugin_pictures.h"
#include "watchdog.h"

using namespace pimg_test;

namespace {

void expect_same(const Picture& picture, OIIO::ImageInput& in)
{
    EXPECT_EQ(in.spec().format, picture.spec.format);
    EXPECT_EQ(in.spec().channelformats, picture.spec.channelformats);
    EXPECT_EQ(in.spec().channelnames, picture.spec.channelnames);
    EXPECT_EQ(in.spec().roi(), picture.spec.roi());
    EXPECT_EQ(in.spec().roi_full(), picture.spec.roi_full());
    EXPECT_TRUE(read_native(in) == picture.pixels);
}

/// Calls body(t) for every t below `count`, each on a thread of its own.
template<class Body>
void on_threads(unsigned count, const Body& body)
{
    std::vector<std::thread> threads(count);
    for (unsigned t = 0; t < count; ++t)
        threads[t] = std::thread([&body, t] { body(t); });
    for (std::thread& thread : threads)
        thread.join();
}

// ---- samples, windows, metadata ---------------------------------------------------------------------------------

TEST(Plugin, ReturnsEverySampleOfEveryType)
{
    for (const TypeDesc type : { TypeDesc::UINT8, TypeDesc::UINT16, TypeDesc::UINT32, TypeDesc::HALF, TypeDesc::FLOAT })
        for (const int channels : { 1, 2, 3, 4, 5, 9 })
            for (const auto& [width, height] : { std::pair(1, 1), { 1, 7 }, { 9, 1 }, { 2, 2 }, { 33, 31 } }) {
                SCOPED_TRACE(testing::Message()
                             << type.c_str() << " x " << channels << ", " << width << " x " << height);
                const Picture picture = noise(ImageSpec(width, height, channels, type));
                write(picture, "types.pimg");
                expect_same(picture, *open("types.pimg"));
            }
}

TEST(Plugin, ReturnsAllHalfPatterns)
{
    Picture picture = noise(ImageSpec(256, 256, 1, TypeDesc::HALF));
    for (std::size_t i = 0; i < 65536; ++i) {
        const auto bits = std::uint16_t(i);
        std::memcpy(&picture.pixels[2 * i], &bits, 2);
    }
    for (const char* profile : { "compact", "full" }) {
        picture.spec.attribute("pimg:profile", profile);
        write(picture, "half.pimg");
        expect_same(picture, *open("half.pimg"));
    }
}

TEST(Plugin, ReturnsChannelsOfMixedTypes)
{
    ImageSpec spec(40, 30, 5, TypeDesc::FLOAT);
    spec.channelformats = { TypeDesc::HALF, TypeDesc::HALF, TypeDesc::HALF, TypeDesc::FLOAT, TypeDesc::UINT8 };
    spec.channelnames = { "R", "G", "B", "Z", "mask" };
    for (const int depth : { -1, 3 }) {
        spec.z_channel = depth;
        const Picture picture = noise(spec);
        write(picture, "mixed.pimg");
        expect_same(picture, *open("mixed.pimg"));
        EXPECT_EQ(open("mixed.pimg")->spec().z_channel, depth);
    }
}

TEST(Plugin, StoresTypesItDoesNotHaveAsFloat)
{
    for (const TypeDesc type : { TypeDesc::INT8, TypeDesc::INT16, TypeDesc::INT32, TypeDesc::DOUBLE }) {
        Picture picture = noise(ImageSpec(5, 4, 1, type));
        if (type == TypeDesc::DOUBLE)
            std::fill(picture.pixels.begin(), picture.pixels.end(), 0);
        write(picture, "other.pimg");
        EXPECT_EQ(open("other.pimg")->spec().format, TypeDesc(TypeDesc::FLOAT));
    }
}

TEST(Plugin, KeepsWindowsAndWhichChannelIsAlpha)
{
    ImageSpec spec(20, 10, 4, TypeDesc::UINT8);
    spec.x = -7, spec.y = 100000;
    spec.full_x = 12, spec.full_y = -30000, spec.full_width = 3, spec.full_height = 70000;
    spec.channelnames = { "a", "b", "coverage", "d" };
    spec.alpha_channel = 2, spec.z_channel = 0;
    const Picture picture = noise(spec);
    write(picture, "windows.pimg");
    const auto in = open("windows.pimg");
    expect_same(picture, *in);
    EXPECT_EQ(in->spec().alpha_channel, 2);
    EXPECT_EQ(in->spec().z_channel, 0);
    EXPECT_EQ(in->spec().find_attribute("pimg:alpha_channel"), nullptr);
}

/// Attributes of every base type, aggregate, meaning and length.
ImageSpec full_of_attributes()
{
    ImageSpec spec(4, 4, 3, TypeDesc::UINT8);
    const std::vector<std::uint8_t> bytes = noise(ImageSpec(64, 64, 1, TypeDesc::UINT8)).pixels;
    for (int base = TypeDesc::UINT8; base <= TypeDesc::DOUBLE; ++base)
        for (const auto aggregate : { TypeDesc::SCALAR, TypeDesc::VEC2, TypeDesc::VEC3, TypeDesc::VEC4,
                                      TypeDesc::MATRIX33, TypeDesc::MATRIX44 })
            for (const auto meaning : { TypeDesc::NOSEMANTICS, TypeDesc::COLOR, TypeDesc::POINT, TypeDesc::TIMECODE,
                                        TypeDesc::KEYCODE, TypeDesc::RATIONAL })
                for (const int length : { 0, 1, 3 }) {
                    const TypeDesc type { TypeDesc::BASETYPE(base), aggregate, meaning, length };
                    spec.attribute("test:" + std::to_string(spec.extra_attribs.size()), type, bytes.data());
                }
    const OIIO::ustring words[] = { OIIO::ustring("one"), OIIO::ustring(""), OIIO::ustring("drei \xe2\x82\xac") };
    spec.attribute("words", TypeDesc(TypeDesc::STRING, 3), words);
    spec.attribute("word", "a \"quoted\"\nword");
    spec.attribute("nothing", "");
    spec.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, 3000), bytes.data());
    spec.attribute("oiio:ColorSpace", "lin_rec709");
    spec.attribute("smpte:TimeCode", OIIO::TypeTimeCode, bytes.data());
    spec.attribute("progressive:note", 3.5f);
    return spec;
}

TEST(Plugin, KeepsMetadataOfEveryType)
{
    ImageSpec spec = full_of_attributes();
    const std::size_t count = spec.extra_attribs.size();
    EXPECT_GT(count, 1000u);
    spec.attribute("pimg:vertices", 0.02f);
    spec.attribute("pimg:hdr_compress", 1);
    spec.attribute("compression", "zip");
    spec.attribute("thumbnail_width", 12345);
    write(noise(spec), "metadata.pimg");
    const auto in = open("metadata.pimg");
    for (std::size_t i = 0; i < count; ++i) {
        const OIIO::ParamValue& wanted = spec.extra_attribs[int(i)];
        const OIIO::ParamValue* found = in->spec().find_attribute(wanted.name());
        ASSERT_TRUE(found) << wanted.name();
        ASSERT_EQ(found->type(), wanted.type()) << wanted.name();
        ASSERT_EQ(std::memcmp(found->data(), wanted.data(), wanted.type().size()), 0) << wanted.name();
    }
    EXPECT_EQ(in->spec().find_attribute("pimg:vertices"), nullptr);
    EXPECT_EQ(in->spec().find_attribute("pimg:hdr_compress"), nullptr);
    EXPECT_EQ(in->spec().get_string_attribute("compression"), "compact");
    EXPECT_EQ(in->spec().get_int_attribute("thumbnail_width"), 4);
}

TEST(Plugin, HandsOnNoHintsOfOtherFormats)
{
    ImageSpec spec(4, 4, 3, TypeDesc::UINT8);
    for (const char* name : { "tiff:RowsPerStrip", "png:compressionLevel", "openexr:lineOrder", "jpeg:progressive",
                              "planarconfig", "oiio:SHA-1", "Orientation", "oiio:BitsPerSample" })
        spec.attribute(name, 1000000000);
    spec.attribute("Exif:ISOSpeedRatings", 100);
    write(noise(spec), "hints.pimg");
    const auto in = open("hints.pimg");
    EXPECT_EQ(in->spec().get_int_attribute("Exif:ISOSpeedRatings"), 100);
    for (const OIIO::ParamValue& attribute : in->spec().extra_attribs)
        EXPECT_NE(attribute.get_int(), 1000000000) << attribute.name();
}

TEST(Plugin, HasAThumbnailOfThePicture)
{
    const Picture picture = slope(ImageSpec(600, 300, 4, TypeDesc::UINT8));
    write(picture, "thumbnail.pimg");
    const auto in = open("thumbnail.pimg");
    OIIO::ImageBuf thumbnail, resized;
    ASSERT_TRUE(in->get_thumbnail(thumbnail, 0));
    EXPECT_EQ(thumbnail.spec().width, in->spec().get_int_attribute("thumbnail_width"));
    EXPECT_EQ(thumbnail.spec().height, in->spec().get_int_attribute("thumbnail_height"));
    EXPECT_EQ(thumbnail.nchannels(), in->spec().get_int_attribute("thumbnail_nchannels"));
    EXPECT_EQ(thumbnail.spec().width, 256);
    EXPECT_EQ(thumbnail.spec().height, 128);
    pimg::resize_picture(resized, OIIO::ImageBuf("thumbnail.pimg"), "", thumbnail.roi(), 0);
    EXPECT_LT(OIIO::ImageBufAlgo::compare(thumbnail, resized, 1.0f, 1.0f).rms_error, 0.02);
    EXPECT_FALSE(in->get_thumbnail(thumbnail, 1));
    EXPECT_TRUE(OIIO::ImageBuf("thumbnail.pimg").has_thumbnail());
}

// ---- ways in and out --------------------------------------------------------------------------------------------

/// The bytes a picture becomes, by a proxy.
std::vector<unsigned char> written(const Picture& picture, int threads = 0)
{
    OIIO::Filesystem::IOVecOutput proxy;
    auto out = OIIO::ImageOutput::create("proxy.pimg", &proxy);
    EXPECT_TRUE(out) << OIIO::geterror();
    out->threads(threads);
    EXPECT_TRUE(out->open("proxy.pimg", picture.spec)) << out->geterror();
    EXPECT_TRUE(out->write_image(TypeDesc::UNKNOWN, picture.pixels.data())) << out->geterror();
    EXPECT_TRUE(out->close());
    return proxy.buffer();
}

TEST(Plugin, WritesTheSameBytesEveryWay)
{
    Picture picture = slope(ImageSpec(300, 280, 3, TypeDesc::HALF));
    for (const char* profile : { "compact", "full" }) {
        picture.spec.attribute("pimg:profile", profile);
        write(picture, "bytes.pimg");
        const std::vector<unsigned char> file = bytes_of("bytes.pimg");
        for (const int threads : { 0, 1, 3, 16 })
            EXPECT_TRUE(written(picture, threads) == file) << threads;
        OIIO::ImageBuf buffer(picture.spec);
        buffer.set_pixels(buffer.roi(), TypeDesc::HALF, picture.pixels.data());
        OIIO::Filesystem::IOVecOutput proxy;
        buffer.set_write_ioproxy(&proxy);
        ASSERT_TRUE(buffer.write("buffer.pimg")) << buffer.geterror();
        EXPECT_TRUE(proxy.buffer() == file);
    }
    EXPECT_FALSE(OIIO::Filesystem::exists("proxy.pimg"));
}

TEST(Plugin, ReadsFromMemory)
{
    const Picture picture = slope(ImageSpec(50, 40, 3, TypeDesc::UINT16));
    const std::vector<unsigned char> file = written(picture);
    OIIO::Filesystem::IOMemReader proxy(file.data(), file.size());
    expect_same(picture, *OIIO::ImageInput::open("memory.pimg", nullptr, &proxy));
    OIIO::ImageBuf buffer("memory2.pimg", 0, 0, nullptr, nullptr, &proxy);
    ASSERT_TRUE(buffer.read(0, 0, true)) << buffer.geterror();
    EXPECT_EQ(std::memcmp(buffer.localpixels(), picture.pixels.data(), picture.pixels.size()), 0);
    ImageSpec config;
    OIIO::Filesystem::IOProxy* pointer = &proxy;
    config.attribute("oiio:ioproxy", TypeDesc::PTR, &pointer);
    expect_same(picture, *OIIO::ImageInput::open("memory3.pimg", &config));
}

TEST(Plugin, WritesTilesAndScanlinesInAnyOrder)
{
    const Picture picture = slope(ImageSpec(150, 130, 3, TypeDesc::UINT8));
    ImageSpec spec = picture.spec;
    spec.tile_width = 64, spec.tile_height = 48;
    auto out = OIIO::ImageOutput::create("tiles.pimg");
    ASSERT_TRUE(out->open("tiles.pimg", spec)) << out->geterror();
    ASSERT_TRUE(out->write_image(TypeDesc::UINT8, picture.pixels.data())) << out->geterror();
    ASSERT_TRUE(out->close());
    expect_same(picture, *open("tiles.pimg"));

    ASSERT_TRUE(out->open("upwards.pimg", picture.spec)) << out->geterror();
    for (int y = spec.height - 1; y >= 0; --y)
        ASSERT_TRUE(out->write_scanline(y, 0, TypeDesc::UINT8, &picture.pixels[std::size_t(y) * 450]));
    ASSERT_TRUE(out->close());
    EXPECT_TRUE(bytes_of("upwards.pimg") == bytes_of("tiles.pimg"));
}

TEST(Plugin, ReadsPartsInAnyOrder)
{
    ImageSpec spec(300, 270, 5, TypeDesc::FLOAT);
    spec.channelformats = { TypeDesc::HALF, TypeDesc::UINT8, TypeDesc::FLOAT, TypeDesc::UINT16, TypeDesc::HALF };
    spec.x = 11, spec.y = -20;
    const Picture picture = noise(spec);
    write(picture, "parts.pimg");
    const auto in = open("parts.pimg");
    const std::size_t pixel = spec.pixel_bytes(true), row = spec.scanline_bytes(true);
    for (const int y : { 269, 0, 255, 256, 1, 100, 257 }) {
        std::vector<std::uint8_t> line(row);
        ASSERT_TRUE(in->read_scanline(y + spec.y, 0, TypeDesc::UNKNOWN, line.data())) << in->geterror();
        EXPECT_EQ(std::memcmp(line.data(), &picture.pixels[std::size_t(y) * row], row), 0) << y;
    }
    // Channels [1, 4) of some scanlines, into a buffer with gaps.
    constexpr std::size_t kPixel = 40, kRow = 300 * kPixel + 24;
    std::vector<std::uint8_t> gaps(kRow * 270, 0xee);
    ASSERT_TRUE(
        in->read_scanlines(0, 0, spec.y + 250, spec.y + 262, 0, 1, 4, TypeDesc::FLOAT, gaps.data(), kPixel, kRow));
    std::vector<float> all(300 * 270 * 5);
    ASSERT_TRUE(in->read_image(0, 0, 0, 5, TypeDesc::FLOAT, all.data()));
    for (std::size_t y = 250; y < 262; ++y)
        for (std::size_t x = 0; x < 300; ++x) {
            const std::uint8_t* to = &gaps[(y - 250) * kRow + x * kPixel];
            const auto* expected = reinterpret_cast<const std::uint8_t*>(&all[(y * 300 + x) * 5 + 1]);
            ASSERT_TRUE(std::equal(to, to + 12, expected));
            ASSERT_EQ(to[12], 0xee);
        }
    EXPECT_FALSE(in->read_scanline(spec.y - 1, 0, TypeDesc::UNKNOWN, gaps.data()));
    EXPECT_FALSE(in->geterror().empty());
    EXPECT_EQ(pixel, 11u);
}

// ---- life of a reader and a writer ------------------------------------------------------------------------------

TEST(Plugin, KnowsItsFiles)
{
    write(slope(ImageSpec(8, 8, 1, TypeDesc::UINT8)), "valid.pimg");
    OIIO::Filesystem::write_text_file("text.pimg", "not a picture, whatever its name says");
    OIIO::Filesystem::write_text_file("empty.pimg", "");
    const auto in = OIIO::ImageInput::create("pimg");
    ASSERT_TRUE(in) << OIIO::geterror();
    EXPECT_TRUE(in->valid_file("valid.pimg"));
    EXPECT_TRUE(in->valid_file("valid.pimg?level=1"));
    for (const char* name : { "text.pimg", "empty.pimg", "absent.pimg", "." })
        EXPECT_FALSE(in->valid_file(name)) << name;
    EXPECT_FALSE(in->has_error());
}

TEST(Plugin, CanBeReopenedAndClosedTwice)
{
    const Picture picture = slope(ImageSpec(8, 8, 1, TypeDesc::UINT8));
    write(picture, "again.pimg");
    OIIO::Filesystem::write_text_file("text.pimg", "not a picture");
    const auto in = OIIO::ImageInput::create("pimg");
    ImageSpec spec;
    for (int i = 0; i < 3; ++i) {
        EXPECT_FALSE(in->open("text.pimg", spec));
        EXPECT_NE(in->geterror().find("text.pimg"), std::string::npos);
        EXPECT_FALSE(in->open("absent.pimg", spec));
        EXPECT_FALSE(in->geterror().empty());
        ASSERT_TRUE(in->open("again.pimg", spec)) << in->geterror();
        expect_same(picture, *in);
        if (i != 1) {
            EXPECT_TRUE(in->close());
        }
    }
    EXPECT_TRUE(in->close());
    EXPECT_TRUE(in->close());
}

TEST(Plugin, WriterIsAsGoodAsItsWord)
{
    const auto out = OIIO::ImageOutput::create("word.pimg");
    for (const char* can : { "tiles", "alpha", "nchannels", "channelformats", "displaywindow", "origin",
                             "negativeorigin", "ioproxy", "arbitrary_metadata", "random_access" })
        EXPECT_TRUE(out->supports(can)) << can;
    for (const char* cannot : { "rectangles", "volumes", "deepdata", "multiimage", "appendsubimage", "mipmap",
                                "thumbnail", "procedural", "empty", "rewrite" })
        EXPECT_FALSE(out->supports(cannot)) << cannot;
    const Picture picture = slope(ImageSpec(8, 8, 1, TypeDesc::UINT8));
    ASSERT_TRUE(out->open("word.pimg", picture.spec));
    ASSERT_TRUE(out->write_image(TypeDesc::UINT8, picture.pixels.data()));
    EXPECT_FALSE(out->write_scanline(0, 0, TypeDesc::UINT8, picture.pixels.data()));
    EXPECT_FALSE(out->geterror().empty());
    EXPECT_FALSE(out->open("word.pimg", picture.spec, OIIO::ImageOutput::AppendSubimage));
    EXPECT_NE(out->geterror().find("one image"), std::string::npos);
    EXPECT_FALSE(out->open("word.pimg", picture.spec, OIIO::ImageOutput::AppendMIPLevel));
    EXPECT_NE(out->geterror().find("one image"), std::string::npos);
    EXPECT_TRUE(out->close());
    expect_same(picture, *open("word.pimg"));
}

void expect_refused(const ImageSpec& spec, const std::string& name, const std::string& says)
{
    const auto out = OIIO::ImageOutput::create("pimg");
    EXPECT_FALSE(out->open(name, spec)) << says;
    EXPECT_NE(out->geterror().find(says), std::string::npos) << says;
    EXPECT_TRUE(out->close());
}

TEST(Plugin, RefusesEarlyWhatItCannotWrite)
{
    const ImageSpec good(8, 8, 1, TypeDesc::UINT8);
    expect_refused(good, "no/such/folder/a.pimg", "a.pimg");
    expect_refused(good, ".", "directory");
    ImageSpec bad = good;
    bad.depth = 2;
    expect_refused(bad, "bad.pimg", "volumes");
    bad = good;
    bad.deep = true;
    expect_refused(bad, "bad.pimg", "deep");
    expect_refused(ImageSpec(0, 8, 1, TypeDesc::UINT8), "bad.pimg", "0 x 8");
    expect_refused(ImageSpec(8, 2000000, 1, TypeDesc::UINT8), "bad.pimg", "2000000");
    expect_refused(ImageSpec(8, 8, 1025, TypeDesc::UINT8), "bad.pimg", "1025 channels");
    bad = good;
    bad.attribute("pimg:profile", "better");
    expect_refused(bad, "bad.pimg", "compact");
    EXPECT_FALSE(OIIO::Filesystem::exists("bad.pimg"));
}

TEST(Plugin, LeavesNoFileBehindHalfAPicture)
{
    const Picture picture = slope(ImageSpec(8, 8, 1, TypeDesc::UINT8));
    const Picture other = noise(picture.spec);
    write(other, "half.pimg");
    {
        const auto out = OIIO::ImageOutput::create("half.pimg");
        ASSERT_TRUE(out->open("half.pimg", picture.spec));
        ASSERT_TRUE(out->write_scanline(0, 0, TypeDesc::UINT8, picture.pixels.data()));
        EXPECT_FALSE(out->close());
        EXPECT_NE(out->geterror().find("7 of 8"), std::string::npos);
    }
    expect_same(other, *open("half.pimg"));
    {
        const auto out = OIIO::ImageOutput::create("destroyed.pimg");
        ASSERT_TRUE(out->open("destroyed.pimg", picture.spec));
        ASSERT_TRUE(out->write_image(TypeDesc::UINT8, picture.pixels.data()));
    }
    expect_same(picture, *open("destroyed.pimg"));
    std::vector<std::string> names;
    OIIO::Filesystem::get_directory_entries(".", names, false, "temp");
    EXPECT_TRUE(names.empty());
}

/// A disk with room for a hundred bytes.
class SmallDisk final : public OIIO::Filesystem::IOProxy {
public:
    SmallDisk() : IOProxy("small", Write) { }
    const char* proxytype() const override { return "small"; }
    std::size_t write(const void*, std::size_t size) override { return std::min<std::size_t>(size, 100); }
};

TEST(Plugin, ReportsErrorsFromWriteNotClose)
{
    Picture picture = slope(ImageSpec(8, 8, 1, TypeDesc::UINT8));
    SmallDisk disk;
    const auto out = OIIO::ImageOutput::create("small.pimg", &disk);
    ASSERT_TRUE(out->open("small.pimg", picture.spec));
    EXPECT_FALSE(out->write_image(TypeDesc::UINT8, picture.pixels.data()));
    EXPECT_FALSE(out->geterror().empty());
    EXPECT_TRUE(out->close());

    picture.spec.channelnames = { std::string(300, 'x') };  // only the encoder knows that this is too long
    OIIO::ImageBuf buffer(picture.spec);
    EXPECT_FALSE(buffer.write("long.pimg"));
    EXPECT_FALSE(buffer.geterror().empty());
    EXPECT_FALSE(OIIO::Filesystem::exists("long.pimg"));
}

// ---- damage and limits ------------------------------------------------------------------------------------------

/// Reads a file from memory; true, with its samples, if that succeeds, else there must be a message.
bool reads(const std::vector<unsigned char>& file, std::vector<std::uint8_t>& pixels, bool partial = false)
{
    OIIO::Filesystem::IOMemReader proxy(file.data(), file.size());
    ImageSpec config;
    config.attribute("pimg:partial", int(partial));
    ImageSpec spec;
    const auto in = OIIO::ImageInput::create("pimg");
    in->set_ioproxy(&proxy);
    bool done = in->open("damaged.pimg", spec, config);
    if (done) {
        pixels.assign(spec.image_bytes(true), 0);
        done = in->read_image(0, 0, 0, spec.nchannels, TypeDesc::UNKNOWN, pixels.data());
    }
    EXPECT_EQ(done, !in->has_error());
    in->geterror();
    return done;
}

TEST(Plugin, SurvivesEveryTruncation)
{
    const Picture picture = slope(ImageSpec(24, 17, 3, TypeDesc::UINT8));
    const std::vector<unsigned char> file = written(picture);
    std::vector<std::uint8_t> pixels;
    std::size_t partial = 0;
    for (std::size_t size = 0; size < file.size(); ++size) {
        const std::vector<unsigned char> cut(file.begin(), file.begin() + std::ptrdiff_t(size));
        EXPECT_FALSE(reads(cut, pixels)) << size;
        partial += reads(cut, pixels, true) ? 1 : 0;
    }
    EXPECT_GT(partial, file.size() / 4);
    ASSERT_TRUE(reads(file, pixels));
    EXPECT_TRUE(pixels == picture.pixels);
}

TEST(Plugin, NoticesFlippedBits)
{
    const Picture picture = slope(ImageSpec(24, 17, 3, TypeDesc::UINT8));
    const std::vector<unsigned char> file = written(picture);
    for (std::size_t i = 0; i < file.size(); ++i) {
        std::vector<unsigned char> flipped = file;
        flipped[i] = std::uint8_t(flipped[i] ^ (1u << i % 8));
        std::vector<std::uint8_t> pixels;
        if (reads(flipped, pixels)) {
            EXPECT_TRUE(pixels == picture.pixels) << i;
        }
    }
}

TEST(Plugin, RefusesHeadersBeyondTheLimits)
{
    std::vector<unsigned char> file = written(slope(ImageSpec(24, 17, 3, TypeDesc::UINT8)));
    std::vector<std::uint8_t> pixels;
    for (const std::uint32_t side : { 0u, 100000u, 1u << 20, 1u << 31, 0xffffffffu }) {
        set_size(file, side, side);
        EXPECT_FALSE(reads(file, pixels)) << side;
    }
    const std::vector<unsigned char> large = written(slope(ImageSpec(600, 600, 3, TypeDesc::UINT8)));
    OIIO::attribute("limits:imagesize_MB", 1);
    EXPECT_FALSE(reads(large, pixels));
    OIIO::attribute("limits:imagesize_MB", 2);
    EXPECT_TRUE(reads(large, pixels));
    OIIO::attribute("limits:channels", 2);
    EXPECT_FALSE(reads(large, pixels));
    OIIO::attribute("limits:channels", 1024);
    OIIO::attribute("limits:imagesize_MB", 32768);
}

// ---- many threads -----------------------------------------------------------------------------------------------

TEST(Plugin, OneReaderServesManyThreads)
{
    write(slope(ImageSpec(530, 470, 3, TypeDesc::HALF)), "threads.pimg");
    for (const char* name : { "threads.pimg", "threads.pimg?mip=1", "threads.pimg?feature_lowpass=0.1&mip=1" }) {
        const auto in = open(name), alone = open(name);
        std::vector<std::vector<std::uint8_t>> levels;
        for (int m = 0; alone->seek_subimage(0, m); ++m) {
            const ImageSpec spec = alone->spec(0, m);
            levels.emplace_back(spec.image_bytes(true));
            ASSERT_TRUE(alone->read_image(0, m, 0, 3, TypeDesc::UNKNOWN, levels.back().data()));
        }
        EXPECT_EQ(levels.size(), std::strchr(name, '=') ? 10u : 1u);
        std::atomic<int> wrong { 0 };
        on_threads(8, [&](unsigned t) {
            for (unsigned i = 0; i < 12; ++i) {
                const int m = int((t * 7 + i) % levels.size());
                const ImageSpec spec = in->spec(0, m);
                std::vector<std::uint8_t> pixels(spec.image_bytes(true));
                if (!in->read_image(0, m, 0, 3, TypeDesc::UNKNOWN, pixels.data()) || pixels != levels[std::size_t(m)])
                    ++wrong;
            }
        });
        EXPECT_EQ(wrong, 0) << name;
    }
}

/// Readers in tasks of OpenImageIO's pool wait for the level that a thread of the program is making with that pool.
TEST(Plugin, OneReaderServesThreadsAndTasksOfThePool)
{
    const pimg::test::Watchdog watchdog("reads of one file in threads and in tasks of the pool");
    OIIO::thread_pool* const pool = OIIO::default_thread_pool();
    const int before = pool->size();
    pool->resize(3);
    write(slope(ImageSpec(200, 150, 3, TypeDesc::FLOAT)), "pool.pimg");
    const char* name = "pool.pimg?feature_lowpass=0.1&mip=1";
    const auto read = [](OIIO::ImageInput& in, int level) {
        std::vector<std::uint8_t> pixels(in.spec(0, level).image_bytes(true));
        EXPECT_TRUE(in.read_image(0, level, 0, 3, TypeDesc::UNKNOWN, pixels.data())) << in.geterror();
        return pixels;
    };
    const std::vector<std::uint8_t> expected[2] = { read(*open(name), 0), read(*open(name), 1) };
    for (int repeat = 0; repeat < 10; ++repeat) {
        const auto in = open(name);
        in->threads(4);
        std::atomic<int> wrong { 0 };
        on_threads(8, [&](unsigned t) {
            const int level = int(t % 2);
            auto task = pool->push([&, level](int) { wrong += read(*in, level) != expected[level]; });
            wrong += read(*in, level) != expected[level];
            task.wait();
        });
        EXPECT_EQ(wrong, 0);
    }
    pool->resize(before);
}

TEST(Plugin, WorksInCacheAndTextureSystem)
{
    const Picture picture = slope(ImageSpec(256, 128, 3, TypeDesc::FLOAT));
    write(picture, "texture.pimg");
    for (const char* name : { "texture.pimg", "texture.pimg?mip=1" }) {
        const std::shared_ptr<OIIO::ImageCache> cache = pimg::private_image_cache();
        std::vector<std::uint8_t> pixels(picture.pixels.size());
        ASSERT_TRUE(cache->get_pixels(OIIO::ustring(name), 0, 0, 0, 256, 0, 128, 0, 1, TypeDesc::FLOAT, pixels.data()))
            << cache->geterror();
        EXPECT_TRUE(pixels == picture.pixels);

        const std::shared_ptr<OIIO::TextureSystem> textures = pimg::private_texture_system();
        std::atomic<int> wrong { 0 };
        on_threads(4, [&](unsigned) {
            for (int i = 0; i < 200; ++i) {
                OIIO::TextureOpt options;
                options.swrap = options.twrap = OIIO::TextureOpt::WrapClamp;
                const float s = (float(i % 20) + 0.5f) / 20, width = i % 3 == 0 ? 0.2f : 0.001f;
                float found[3] = {};
                if (!textures->texture(OIIO::ustring(name), options, s, 0.5f, width, 0, 0, width, 3, found)
                    || std::abs(found[0] - slope_at(s * 256 - 0.5f, 63.5f, 0)) > 0.03f)
                    ++wrong;
            }
        });
        EXPECT_EQ(wrong, 0) << name << textures->geterror();
    }
}

}  // namespace
