// SPDX-License-Identifier: BSD-3-Clause
// The .pimg codec: what goes in comes out, from whole files, prefixes, tiles and hierarchies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <pimg/codec.h>
#include <pimg/sampling.h>
#include <pimg/simplify.h>

#include "codec/codec_pictures.h"

namespace {

using namespace pimg;
using namespace pimg_test;

std::vector<std::uint8_t> encoded(const Picture& p, const EncodeOptions& options = {})
{
    std::vector<std::uint8_t> file;
    const Status status = encode(p.desc, p.planes(), options, file);
    EXPECT_TRUE(status) << status.error();
    return file;
}

Status decode(const std::uint8_t* data, std::size_t size, std::vector<std::uint8_t>& pixels, ReadInfo* info = nullptr,
              PictureDesc* desc = nullptr)
{
    Decoder decoder;
    Status status = decoder.open(memory_source(data, size));
    if (!status)
        return status;
    if (desc)
        *desc = decoder.desc();
    pixels.assign(decoder.desc().pixel_bytes() * decoder.desc().pixels(), 0xcd);
    return decoder.read(interleaved(decoder.desc(), (void*)pixels.data()), info);
}

void expect_round_trip(const Picture& p, const EncodeOptions& options = {})
{
    const std::vector<std::uint8_t> file = encoded(p, options);
    std::vector<std::uint8_t> pixels;
    ReadInfo info;
    PictureDesc desc;
    const Status status = decode(file.data(), file.size(), pixels, &info, &desc);
    ASSERT_TRUE(status) << status.error();
    EXPECT_TRUE(pixels == p.pixels);
    EXPECT_TRUE(info.exact && info.hash_checked);
    EXPECT_EQ(info.bytes, file.size());
    ASSERT_EQ(desc.channels.size(), p.desc.channels.size());
    for (std::size_t c = 0; c < desc.channels.size(); ++c) {
        EXPECT_EQ(desc.channels[c].name, p.desc.channels[c].name);
        EXPECT_EQ(desc.channels[c].type, p.desc.channels[c].type);
    }
    EXPECT_EQ(desc.data.x, p.desc.data.x);
    EXPECT_EQ(desc.display.width, p.desc.display.width);
    ASSERT_EQ(desc.attributes.size(), p.desc.attributes.size());
    for (std::size_t i = 0; i < desc.attributes.size(); ++i) {
        EXPECT_EQ(desc.attributes[i].name, p.desc.attributes[i].name);
        EXPECT_EQ(desc.attributes[i].type, p.desc.attributes[i].type);
        EXPECT_EQ(desc.attributes[i].value, p.desc.attributes[i].value);
    }
}

TEST(Codec, RoundTripsEveryTypeSizeAndProfile)
{
    for (Profile profile : { Profile::compact, Profile::full })
        for (int effort : { 0, 1, 2 })
            for (const Picture& p : conformance_pictures()) {
                EncodeOptions options;
                options.profile = profile;
                options.effort = effort;
                options.tile = 16;
                expect_round_trip(p, options);
            }
    for (auto [w, h] :
         { std::pair<unsigned, unsigned>(1, 2), { 2, 1 }, { 2, 2 }, { 3, 3 }, { 1, 40 }, { 257, 3 }, { 300, 270 } })
        expect_round_trip(make_picture(w, h, { SampleType::uint8, SampleType::uint8, SampleType::uint8 }));
}

TEST(Codec, KeepsAll65536HalfPatterns)
{
    Picture p = make_picture(256, 256, { SampleType::half });
    for (std::uint32_t i = 0; i < 65536; ++i) {
        p.pixels[2 * i] = std::uint8_t(i);
        p.pixels[2 * i + 1] = std::uint8_t(i >> 8);
    }
    expect_round_trip(p);
    EncodeOptions full;
    full.profile = Profile::full;
    expect_round_trip(p, full);
}

TEST(Codec, KeepsFloatsThatAreNotNumbers)
{
    Picture p = make_picture(64, 32, { SampleType::float32, SampleType::float32, SampleType::float32 });
    const std::uint32_t odd[] = { 0x7fc00000u, 0x7f800001u, 0xffffffffu, 0x80000000u,
                                  1u,          0x807fffffu, 0x7f800000u, 0xff800000u };
    std::uint32_t seed = 7;
    for (std::size_t i = 0; i < p.pixels.size(); i += 4)
        if (noise(seed) % 3 == 0)
            std::memcpy(&p.pixels[i], &odd[noise(seed) % 8], 4);
    expect_round_trip(p);
    for (std::size_t i = 0; i < p.pixels.size(); ++i)
        p.pixels[i] = std::uint8_t(noise(seed));
    expect_round_trip(p);
}

TEST(Codec, RoundTripsExtremesAndManyChannels)
{
    for (SampleType type : { SampleType::uint8, SampleType::uint16, SampleType::uint32, SampleType::half }) {
        Picture p = make_picture(70, 50, { type, type, type, type });
        for (int kind = 0; kind < 3; ++kind) {
            std::uint32_t seed = 3;
            for (std::uint8_t& b : p.pixels)
                b = kind == 0 ? 0 : kind == 1 ? 255 : std::uint8_t(noise(seed) & 1 ? 255 : 0);
            expect_round_trip(p);
        }
    }
    expect_round_trip(make_picture(19, 23, std::vector<SampleType>(64, SampleType::uint16)));
}

TEST(Codec, ReadsAndWritesAnyStrides)
{
    const Picture p = make_picture(50, 30, { SampleType::uint16, SampleType::uint16 });
    std::vector<std::uint8_t> planar(p.pixels.size());
    const std::size_t plane = 50 * 30 * 2;
    for (std::size_t i = 0; i < 1500; ++i)
        for (std::size_t c = 0; c < 2; ++c)
            std::memcpy(&planar[c * plane + 2 * (1499 - i)], &p.pixels[4 * i + 2 * c], 2);
    // Stored backwards: negative strides.
    std::vector<ConstStridedChannel> from;
    std::vector<StridedChannel> to;
    std::vector<std::uint8_t> back(planar.size());
    for (std::size_t c = 0; c < 2; ++c) {
        from.push_back({ planar.data() + c * plane + plane - 2, -2, -100 });
        to.push_back({ back.data() + c * plane + plane - 2, -2, -100 });
    }
    std::vector<std::uint8_t> file;
    ASSERT_TRUE(encode(p.desc, from, {}, file));
    EXPECT_TRUE(file == encoded(p));
    Decoder decoder;
    ASSERT_TRUE(decoder.open(memory_source(file.data(), file.size())));
    ASSERT_TRUE(decoder.read(to));
    EXPECT_TRUE(back == planar);
    to[0].data = nullptr;
    std::fill(back.begin(), back.end(), 0);
    ASSERT_TRUE(decoder.read(to));
    EXPECT_TRUE(std::equal(back.begin() + plane, back.end(), planar.begin() + plane));
    EXPECT_EQ(back[5], 0);
}

TEST(Codec, TilesEqualTheWholePictureAndThreadsChangeNothing)
{
    const Picture p = make_picture(150, 90, { SampleType::uint8, SampleType::uint8, SampleType::uint8 });
    EncodeOptions options;
    options.tile = 64;
    const auto file = encoded(p, options);
    options.parallel = [](std::size_t n, const std::function<void(std::size_t)>& body) {
        for (std::size_t i = n; i-- > 0;)
            body(i);
    };
    EXPECT_TRUE(file == encoded(p, options));
    Decoder decoder;
    ASSERT_TRUE(decoder.open(memory_source(file.data(), file.size())));
    std::vector<std::uint8_t> tile(64 * 64 * 3);
    std::vector<StridedChannel> planes;
    for (std::size_t c = 0; c < 3; ++c)
        planes.push_back({ tile.data() + c, 3, 64 * 3 });
    ASSERT_TRUE(decoder.read_tile(2, 1, planes));
    for (std::size_t y = 0; y < 26; ++y)
        for (std::size_t x = 0; x < 22 * 3; ++x)
            ASSERT_EQ(tile[y * 192 + x], p.pixels[((64 + y) * 150 + 128) * 3 + x]);
    EXPECT_FALSE(decoder.read_tile(3, 0, planes));
}

TEST(Codec, TheHeaderSaysHowManyVerticesTheMeshLayerHas)
{
    const Picture p = make_picture(150, 90, { SampleType::uint8 });
    for (const float share : { 0.002f, kMeshLayerShare, 0.2f }) {
        EncodeOptions options;
        options.vertices = share;
        std::vector<std::uint8_t> file;
        EncodeStats stats;  // not ReadInfo: a whole file may be read without its mesh layer
        ASSERT_TRUE(encode(p.desc, p.planes(), options, file, &stats));
        Decoder decoder;
        ASSERT_TRUE(decoder.open(memory_source(file.data(), file.size())));
        EXPECT_GT(decoder.vertices(), 0u);
        EXPECT_EQ(decoder.vertices(), stats.mesh_vertices);
    }
}

TEST(Codec, EveryPrefixIsNoWorseThanShorterOnes)
{
    const Picture p = make_picture(200, 150, { SampleType::uint8 });
    EncodeOptions options;
    options.vertices = 0.05f;
    options.tile = 64;
    const auto file = encoded(p, options);
    double last = 1e30;
    int pictures = 0;
    for (std::size_t n = 0; n <= file.size(); n += 53) {
        std::vector<std::uint8_t> pixels;
        if (!decode(file.data(), n, pixels))
            continue;
        double error = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i)
            error += std::pow(double(pixels[i]) - double(p.pixels[i]), 2);
        EXPECT_LE(error, last) << "after " << n << " bytes";
        last = error;
        ++pictures;
    }
    EXPECT_GT(pictures, 50);
}

