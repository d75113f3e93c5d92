// SPDX-License-Identifier: BSD-3-Clause
// The vector loops of the filters: right to rounding, and the same bits on every instruction set this machine has,
// wherever in a vector a pixel comes to lie.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include <OpenImageIO/color.h>

#include <pimg/colour.h>
#include <pimg/display.h>

#include "core/pictures.h"
#include "core/simd_targets.h"
#include "ops/display_curve.h"
#include "source/gains/detail_gain.h"
#include "source/guide.h"

namespace pimg {
namespace {

constexpr std::size_t kCount = 1003;

/// make(first, count) returns results for these; they must not depend on the target nor on where a range begins.
template<class Make>
void expect_same_bits(Make&& make)
{
    std::vector<float> expected;
    test::on_every_target([&](int tried, const char* target) {
        const std::vector<float> all = make(0, kCount);
        if (tried == 0)
            expected = all;
        EXPECT_EQ(std::memcmp(all.data(), expected.data(), all.size() * sizeof(float)), 0) << target;
        const std::size_t per = all.size() / kCount;
        const std::vector<float> part = make(5, 14);
        EXPECT_EQ(std::memcmp(part.data(), &expected[5 * per], part.size() * sizeof(float)), 0) << target;
    });
}

std::vector<float> numbers(float low, float high, std::uint32_t seed)
{
    std::vector<float> v(kCount);
    for (std::uint32_t i = 0; i < kCount; ++i)
        v[i] = low + (high - low) * test::noise(i, 0, seed);
    return v;
}

std::vector<float> part_of(const std::vector<float>& v, std::size_t first, std::size_t count)
{
    return std::vector<float>(v.begin() + std::ptrdiff_t(first), v.begin() + std::ptrdiff_t(first + count));
}

/// What in_place(values, count) makes of x, after checking that it makes the same everywhere.
template<class InPlace>
std::vector<float> checked(const std::vector<float>& x, InPlace&& in_place)
{
    const auto make = [&](std::size_t first, std::size_t count) {
        std::vector<float> y = part_of(x, first, count);
        in_place(y.data(), count);
        return y;
    };
    expect_same_bits(make);
    return make(0, kCount);
}

TEST(FilterVectors, PowersOfTwo)
{
    const std::vector<float> x = numbers(-130.0f, 130.0f, 1);
    const std::vector<float> y = checked(x, exp2_in_place);
    for (std::size_t i = 0; i < kCount; ++i) {
        const double expected = std::exp2(double(std::min(std::max(x[i], -126.0f), 127.0f)));
        EXPECT_NEAR(double(y[i]) / expected, 1.0, 2.5e-7) << x[i];
    }
}

TEST(FilterVectors, SrgbCurve)
{
    const std::vector<float> x = numbers(-0.5f, 2.0f, 10);
    const std::vector<float> y = checked(x, srgb_in_place);
    for (std::size_t i = 0; i < kCount; ++i)
        EXPECT_NEAR(y[i], OIIO::linear_to_sRGB(x[i]), 5e-7f);
}

TEST(FilterVectors, GainsOfContrasts)
{
    const std::vector<float> contrasts = numbers(0.0f, 30.0f, 2);
    for (const float beta : { 0.0f, 0.5f, 1.0f, 2.0f, 7.3f, 12.0f, 100.0f }) {
        const DetailGain gain { 0.2f, beta, 20.0f };
        const std::vector<float> y = checked(contrasts, [&](float* v, std::size_t n) { gain.apply(v, n); });
        for (std::size_t i = 0; i < kCount; ++i) {
            const double rest = 1.0 - std::min(double(contrasts[i]) / 20.0, 1.0);
            EXPECT_NEAR(double(y[i]), 0.2 + 0.8 * std::pow(rest, double(beta)), 1e-6 + 1e-7 * double(beta))
                << beta << " " << contrasts[i];
        }
    }
}

TEST(FilterVectors, CompressedDetails)
{
    const std::vector<float> contrasts = numbers(0.0f, 30.0f, 3), t = numbers(-25.0f, 25.0f, 4),
                             u = numbers(-25.0f, 25.0f, 5);
    std::vector<Detail> details(kCount);
    for (std::size_t i = 0; i < kCount; ++i)
        details[i] = { t[i], u[i] };
    const DetailGain gain { 0.2f, 2.0f, 20.0f };
    for (const float* by : { contrasts.data(), static_cast<const float*>(nullptr) }) {
        const auto make = [&](std::size_t first, std::size_t count) {
            std::vector<float> y(2 * count);
            std::vector<Detail> compressed(count);
            gain.apply(&details[first], { by ? by + first : nullptr, nullptr, nullptr }, count, compressed.data());
            std::memcpy(y.data(), compressed.data(), y.size() * sizeof(float));
            return y;
        };
        expect_same_bits(make);
        const std::vector<float> y = make(0, kCount);
        const auto expected = [](float detail, float contrast) {
            const float rest = 1.0f - std::min(contrast / 20.0f, 1.0f);
            return (0.2f + 0.8f * rest * rest) * detail;
        };
        for (std::size_t i = 0; i < kCount; ++i) {
            EXPECT_NEAR(y[2 * i], expected(t[i], by ? by[i] : std::fabs(t[i])), 1e-5f);
            EXPECT_NEAR(y[2 * i + 1], expected(u[i], by ? by[i] : std::fabs(u[i])), 1e-5f);
        }
    }
}

struct Recolouring : testing::Test {
    /// Colours of all kinds: black, negative, far out of gamut, huge.
    Recolouring() : rgb(3 * kCount), compressed(numbers(-60.0f, 60.0f, 6)), guide(numbers(-100.0f, 100.0f, 7))
    {
        for (std::size_t i = 0; i < kCount; ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                const float n = test::noise(std::uint32_t(i), std::uint32_t(c), 8);
                rgb[3 * i + c] = i % 7 == 0 ? 0.0f : i % 5 == 0 ? n - 0.3f : i % 11 == 0 ? 3e38f * n : 20.0f * n * n;
            }
    }

