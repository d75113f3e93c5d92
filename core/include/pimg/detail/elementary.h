// SPDX-License-Identifier: BSD-3-Clause
// Logarithms, powers, roots, sines and cosines with the same bits on every machine. Those of <cmath> differ from one C
// library to the next in the last place, and where a result decides something (which stroke is painted, which pixel
// joins which region), a last place may change the picture. These use only operations that IEEE 754 rounds correctly
// (+ - * / and the square root) in a fixed order, and the bits of the numbers; the compiler must not contract
// products and sums (-ffp-contract=off). They compute in double precision with errors far below half a unit in the last
// place of a float; tests/core/elementary_test.cpp measures them and pins their bits.
#pragma once

#include <cstdint>
#include <cstring>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {
namespace elementary {

constexpr double kLn2 = 0.693147180559945309417;
constexpr double kPi = 3.14159265358979323846;

inline std::uint64_t bits_of(double x)
{
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}

inline double from_bits(std::uint64_t bits)
{
    double x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

/// Logarithm to base 2 of a positive normal number; absolute error below 1e-13, exact for powers of two. By the series
/// of the inverse hyperbolic tangent, log2 m = 2 / ln 2 (s + s^3/3 + s^5/5 + ...) with s = (m - 1) / (m + 1), for the
/// mantissa m between the roots of 1/2 and 2. There s^2 is below 0.03, and the first term left out below 1e-15.
inline double log2(double x)
{
    constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcd;
    const std::int64_t offset = std::int64_t(bits_of(x) - kRootOfHalf);
    const std::int64_t exponent = offset >= 0 ? offset >> 52 : -((-offset + (std::int64_t(1) << 52) - 1) >> 52);
    const double mantissa = from_bits(bits_of(x) - (std::uint64_t(exponent) << 52));
    const double s = (mantissa - 1.0) / (mantissa + 1.0), square = s * s;
    double sum = 0.0;
    for (int k = 19; k >= 1; k -= 2)
        sum = sum * square + 1.0 / double(k);
    return double(exponent) + 2.0 / kLn2 * (sum * s);
}

/// 2^x for x from -1000 to 1000, to which it is clamped; relative error below 1e-13, exact for whole x. By the series
/// of e^r for r = ln 2 times the distance to the nearest whole number: |r| is below 0.35, and the first term left out
/// below 1e-15.
inline double exp2(double x)
{
    x = x < -1000.0 ? -1000.0 : x > 1000.0 ? 1000.0 : x;
    const std::int64_t whole = std::int64_t(x + (x < 0.0 ? -0.5 : 0.5));
    const double rest = (x - double(whole)) * kLn2;
    double sum = 1.0;
    for (int k = 13; k >= 1; --k)
        sum = 1.0 + sum * rest / double(k);
    return sum * from_bits(std::uint64_t(whole + 1023) << 52);
}

/// x^exponent for x >= 0 and exponent > 0; relative error below 1e-11 while the result is a normal float.
inline double power(double x, double exponent)
{
    return x > 0.0 ? exp2(exponent * log2(x)) : 0.0;
}

/// Cube root of a positive normal number; relative error below 1e-13. The bits divided by three give a first guess
/// with an error below 6 %, and Halley's method makes an error e one of about 2/3 e^3: two steps do, a third is spare.
inline double cube_root(double x)
{
    double root = from_bits(bits_of(x) / 3 + 0x2a9f7893782da1ce);
    for (int step = 0; step < 3; ++step) {
        const double cube = root * root * root;
        root = root * (cube + 2.0 * x) / (2.0 * cube + x);
    }
    return root;
}

struct SineCosine {
    double sine, cosine;
};

/// Sine and cosine of an angle of -pi/2 to pi/2; absolute error below 1e-13. By their Taylor series; the first terms
/// left out are below 1e-15.
inline SineCosine sine_cosine(double angle)
{
    const double square = angle * angle;
    double sine = 1.0, cosine = 1.0;
    for (int k = 20; k >= 2; k -= 2) {
        cosine = 1.0 - cosine * square / double(k * (k - 1));
        sine = 1.0 - sine * square / double(k * (k + 1));
    }
    return { sine * angle, cosine };
}

}  // namespace elementary
}  // namespace PIMG_ABI
}  // namespace pimg
