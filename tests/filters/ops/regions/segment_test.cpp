// SPDX-License-Identifier: BSD-3-Clause
// The segment filter: outputs, counts, nesting, awkward sources, errors.
#include <pimg/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <OpenImageIO/imagebufalgo.h>

#include <pimg/dual_pieces.h>

#include "filters/pictures.h"

namespace pimg {
namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::ROI;
using OIIO::TypeDesc;
using test::labels_of;
namespace iba = pimg::ImageBufAlgo;

/// Discs and shading, other in each channel; alpha a ramp.
ImageBuf picture(int width, int height, int channels = 3, const TypeDesc& type = TypeDesc::UINT8)
{
    ImageBuf buf(ImageSpec(width, height, channels, type));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float p[4];
            for (int c = 0; c < 3; ++c)
                p[c] = test::scene((x + 7 * c) % width, y, width, height) / 255.0f;
            p[channels - 1 == 3 ? 3 : 0] = channels == 4 ? float(x) / float(width) : p[0];
            buf.setpixel(x, y, p);
        }
    return buf;
}

SegmentOptions options_of(int regions, const char* output = "labels")
{
    SegmentOptions options;
    options.regions = regions;
    options.output = output;
    return options;
}

void expect_regions(const ImageBuf& buf, Index regions)
{
    ASSERT_FALSE(buf.has_error()) << buf.geterror();
    std::vector<Index> labels = labels_of(buf), parts = labels;
    EXPECT_EQ(*std::max_element(labels.begin(), labels.end()) + 1, regions);
    EXPECT_EQ(connected_parts(parts, buf.spec().width, buf.spec().height), regions);
    EXPECT_EQ(parts, labels);
}

TEST(Segment, GivesExactlyTheCountAskedForConnectedAndNested)
{
    ProgressiveImage progressive;
    ASSERT_TRUE(progressive.build(picture(90, 70)));
    std::vector<Index> fine;
    for (int regions : { 6300, 3000, 500, 100, 17, 2, 1 }) {
        const ImageBuf buf = iba::segment(progressive, options_of(regions));
        expect_regions(buf, Index(regions));
    }
    for (int regions : { 300, 100, 17, 2, 1 }) {
        const std::vector<Index> labels = labels_of(iba::segment(progressive, options_of(regions)));
        std::set<std::pair<Index, Index>> pairs;
        for (std::size_t p = 0; !fine.empty() && p < labels.size(); ++p)
            pairs.emplace(fine[p], labels[p]);
        EXPECT_TRUE(fine.empty() || pairs.size() == *std::max_element(fine.begin(), fine.end()) + 1);
        fine = labels;
    }
}

TEST(Segment, IsTheSameFromAPictureAtAnyThreadCount)
{
    const ImageBuf src = picture(64, 48);
    const std::vector<Index> one = labels_of(iba::segment(src, options_of(30), {}, 1));
    EXPECT_EQ(labels_of(iba::segment(src, options_of(30), {}, 4)), one);
}

TEST(Segment, MeanKeepsTheMeanAndCopiesAlpha)
{
    const ImageBuf src = picture(64, 48, 4, TypeDesc::FLOAT);
    const ImageBuf mean = iba::segment(src, options_of(20, "mean"));
    ASSERT_FALSE(mean.has_error()) << mean.geterror();
    double sums[2][4] = {};
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 4; ++c) {
                sums[0][c] += double(src.getchannel(x, y, 0, c));
                sums[1][c] += double(mean.getchannel(x, y, 0, c));
                if (c == 3) {
                    ASSERT_EQ(src.getchannel(x, y, 0, c), mean.getchannel(x, y, 0, c));
                }
            }
    for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(sums[0][c], sums[1][c], 1e-5 * sums[0][c]);
}

/// Colours count without a soft alpha; one of nothing, or of all and more, changes none.
TEST(Segment, IgnoresAlphaThatIsNotSoft)
{
    std::vector<Index> labels[2];
    for (int varied = 0; varied < 2; ++varied) {
        ImageBuf src = picture(64, 48, 4, TypeDesc::FLOAT);
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x) {
                float p[4];
                src.getpixel(x, y, p, 4);
                p[3] = varied != 0 ? float((x * 31 + y * 17) % 5) : 1.0f;
                src.setpixel(x, y, p);
            }
        labels[varied] = labels_of(iba::segment(src, options_of(20)));
    }
    EXPECT_EQ(labels[0], labels[1]);
}

TEST(Segment, BoundariesAreWhereLabelsChange)
{
    const ImageBuf src = picture(50, 40);
    const std::vector<Index> labels = labels_of(iba::segment(src, options_of(25)));
    const ImageBuf borders = iba::segment(src, options_of(25, "boundaries"));
    ASSERT_EQ(borders.nchannels(), 1);
    EXPECT_EQ(borders.spec().format, TypeDesc(TypeDesc::UINT8));
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 50; ++x) {
            const std::size_t p = std::size_t(y * 50 + x);
            const bool ends = (x < 49 && labels[p] != labels[p + 1]) || (y < 39 && labels[p] != labels[p + 50]);
            ASSERT_EQ(borders.getchannel(x, y, 0, 0), ends ? 1.0f : 0.0f) << x << " " << y;
        }
}

TEST(Segment, SeesColoursOfTheSameLuma)
{
    // Two halves that only differ in hue: invisible to the guide.
    ImageBuf src(ImageSpec(60, 40, 3, TypeDesc::FLOAT));
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 60; ++x) {
            const float left[3] = { 0.5f, 0.2f, 0.3f };
            const float right[3] = { 0.5f - 0.2f * 0.7152f / 0.2126f, 0.4f, 0.3f };
            src.setpixel(x, y, x < 23 ? left : right);
        }
    const std::vector<Index> labels = labels_of(iba::segment(src, options_of(2)));
    for (std::size_t p = 0; p < labels.size(); ++p)
        ASSERT_EQ(labels[p], p % 60 < 23 ? 0u : 1u);
}