TEST(Codec, ThumbnailNeedsOnlyTheMeshLayer)
{
    const Picture p = make_picture(200, 100, { SampleType::uint8 });
    const auto file = encoded(p);
    Decoder decoder;
    ASSERT_TRUE(decoder.open(memory_source(file.data(), file.size() / 2)));
    std::vector<std::uint8_t> small(50 * 25);
    ASSERT_TRUE(decoder.read_preview(50, 25, { { small.data(), 1, 50 } }));
    double error = 0;
    for (std::size_t y = 0; y < 25; ++y)
        for (std::size_t x = 0; x < 50; ++x)
            error += std::abs(double(small[y * 50 + x]) - p.pixels[(y * 4 + 2) * 200 + x * 4 + 2]);
    EXPECT_LT(error / 1250, 8);
}

/// A picture's green channel or only one, a value per mesh pixel.
struct MeshGuide {
    explicit MeshGuide(const Picture& p)
        : width(std::max(2, int(p.desc.data.width))),
          height(std::max(2, int(p.desc.data.height)))
    {
        const std::size_t step = p.desc.channels.size();
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const std::size_t from_x = std::min(std::size_t(x), std::size_t(p.desc.data.width) - 1);
                const std::size_t from_y = std::min(std::size_t(y), std::size_t(p.desc.data.height) - 1);
                samples.push_back(p.pixels[(from_y * p.desc.data.width + from_x) * step + (step > 1)]);
            }
    }
    int width, height;
    std::vector<float> samples;
};

