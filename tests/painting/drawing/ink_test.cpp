// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/ink.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "drawing/raster_ops.h"
#include "painting/scene.h"

using namespace pimg;
using test::PaintedScene;

namespace {

/// A grey picture with L* = sample / 2.55.
struct Subject {
    int width, height;
    std::vector<float> steps, lightness;

    template<class F>
    Subject(int w, int h, F&& f) : width(w),
                                   height(h)
    {
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                steps.push_back(float(f(x, y)));
                lightness.push_back(steps.back() / 2.55f);
            }
    }

    InkPicture picture() const
    {
        InkPicture picture;
        picture.width = width;
        picture.height = height;
        picture.lightness = lightness.data();
        picture.features = { width, height, { steps.data() } };
        return picture;
    }
    Drawing drawn(const PenOptions& pen) const
    {
        Drawing drawing;
        draw_ink(picture(), pen, drawing);
        return drawing;
    }
};

Subject scene(int width, int height)
{
    return { width, height, [&](int x, int y) {
                return 20.0f + test::scene(x, y, width, height);
            } };
}

/// L* of a drawing of black ink, seen through a Gaussian filter of `sigma` pixels.
Raster seen(const Drawing& drawing, float sigma)
{
    Raster paper = make_raster(drawing.width, drawing.height, 100.0f);
    Canvas canvas { drawing.width, drawing.height, { paper.samples.data() }, nullptr };
    render_drawing(drawing, { { 0.0f } }, canvas);
    return blurred(paper, sigma, {});
}

float rms(const Raster& a, const Raster& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.samples.size(); ++i)
        sum += double(a.samples[i] - b.samples[i]) * double(a.samples[i] - b.samples[i]);
    return float(std::sqrt(sum / double(a.samples.size())));
}

TEST(Ink, HasTheTonesOfThePicture)
{
    for (const InkStyle style : { InkStyle::hatch, InkStyle::contour, InkStyle::stipple }) {
        const Subject subject(400, 300, [](int x, int y) {
            return (x - 250) * (x - 250) + (y - 150) * (y - 150) < 6400 ? 230.0f - 0.4f * float(y)
                                                                        : 20.0f + 0.6f * float(x);
        });
        PenOptions pen;
        pen.style = style;
        pen.width = 1.0f;
        const Raster wanted = blurred({ 400, 300, subject.lightness }, 4.0f, {});
        EXPECT_LT(rms(seen(subject.drawn(pen), 4.0f), wanted), 5.0f) << int(style);
    }
}

TEST(Ink, IsAboutTheSameAtTwiceTheResolution)
{
    const Subject small = scene(300, 200), large = scene(600, 400);
    PenOptions pen;
    pen.width = 1.0f;
    const Drawing a = small.drawn(pen);
    pen.width = 2.0f;
    const Drawing b = resized(large.drawn(pen), 300, 200);
    EXPECT_NEAR(double(a.lines.size()), double(b.lines.size()), 0.1 * double(a.lines.size()));
    EXPECT_LT(rms(seen(a, 3.0f), seen(b, 3.0f)), 3.0f);
}

TEST(Ink, LeavesWhiteWhiteAndCopesWithAnything)
{
    for (const float v : { 255.0f, 1e9f })
        EXPECT_TRUE(Subject(80, 60, [&](int, int) { return v; }).drawn({}).lines.empty());
    for (const auto& [w, h] : { std::pair { 1, 1 }, { 2, 90 }, { 90, 2 }, { 5, 3 } })
        for (const InkStyle style : { InkStyle::hatch, InkStyle::stipple }) {
            PenOptions pen;
            pen.style = style;
            for (const InkPoint& p : Subject(w, h, [](int, int) { return -10.0f; }).drawn(pen).points) {
                EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && p.width > 0.0f);
                EXPECT_TRUE(p.x >= -0.5f && p.y >= -0.5f && p.x <= float(w) - 0.5f && p.y <= float(h) - 0.5f);
            }
        }
}

