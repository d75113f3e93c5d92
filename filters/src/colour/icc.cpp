// SPDX-License-Identifier: BSD-3-Clause
#include "colour/icc.h"

#include <cmath>
#include <memory>

#include <lcms2.h>

#include <pimg/display.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Curves (half of an 8-bit code) and primaries that differ by less than this count as the same: the numbers of a
/// profile are rounded to 16 bits, and there are many editions of sRGB.
constexpr double kSameCurve = 2e-3, kSameSpace = 5e-3;

using Profile = std::unique_ptr<void, decltype(&cmsCloseProfile)>;

template<class T>
const T* tag(const Profile& profile, cmsTagSignature signature)
{
    return static_cast<const T*>(cmsReadTag(profile.get(), signature));
}

/// CIE xy of a profile's red, green and blue, and of their sum, which is white.
bool read_primaries(const Profile& profile, Chromaticities& primaries)
{
    cmsCIEXYZ white { 0, 0, 0 };
    const auto set = [&](std::size_t i, const cmsCIEXYZ& c) {
        const double sum = c.X + c.Y + c.Z;
        primaries[2 * i] = c.X / sum;
        primaries[2 * i + 1] = c.Y / sum;
        return std::isfinite(primaries[2 * i]) && std::isfinite(primaries[2 * i + 1]);
    };
    const cmsTagSignature tags[] = { cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag };
    for (std::size_t i = 0; i < 3; ++i) {
        const auto* colorant = tag<cmsCIEXYZ>(profile, tags[i]);
        if (colorant == nullptr || !set(i, *colorant))
            return false;
        white = { white.X + colorant->X, white.Y + colorant->Y, white.Z + colorant->Z };
    }
    return set(3, white);
}

bool read_curve(const Profile& profile, cmsTagSignature signature, std::vector<float>& curve)
{
    const auto* tone = tag<cmsToneCurve>(profile, signature);
    if (tone == nullptr)
        return false;
    for (std::size_t i = 0; i < IccSpace::kSamples; ++i) {
        const float x = float(double(i) / double(IccSpace::kSamples - 1));
        curve.push_back(cmsEvalToneCurveFloat(tone, x));
        if (!std::isfinite(curve.back()))
            return false;
    }
    return true;
}

/// Whether all three curves are `expected`.
template<class Expected>
bool are(const IccSpace& space, Expected&& expected)
{
    for (const std::vector<float>& curve : space.curves)
        for (std::size_t i = 0; i < IccSpace::kSamples; ++i)
            if (std::fabs(double(curve[i]) - expected(double(i) / double(IccSpace::kSamples - 1))) > kSameCurve)
                return false;
    return true;
}

}  // namespace

bool read_icc(const void* bytes, std::size_t size, IccSpace& space)
{
    const Profile profile(cmsOpenProfileFromMem(bytes, cmsUInt32Number(size)), cmsCloseProfile);
    if (profile == nullptr)
        return false;
    space = IccSpace();
    bool found = false;
    if (cmsGetColorSpace(profile.get()) == cmsSigGrayData) {
        space.primaries = kRec709;
        found = read_curve(profile, cmsSigGrayTRCTag, space.curves[0]);
        space.curves[1] = space.curves[2] = space.curves[0];
    } else if (cmsGetColorSpace(profile.get()) == cmsSigRgbData && cmsIsMatrixShaper(profile.get())) {
        found = read_primaries(profile, space.primaries) && read_curve(profile, cmsSigRedTRCTag, space.curves[0])
            && read_curve(profile, cmsSigGreenTRCTag, space.curves[1])
            && read_curve(profile, cmsSigBlueTRCTag, space.curves[2]);
    }
    Imath::M33d matrix;
    if (!found || !matrix_to_rec709(space.primaries, matrix))
        return false;
    space.linear = are(space, [](double x) { return x; });
    space.srgb = matrix.equalWithAbsError(Imath::M33d(), kSameSpace) && are(space, srgb_decoded);
    char name[64] = "";
    cmsGetProfileInfoASCII(profile.get(), cmsInfoDescription, "en", "US", name, sizeof name);
    space.name = name;
    return true;
}

std::string display_p3_profile()
{
    const cmsCIExyY white { kP3[6], kP3[7], 1.0 };
    const cmsCIExyYTRIPLE primaries { { kP3[0], kP3[1], 1.0 }, { kP3[2], kP3[3], 1.0 }, { kP3[4], kP3[5], 1.0 } };
    const double srgb[] = { 2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045 };  // IEC 61966-2-1
    constexpr int kPowerAndLine = 4;                                                  // of cmsBuildParametricToneCurve
    cmsToneCurve* const curve = cmsBuildParametricToneCurve(nullptr, kPowerAndLine, srgb);
    cmsToneCurve* const curves[] = { curve, curve, curve };
    const Profile profile(cmsCreateRGBProfile(&white, &primaries, curves), cmsCloseProfile);
    cmsFreeToneCurve(curve);
    cmsMLU* const name = cmsMLUalloc(nullptr, 1);
    cmsMLUsetASCII(name, "en", "US", "Display P3");
    cmsWriteTag(profile.get(), cmsSigProfileDescriptionTag, name);
    cmsMLUfree(name);
    cmsUInt32Number size = 0;
    cmsSaveProfileToMem(profile.get(), nullptr, &size);
    std::string bytes(size, '\0');
    cmsSaveProfileToMem(profile.get(), bytes.data(), &size);
    // The header says when the profile was made. Files must not depend on the clock: the year of the standard is as good.
    constexpr std::size_t kDateAt = 24;
    bytes.replace(kDateAt, 12, std::string { 7, char(0xDA), 0, 1, 0, 1, 0, 0, 0, 0, 0, 0 });
    return bytes;
}

}  // namespace PIMG_ABI
}  // namespace pimg