void expect_given_back(const Picture& p, const MeshGuide& guide, const Hierarchy& built)
{
    EncodeOptions options;
    options.profile = Profile::full;
    options.hierarchy = &built;
    options.lattice_shift = 0;
    const auto file = encoded(p, options);
    Decoder decoder;
    ASSERT_TRUE(decoder.open(memory_source(file.data(), file.size())));
    EXPECT_TRUE(decoder.has_hierarchy());
    Hierarchy read;
    std::vector<Bands> bands;
    const Status status = decoder.read_hierarchy(p.planes(), { guide.samples.data() }, read, bands);
    ASSERT_TRUE(status) << status.error();
    const Status valid = validate(read);
    EXPECT_TRUE(valid) << valid.error();
    EXPECT_EQ(read.levels(), built.levels());
    EXPECT_EQ(read.between.size(), built.between.size());

    // The same splits: equal sets of fine positions, and bands that give the guide back.
    const auto places = [](const Hierarchy& h) {
        std::vector<std::array<std::int32_t, 4>> all;
        for (const Split& s : h.splits) {
            const bool swap = s.u.y < s.t.y || (s.u.y == s.t.y && s.u.x < s.t.x);
            const Point a = swap ? s.u : s.t, b = swap ? s.t : s.u;
            all.push_back({ a.x, a.y, b.x, b.y });
        }
        std::sort(all.begin(), all.end());
        return all;
    };
    EXPECT_TRUE(places(read) == places(built));
    std::vector<float> samples(guide.samples.size());
    synthesise(read, bands[0], samples.data());
    for (std::size_t i = 0; i < samples.size(); ++i)
        ASSERT_NEAR(samples[i], guide.samples[i], 1e-3);
    std::vector<Bands> again;
    ASSERT_TRUE(analyse(read, { guide.samples.data() }, again));
    for (std::size_t i = 0; i < bands[0].base.size(); ++i)
        EXPECT_NEAR(bands[0].base[i], again[0].base[i], 1e-2);

    // Written again it does not grow: the file's order is a fixed point of level semantics.
    options.hierarchy = &read;
    const auto second = encoded(p, options);
    EXPECT_LE(double(second.size()), 1.02 * double(file.size()) + 24);
}