TEST(Segment, TakesEverySource)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const auto& [width, height] : { std::pair { 1, 1 }, { 1, 50 }, { 50, 1 }, { 2, 2 }, { 40, 30 } })
        for (const float special : { 0.5f, -2.0f, 0.0f, 1e30f, nan, inf })
            for (int channels : { 1, 2, 3, 4, 5 }) {
                ImageBuf src(ImageSpec(width, height, channels, TypeDesc::FLOAT));
                std::vector<float> p(std::size_t(channels), 0.5f);
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x) {
                        std::fill(p.begin(), p.end(), x % 9 == 3 && y % 7 == 0 ? special : 0.5f);
                        src.setpixel(x, y, p.data());
                    }
                const int regions = std::min(width * height, 7);
                expect_regions(iba::segment(src, options_of(regions)), Index(regions));
                const ImageBuf mean = iba::segment(src, options_of(regions, "mean"));
                ASSERT_FALSE(mean.has_error()) << mean.geterror();
                EXPECT_TRUE(std::isfinite(mean.getchannel(0, 0, 0, 0)));
            }
}

TEST(Segment, AcceptsAnyDestinationAndRegion)
{
    ImageBuf src = picture(50, 40);
    src.set_origin(-5, 10);
    const std::vector<Index> labels = labels_of(iba::segment(src, options_of(25)));
    for (const TypeDesc::BASETYPE type :
         { TypeDesc::UINT8, TypeDesc::UINT16, TypeDesc::INT32, TypeDesc::HALF, TypeDesc::FLOAT, TypeDesc::DOUBLE }) {
        ImageSpec spec(50, 40, 1, type);
        spec.x = -5;
        spec.y = 10;
        ImageBuf dst(spec);
        OIIO::ImageBufAlgo::zero(dst);
        ASSERT_TRUE(iba::segment(dst, src, options_of(25), ROI(0, 20, 15, 30))) << dst.geterror();
        const double scale = type == TypeDesc::UINT8 ? 255
            : type == TypeDesc::UINT16               ? 65535
            : type == TypeDesc::INT32                ? 2147483647.0
                                                     : 1;
        for (int y = 10; y < 50; ++y)
            for (int x = -5; x < 45; ++x) {
                const bool inside = x >= 0 && x < 20 && y >= 15 && y < 30;
                const double wanted = inside ? double(labels[std::size_t((y - 10) * 50 + x + 5)]) : 0;
                ASSERT_NEAR(double(dst.getchannel(x, y, 0, 0)) * scale, wanted, 0.1) << x << " " << y;
            }
    }
    ImageBuf small(ImageSpec(50, 40, 1, TypeDesc::UINT8));
    src.set_origin(0, 0);
    EXPECT_FALSE(iba::segment(small, src, options_of(300)));
    EXPECT_TRUE(small.has_error());
    small.geterror();
}

TEST(Segment, ThresholdAndErrors)
{
    ProgressiveImage progressive;
    ASSERT_TRUE(progressive.build(picture(50, 40)));
    SegmentOptions options;
    options.threshold = 1e30f;
    expect_regions(iba::segment(progressive, options), 1);
    options.regions = 3;
    EXPECT_NE(iba::segment(progressive, options).geterror().find("regions and threshold"), std::string::npos);
    EXPECT_NE(iba::segment(progressive, options_of(2001)).geterror().find("at most 2000"), std::string::npos);
    EXPECT_TRUE(iba::segment(progressive, options_of(0)).has_error());
    EXPECT_TRUE(iba::segment(progressive, options_of(5, "colours")).has_error());
    options = options_of(5);
    options.stats = "no/such/directory/regions.csv";
    EXPECT_NE(iba::segment(progressive, options).geterror().find("stats="), std::string::npos);
}

std::string contents(const std::string& filename)
{
    std::ostringstream text;
    text << std::ifstream(filename).rdbuf();
    return text.str();
}

TEST(Segment, ReportsEveryRegion)
{
    ImageBuf src(ImageSpec(6, 4, 1, TypeDesc::FLOAT));
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x) {
            const float p = x < 2 ? 0.25f : 1.0f;
            src.setpixel(x, y, &p);
        }
    SegmentOptions options = options_of(2);
    options.stats = "regions.csv";
    ASSERT_FALSE(iba::segment(src, options).has_error());
    EXPECT_EQ(contents("regions.csv"),
              "label,pixels,x,y,xmin,ymin,xmax,ymax,mean_Y,stddev_Y\n"
              "0,8,0.5,1.5,0,0,1,3,0.25,0\n"
              "1,16,3.5,1.5,2,0,5,3,1,0\n");
    options.stats = "regions.json";
    ASSERT_FALSE(iba::segment(src, options).has_error());
    EXPECT_EQ(contents("regions.json"),
              "[\n  { \"label\": 0, \"pixels\": 8, \"x\": 0.5, \"y\": 1.5, \"xmin\": 0, \"ymin\": 0, \"xmax\": 1, "
              "\"ymax\": 3, \"mean_Y\": 0.25, \"stddev_Y\": 0 },\n"
              "  { \"label\": 1, \"pixels\": 16, \"x\": 3.5, \"y\": 1.5, \"xmin\": 2, \"ymin\": 0, \"xmax\": 5, "
              "\"ymax\": 3, \"mean_Y\": 1, \"stddev_Y\": 0 }\n]\n");
}

}  // namespace
}  // namespace pimg
