// SPDX-License-Identifier: BSD-3-Clause
#include "colour/primaries.h"

#include <algorithm>
#include <cmath>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// XYZ of white at Y = 1.
Imath::V3d white_of(const Chromaticities& c)
{
    return { c[6] / c[7], 1.0, (1.0 - c[6] - c[7]) / c[7] };
}

Imath::M33d diagonal(const Imath::V3d& v)
{
    return { v.x, 0, 0, 0, v.y, 0, 0, 0, v.z };
}

bool all_finite(const Imath::M33d& matrix)
{
    return std::all_of(matrix[0], matrix[0] + 9, [](double x) { return std::isfinite(x); });
}

/// From RGB to CIE XYZ of the primaries' own white (SMPTE RP 177).
bool matrix_to_xyz(const Chromaticities& c, Imath::M33d& matrix)
{
    const Imath::M33d primaries {
        c[0], c[1], 1 - c[0] - c[1], c[2], c[3], 1 - c[2] - c[3], c[4], c[5], 1 - c[4] - c[5]
    };
    Imath::M33d inverse;
    if (!(std::fabs(c[7]) > 1e-6) || !invert(primaries, inverse))
        return false;
    matrix = diagonal(white_of(c) * inverse) * primaries;
    return all_finite(matrix);
}

/// From XYZ with one white to XYZ with another: scales cone responses (Bradford, as in the ICC specification, annex E).
bool adaptation(const Imath::V3d& from, const Imath::V3d& to, Imath::M33d& matrix)
{
    const Imath::M33d cones { 0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296 };
    const Imath::V3d scale = (to * cones) / (from * cones);
    matrix = cones * diagonal(scale) * cones.inverse();
    return all_finite(matrix) && scale.x > 0.0 && scale.y > 0.0 && scale.z > 0.0;
}

}  // namespace

bool invert(const Imath::M33d& matrix, Imath::M33d& inverse)
{
    if (!(std::fabs(matrix.determinant()) > 1e-9))
        return false;
    inverse = matrix.inverse();
    return true;
}

bool matrix_to_rec709(const Chromaticities& primaries, Imath::M33d& matrix)
{
    Imath::M33d to_xyz, rec709, from_xyz, adapted;
    if (!matrix_to_xyz(primaries, to_xyz) || !matrix_to_xyz(kRec709, rec709) || !invert(rec709, from_xyz)
        || !adaptation(white_of(primaries), white_of(kRec709), adapted))
        return false;
    matrix = to_xyz * adapted * from_xyz;
    Imath::M33d inverse;
    return invert(matrix, inverse);
}

const Chromaticities* known_primaries(const Imath::M33d& to_rec709, double tolerance)
{
    static constexpr const Chromaticities* kKnown[] = { &kRec709, &kAp1,      &kRec2020, &kP3,
                                                        &kAdobe,  &kProPhoto, &kAp0,     &kXyzD65 };
    for (const Chromaticities* primaries : kKnown) {
        Imath::M33d matrix;
        if (matrix_to_rec709(*primaries, matrix) && matrix.equalWithAbsError(to_rec709, tolerance))
            return primaries;
    }
    return nullptr;
}

}  // namespace PIMG_ABI
}  // namespace pimg