TEST(Codec, GivesBackTheHierarchy)
{
    const Picture p = make_picture(120, 80, { SampleType::uint8, SampleType::uint8, SampleType::uint8 });
    const MeshGuide guide(p);
    Hierarchy built;
    std::vector<Bands> bands;
    ASSERT_TRUE(simplify({ 120, 80, { { guide.samples.data(), 1.0f } } }, {}, built, bands));
    expect_given_back(p, guide, built);
}

TEST(Codec, GivesBackHierarchiesOfChosenPixels)
{
    std::uint32_t seed = 7;
    for (const auto& [width, height] : { std::pair(120, 80), { 2, 2 }, { 2, 40 }, { 33, 3 }, { 64, 64 }, { 65, 5 } })
        for (const double density : { 0.33, 0.02, 0.9 })
            for (const bool from_map : { false, true }) {
                SCOPED_TRACE(testing::Message() << width << " x " << height << ", density " << density << from_map);
                const Picture p = make_picture(std::uint32_t(width), std::uint32_t(height), { SampleType::uint8 });
                const MeshGuide guide(p);
                const Guide channels { width, height, { { guide.samples.data(), 1.0f } } };
                // A few spots of detail in emptiness: long thin triangles, large circles.
                std::vector<float> map(guide.samples.size(), 0.0f);
                for (std::size_t i = 0; i < 8; ++i)
                    map[noise(seed) % map.size()] = 1.0f;
                SamplingOptions sampling;
                sampling.density = density;
                sampling.map = from_map ? map.data() : nullptr;
                SimplifyOptions options;
                ASSERT_TRUE(sample(channels, sampling, options.start));
                Hierarchy built;
                std::vector<Bands> bands;
                ASSERT_TRUE(simplify(channels, options, built, bands));
                expect_given_back(p, guide, built);
            }
}

TEST(Codec, OpeningReadsOnlyTheHeader)
{
    class Counting : public Source {
    public:
        explicit Counting(std::shared_ptr<const Source> source) : m_source(std::move(source)) { }
        std::uint64_t size() const override { return m_source->size(); }
        bool read(std::uint64_t offset, std::size_t count, void* to) const override
        {
            bytes += count;
            return m_source->read(offset, count, to);
        }
        mutable std::size_t bytes = 0;

    private:
        std::shared_ptr<const Source> m_source;
    };
    const Picture p = make_picture(300, 300, { SampleType::uint8 });
    const auto file = encoded(p);
    const auto source = std::make_shared<Counting>(memory_source(file.data(), file.size()));
    Decoder decoder;
    ASSERT_TRUE(decoder.open(source));
    EXPECT_LT(source->bytes, 512u);
}

/// Whether a file is read to its end without a complaint.
bool is_read(const std::vector<std::uint8_t>& file)
{
    Decoder decoder;
    if (!decoder.open(memory_source(file.data(), file.size())))
        return false;
    std::vector<std::uint8_t> pixels(decoder.desc().pixel_bytes() * decoder.desc().pixels());
    std::vector<ChunkInfo> chunks;
    return decoder.read(interleaved(decoder.desc(), (void*)pixels.data())) && decoder.chunks(chunks)
        && std::string(chunks.back().type) == "DONE";
}