    std::vector<float> make(const Recolour& how, std::size_t first, std::size_t count) const
    {
        std::vector<float> y = part_of(rgb, 3 * first, 3 * count);
        recolour(how, &compressed[first], &guide[first], count, y.data());
        return y;
    }

    const Colour colour;
    std::vector<float> rgb, compressed, guide;
};

TEST_F(Recolouring, FitsTheDisplay)
{
    for (const float saturation : { 1.0f, 0.7f }) {
        const Recolour how {
            colour.weights(), 0.1f, -2.0f, saturation, true, ToneCurve(0.05f, 4.0f, 1.0f), 0.01f, 0.02f
        };
        expect_same_bits([&](std::size_t first, std::size_t count) { return make(how, first, count); });
        for (const float v : make(how, 0, kCount)) {
            EXPECT_GE(v, 0.0f);
            EXPECT_LE(v, 1.0f);
        }
    }
}

TEST_F(Recolouring, OnlyScalesIfNotFitted)
{
    const Recolour how { colour.weights(), 0.1f, -2.0f, 1.0f, false, ToneCurve(0.0f, 1.0f, 1.0f), 0.0f, 0.0f };
    expect_same_bits([&](std::size_t first, std::size_t count) { return make(how, first, count); });
    const std::vector<float> y = make(how, 0, kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
        const double factor = std::exp2(0.1 * double(compressed[i]) - double(guide[i]) / double(kUnitsPerStop) - 2.0);
        for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
            if (i % 11 != 0) {
                EXPECT_NEAR(double(y[k]), factor * double(rgb[k]), 3e-6 * factor * std::fabs(double(rgb[k])));
            }
    }
}

TEST_F(Recolouring, HasTheLuminanceOfTheCurve)
{
    const ToneCurve curve(0.05f, 4.0f, 1.0f);
    const Recolour how { colour.weights(), 0.1f, -2.0f, 1.0f, true, curve, 0.0f, 0.0f };
    const std::vector<float> y = make(how, 0, kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
        if (i % 5 == 0 || i % 7 == 0 || i % 11 == 0)
            continue;  // black, out of gamut, huge
        float stops = std::log2(colour.luminance(&rgb[3 * i])) + 0.1f * compressed[i] - guide[i] / kUnitsPerStop - 2.0f;
        lightness_in_place(curve, &stops, 1);
        EXPECT_NEAR(std::cbrt(colour.luminance(&y[3 * i])), stops, 2e-5f);
    }
}

TEST(FilterVectors, LightnessRisesToOne)
{
    const std::vector<float> stops = numbers(-20.0f, 5.0f, 9);
    const ToneCurve curve(0.0f, 4.0f, 1.0f);
    const std::vector<float> y = checked(stops, [&](float* v, std::size_t n) { lightness_in_place(curve, v, n); });
    for (std::size_t i = 0; i < kCount; ++i) {
        const float luminance = std::exp2(stops[i]);
        if (luminance <= ToneCurve::kKnee) {
            EXPECT_NEAR(y[i], std::cbrt(luminance), 1e-6f);
        } else {
            EXPECT_GT(y[i], std::cbrt(ToneCurve::kKnee) - 1e-6f);
        }
        if (luminance >= 4.0f) {
            EXPECT_NEAR(y[i], 1.0f, 1e-6f);
        }
    }
}

TEST(FilterVectors, ToeSubtractsHaze)
{
    std::vector<float> y = { std::log2(0.2f), std::log2(0.02f), -30.0f };
    lightness_in_place(ToneCurve(0.05f, 4.0f, 1.0f), y.data(), y.size());
    EXPECT_NEAR(y[0] * y[0] * y[0], 0.2f * 0.2f / 0.25f, 1e-5f);
    EXPECT_NEAR(y[1] * y[1] * y[1], 0.02f * 0.02f / 0.07f, 1e-5f);
    EXPECT_NEAR(y[2], 0.0f, 1e-5f);
}

/// Details that are noise have the gain `quiet`, and clear ones the gain `detail`.
TEST(FilterVectors, NoiseIsNotAmplified)
{
    const DetailGain gain { 0.2f, 2.0f, 20.0f, 4.0f, 0.5f };
    const std::vector<Detail> details(3, { 1.0f, -2.0f });
    const float contrasts[] = { 0.0f, 0.0f, 20.0f }, visibilities[] = { 0.0f, 1.0f, 1.0f };
    std::vector<Detail> compressed(3);
    gain.apply(details.data(), { contrasts, visibilities, nullptr }, 3, compressed.data());
    EXPECT_NEAR(compressed[0].t, 0.5f, 1e-6f);
    EXPECT_NEAR(compressed[1].u, -8.0f, 1e-6f);
    EXPECT_NEAR(compressed[2].t, 0.2f, 1e-6f);
}

}  // namespace
}  // namespace pimg
