// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/elementary.h>

#include <cmath>

#include <gtest/gtest.h>

namespace pimg {
namespace {

using namespace elementary;

/// FNV-1a of the bits of all numbers given so far.
class Bits {
public:
    void add(double x)
    {
        const std::uint64_t bits = bits_of(x);
        for (int shift = 0; shift < 64; shift += 8)
            m_hash = (m_hash ^ ((bits >> shift) & 0xff)) * 0x100000001b3u;
    }
    std::uint64_t hash() const { return m_hash; }

private:
    std::uint64_t m_hash = 0xcbf29ce484222325u;
};

/// Positive numbers of every magnitude a float has, about 400 to an octave, not evenly spaced.
template<class Body>
void for_magnitudes(Body&& body)
{
    for (int exponent = -126; exponent < 128; ++exponent)
        for (int i = 0; i < 397; ++i)
            body(std::ldexp(1.0 + (double(i) + double(i % 7) / 8.0) / 397.5, exponent));
}

TEST(Elementary, Logarithm)
{
    double worst = 0.0;
    for_magnitudes([&](double x) { worst = std::fmax(worst, std::fabs(elementary::log2(x) - std::log2(x))); });
    EXPECT_LT(worst, 1e-13);
    for (int exponent = -1000; exponent <= 1000; ++exponent)
        EXPECT_EQ(elementary::log2(std::ldexp(1.0, exponent)), exponent);
}

TEST(Elementary, PowerOfTwo)
{
    double worst = 0.0;
    for (int i = -400000; i <= 400000; ++i) {
        const double x = double(i) / 2719.0;
        worst = std::fmax(worst, std::fabs(elementary::exp2(x) / std::exp2(x) - 1.0));
    }
    EXPECT_LT(worst, 1e-13);
    for (int exponent = -1000; exponent <= 1000; ++exponent)
        EXPECT_EQ(elementary::exp2(exponent), std::ldexp(1.0, exponent));
    EXPECT_EQ(elementary::exp2(1e30), std::ldexp(1.0, 1000));
    EXPECT_EQ(elementary::exp2(-1e30), std::ldexp(1.0, -1000));
}

TEST(Elementary, PowerAndRoot)
{
    double worst_power = 0.0, worst_root = 0.0;
    for_magnitudes([&](double x) {
        for (const double exponent : { 1.0 / 2.4, 0.5, 1.6 })
            worst_power = std::fmax(worst_power, std::fabs(power(x, exponent) / std::pow(x, exponent) - 1.0));
        worst_root = std::fmax(worst_root, std::fabs(cube_root(x) / std::cbrt(x) - 1.0));
    });
    EXPECT_LT(worst_power, 1e-11);
    EXPECT_LT(worst_root, 1e-13);
    EXPECT_EQ(power(0.0, 1.6), 0.0);
    EXPECT_EQ(power(1.0, 1.6), 1.0);
}

TEST(Elementary, SineAndCosine)
{
    double worst = 0.0;
    for (int i = -100000; i <= 100000; ++i) {
        const double angle = double(i) * (kPi / 200000.0);
        const auto [sine, cosine] = sine_cosine(angle);
        worst = std::fmax(worst, std::fabs(sine - std::sin(angle)));
        worst = std::fmax(worst, std::fabs(cosine - std::cos(angle)));
        EXPECT_EQ(sine_cosine(-angle).sine, -sine);
        EXPECT_EQ(sine_cosine(-angle).cosine, cosine);
    }
    EXPECT_LT(worst, 1e-13);
    EXPECT_EQ(sine_cosine(0.0).sine, 0.0);
    EXPECT_EQ(sine_cosine(0.0).cosine, 1.0);
}

/// A stored result, for once: the very bits are what these functions are for. Compilers, options and processors that
/// give others would also give other pictures.
TEST(Elementary, BitsAreTheSameEverywhere)
{
    Bits logarithms, powers, roots, sines;
    for_magnitudes([&](double x) {
        logarithms.add(elementary::log2(x));
        powers.add(power(x, 1.6));
        roots.add(cube_root(x));
    });
    for (int i = -4000; i <= 4000; ++i) {
        powers.add(elementary::exp2(double(i) / 31.0));
        sines.add(sine_cosine(double(i) / 2600.0).sine);
        sines.add(sine_cosine(double(i) / 2600.0).cosine);
    }
    EXPECT_EQ(logarithms.hash(), 13922819724499827985u);
    EXPECT_EQ(powers.hash(), 4364702515465695878u);
    EXPECT_EQ(roots.hash(), 11554351604965227555u);
    EXPECT_EQ(sines.hash(), 6773587801611947788u);
}

}  // namespace
}  // namespace pimg