TEST(Codec, EveryFlippedBitIsNoticed)
{
    Picture p = make_picture(20, 9, { SampleType::uint8 });
    p.desc.attributes = { { "note", "string", { 'a', 'b' } } };
    for (const Profile profile : { Profile::compact, Profile::full }) {
        EncodeOptions options;
        options.profile = profile;
        options.vertices = 0.2f;
        std::vector<std::uint8_t> file;
        ASSERT_TRUE(encode(p.desc, p.planes(), options, file));
        ASSERT_TRUE(is_read(file));
        for (std::size_t bit = 0; bit < file.size() * 8; ++bit) {
            std::vector<std::uint8_t> flipped = file;
            flipped[bit / 8] = std::uint8_t(flipped[bit / 8] ^ (1u << bit % 8));
            ASSERT_FALSE(is_read(flipped)) << "bit " << bit;
        }
    }
}

TEST(Codec, AttributesThatPackTooWellAreStoredAsTheyAre)
{
    Picture p = make_picture(8, 8, { SampleType::uint8 });
    for (const std::size_t bytes : { std::size_t(1) << 20, std::size_t(9) << 20 }) {
        p.desc.attributes = { { "zeros", "uint8[]", std::vector<std::uint8_t>(bytes) } };
        const auto file = encoded(p);
        EXPECT_EQ(file.size() > bytes, bytes > std::size_t(4) << 20);
        Decoder decoder;
        ASSERT_TRUE(decoder.open(memory_source(file.data(), file.size())));
        EXPECT_EQ(decoder.desc().attributes[0].value.size(), bytes);
    }
}

TEST(Codec, RefusesWhatIsOverTheLimits)
{
    const Picture p = make_picture(40, 30, { SampleType::uint8, SampleType::half });
    const auto file = encoded(p);
    DecodeLimits limits;
    Decoder decoder;
    const auto refused = [&](auto change) {
        DecodeLimits l;
        change(l);
        return !decoder.open(memory_source(file.data(), file.size()), l) && !decoder.is_open();
    };
    EXPECT_TRUE(refused([](DecodeLimits& l) { l.side = 39; }));
    EXPECT_TRUE(refused([](DecodeLimits& l) { l.pixels = 1199; }));
    EXPECT_TRUE(refused([](DecodeLimits& l) { l.channels = 1; }));
    EXPECT_TRUE(refused([](DecodeLimits& l) { l.sample_bytes = 3599; }));
    EXPECT_FALSE(refused([](DecodeLimits&) {}));
    Picture wrong = p;
    std::vector<std::uint8_t> out;
    wrong.desc.data.width = 0;
    EXPECT_FALSE(encode(wrong.desc, p.planes(), {}, out));
    wrong.desc.data.width = (1u << 20) + 1;
    EXPECT_FALSE(encode(wrong.desc, p.planes(), {}, out));
    EXPECT_FALSE(encode(p.desc, {}, {}, out));
}

TEST(Codec, NeverThrows)
{
    const Picture p = make_picture(40, 30, { SampleType::uint8, SampleType::uint8 });
    const ParallelFor no_threads = [](std::size_t, const std::function<void(std::size_t)>&) {
        throw std::runtime_error("no threads left");
    };
    const std::vector<std::uint8_t> before(3, 7);
    std::vector<std::uint8_t> file = before;
    EncodeOptions options;
    options.tile = 16;
    options.parallel = no_threads;
    EXPECT_NE(encode(p.desc, p.planes(), options, file).error().find("no threads left"), std::string::npos);
    options.parallel = {};
    options.progress = [](float) -> bool {
        throw 1;
    };
    EXPECT_FALSE(encode(p.desc, p.planes(), options, file));
    EXPECT_EQ(file, before);

    options.progress = {};
    ASSERT_TRUE(encode(p.desc, p.planes(), options, file));
    Decoder decoder;
    ASSERT_TRUE(decoder.open(memory_source(file.data(), file.size())));
    std::vector<std::uint8_t> pixels(p.pixels.size());
    EXPECT_FALSE(decoder.read(interleaved(p.desc, (void*)pixels.data()), nullptr, no_threads));
}

}  // namespace