TEST(Ink, OptionsDoWhatTheySay)
{
    const Subject subject = scene(240, 160);
    const auto drawn = [&](auto&& change) {
        PenOptions pen;
        pen.width = 1.0f;
        change(pen);
        return subject.drawn(pen);
    };
    const auto tone = [&](const Drawing& d) {
        const Raster all = seen(d, 2.0f);
        return std::accumulate(all.samples.begin(), all.samples.end(), 0.0f) / float(all.samples.size());
    };
    const Drawing plain = drawn([](PenOptions&) {});
    EXPECT_LT(tone(drawn([](PenOptions& p) { p.density = 1.4f; })), tone(plain) - 4.0f);
    EXPECT_GT(tone(drawn([](PenOptions& p) { p.density = 0.0f; })), 90.0f);
    EXPECT_TRUE(drawn([](PenOptions& p) { p.density = p.outline = 0.0f; }).lines.empty());
    EXPECT_LT(drawn([](PenOptions& p) { p.outline = 0.0f; }).lines.size(), plain.lines.size());
    EXPECT_LT(drawn([](PenOptions& p) { p.cross = false; }).lines.size(), plain.lines.size());
    EXPECT_LT(drawn([](PenOptions& p) { p.spacing = 4.0f; }).lines.size(), plain.lines.size() * 3 / 4);
    EXPECT_GT(drawn([](PenOptions& p) { p.length = 0.3f; }).lines.size(), plain.lines.size());
    EXPECT_NE(drawn([](PenOptions& p) { p.seed = 2; }).lines.size(), plain.lines.size());
}

TEST(Ink, LightMakesDarkPicturesLightAndLeavesLightOnesAlone)
{
    const auto mean = [](const Subject& subject, float light) {
        PenOptions pen;
        pen.width = 1.0f;
        pen.light = light;
        const Raster all = seen(subject.drawn(pen), 2.0f);
        return std::accumulate(all.samples.begin(), all.samples.end(), 0.0f) / float(all.samples.size());
    };
    const Subject night(240, 160,
                        [](int x, int y) { return 20 + x / 6 + (std::hypot(x - 120, y - 80) < 12 ? 150 : 0); });
    const Subject day(240, 160, [](int x, int) { return 130 + x / 2; });
    const float dark = mean(night, 0.0f), half = mean(night, 0.5f), light = mean(night, 1.0f);
    EXPECT_LT(dark, 25.0f);
    EXPECT_GT(half, dark + 10.0f);
    EXPECT_GT(light, half + 10.0f);
    EXPECT_NEAR(mean(day, 1.0f), mean(day, 0.0f), 8.0f);
}

TEST(Ink, DarkTonesOfAColourAreCrossedInBlack)
{
    const Subject subject(200, 100, [](int x, int) { return x < 100 ? 190.0f : 40.0f; });
    InkPicture picture = subject.picture();
    picture.inks.push_back({ { 0.8f, 0.2f, 0.1f }, 45.0f });
    const std::vector<std::uint8_t> red(20000, 1);
    picture.ink = red.data();
    Drawing drawing;
    PenOptions pen;
    pen.outline = 0.0f;
    draw_ink(picture, pen, drawing);
    ASSERT_EQ(drawing.inks.size(), 2u);
    bool black_left = false, black_right = false;
    for (const InkLine& line : drawing.lines)
        if (line.ink == 0)
            (drawing.begin(line)->x < 90.0f ? black_left : black_right) = true;
    EXPECT_FALSE(black_left);
    EXPECT_TRUE(black_right);
}

TEST(Ink, DoesNotDependOnTheLoop)
{
    const Subject subject = scene(200, 140);
    for (const InkStyle style : { InkStyle::hatch, InkStyle::stipple }) {
        PenOptions pen;
        pen.style = style;
        const Drawing a = subject.drawn(pen);
        pen.parallel = test::backwards;
        const Drawing b = subject.drawn(pen);
        ASSERT_EQ(a.points.size(), b.points.size());
        for (std::size_t i = 0; i < a.points.size(); ++i)
            ASSERT_TRUE(a.points[i].x == b.points[i].x && a.points[i].y == b.points[i].y
                        && a.points[i].width == b.points[i].width);
    }
}

// The function that draw_ink() replaces still makes strokes.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
TEST(Ink, PlansStrokesFromDarknessAlone)
{
    const PaintedScene scene(test::scene(120, 90));
    std::vector<float> darkness = scene.samples;
    for (float& v : darkness)
        v = 1.0f - v / 255.0f;
    darkness[7] = std::numeric_limits<float>::quiet_NaN();
    PenOptions pen;
    pen.width = 2.25f;
    Strokes planned;
    EXPECT_TRUE(plan_ink(scene.hierarchy, darkness.data(), DirectionField(scene.guides), pen, planned).ok());
    EXPECT_GT(planned.strokes.size(), 20u);
    for (const Stroke& s : planned.strokes) {
        EXPECT_EQ(s.width, 2.25f);
        EXPECT_GE(s.count, 2u);
    }
}
#pragma GCC diagnostic pop

}  // namespace
