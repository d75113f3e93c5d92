// SPDX-License-Identifier: BSD-3-Clause
#include "colour/primaries.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pimg {

namespace {

using Vector3 = std::array<double, 3>;

Vector3 times(const Matrix3& m, const Vector3& v)
{
    Vector3 result;
    for (std::size_t i = 0; i < 3; ++i)
        result[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
    return result;
}

Matrix3 diagonal(const Vector3& v)
{
    return { v[0], 0, 0, 0, v[1], 0, 0, 0, v[2] };
}

/// XYZ of white at Y = 1.
Vector3 white_of(const Chromaticities& c)
{
    return { c[6] / c[7], 1.0, (1.0 - c[6] - c[7]) / c[7] };
}

/// From RGB to CIE XYZ of the primaries' own white (SMPTE RP 177).
bool matrix_to_xyz(const Chromaticities& c, Matrix3& matrix)
{
    const Matrix3 columns { c[0], c[2], c[4], c[1], c[3], c[5], 1 - c[0] - c[1], 1 - c[2] - c[3], 1 - c[4] - c[5] };
    Matrix3 inverse;
    if (!(std::fabs(c[7]) > 1e-6) || !invert(columns, inverse))
        return false;
    matrix = product(columns, diagonal(times(inverse, white_of(c))));
    return std::all_of(matrix.begin(), matrix.end(), [](double x) { return std::isfinite(x); });
}

/// Cone responses that whites are adapted in (Bradford, as in the ICC specification, annex E).
constexpr Matrix3 kCones { 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296 };

bool adaptation(const Vector3& from, const Vector3& to, Matrix3& matrix)
{
    const Vector3 source = times(kCones, from), target = times(kCones, to);
    Vector3 scale;
    for (std::size_t i = 0; i < 3; ++i)
        scale[i] = target[i] / source[i];
    Matrix3 inverse;
    if (!invert(kCones, inverse))
        return false;
    matrix = product(inverse, product(diagonal(scale), kCones));
    return std::all_of(scale.begin(), scale.end(), [](double s) { return std::isfinite(s) && s > 0.0; });
}

}  // namespace

Matrix3 product(const Matrix3& a, const Matrix3& b)
{
    Matrix3 result {};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k)
                result[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return result;
}

bool invert(const Matrix3& m, Matrix3& inverse)
{
    const auto minor = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
        return m[a] * m[d] - m[b] * m[c];
    };
    const double determinant = m[0] * minor(4, 5, 7, 8) - m[1] * minor(3, 5, 6, 8) + m[2] * minor(3, 4, 6, 7);
    if (!(std::fabs(determinant) > 1e-9))
        return false;
    inverse = { minor(4, 5, 7, 8), minor(2, 1, 8, 7), minor(1, 2, 4, 5), minor(5, 3, 8, 6), minor(0, 2, 6, 8),
                minor(2, 0, 5, 3), minor(3, 4, 6, 7), minor(1, 0, 7, 6), minor(0, 1, 3, 4) };
    for (double& x : inverse)
        x /= determinant;
    return true;
}

bool is_near(const Matrix3& a, const Matrix3& b, double tolerance)
{
    for (std::size_t i = 0; i < 9; ++i)
        if (!(std::fabs(a[i] - b[i]) <= tolerance))
            return false;
    return true;
}

bool matrix_to_rec709(const Chromaticities& primaries, Matrix3& matrix)
{
    Matrix3 to_xyz, rec709, from_xyz, adapt;
    if (!matrix_to_xyz(primaries, to_xyz) || !matrix_to_xyz(kRec709, rec709) || !invert(rec709, from_xyz)
        || !adaptation(white_of(primaries), white_of(kRec709), adapt))
        return false;
    matrix = product(from_xyz, product(adapt, to_xyz));
    Matrix3 inverse;
    return invert(matrix, inverse);
}

const Chromaticities* known_primaries(const Matrix3& to_rec709, double tolerance)
{
    static constexpr const Chromaticities* kKnown[] = { &kRec709, &kAp1,      &kRec2020, &kP3,
                                                        &kAdobe,  &kProPhoto, &kAp0,     &kXyzD65 };
    for (const Chromaticities* primaries : kKnown) {
        Matrix3 matrix;
        if (matrix_to_rec709(*primaries, matrix) && is_near(matrix, to_rec709, tolerance))
            return primaries;
    }
    return nullptr;
}

}  // namespace pimg
