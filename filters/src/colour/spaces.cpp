// SPDX-License-Identifier: BSD-3-Clause
#include "colour/spaces.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

bool drop_ending(std::string& text, const std::string& ending)
{
    if (text.size() <= ending.size() || text.compare(text.size() - ending.size(), ending.size(), ending) != 0)
        return false;
    text.erase(text.size() - ending.size());
    return true;
}

struct PrimariesWord {
    const char* word;
    const Chromaticities& primaries;
    bool is_agreed;  ///< by the Color Interop Forum: may be part of a name that is written
};

constexpr PrimariesWord kWords[] = {
    { "rec709", kRec709, true },    { "rec2020", kRec2020, true },
    { "p3d65", kP3, true },         { "ap0", kAp0, true },
    { "ap1", kAp1, true },          { "adobergb", kAdobe, true },
    { "ciexyzd65", kXyzD65, true }, { "srgb", kRec709, false },
    { "xyz", kXyzD65, false },      { "prophoto", kProPhoto, false },
    { "romm", kProPhoto, false },
};

bool find_primaries(const std::string& word, Chromaticities& primaries)
{
    for (const PrimariesWord& known : kWords)
        if (word == known.word) {
            primaries = known.primaries;
            return true;
        }
    return false;
}

bool is_gamma(double gamma)
{
    return gamma >= 0.1 && gamma <= 10.0;
}

/// CURVE_PRIMARIES, with or without "_scene" or "_display": lin_ap1_scene, g22_rec709, srgb_p3d65_display.
bool find_interop_space(std::string name, NamedSpace& space)
{
    if (!drop_ending(name, "_scene") && !drop_ending(name, "_display"))
        drop_ending(name, "_texture");
    const std::size_t bar = name.find('_');
    if (bar == std::string::npos || !find_primaries(name.substr(bar + 1), space.primaries))
        return false;
    const std::string curve = name.substr(0, bar);
    if (curve == "lin")
        return true;
    if (curve == "srgb") {
        space.gamma = kSrgbGamma;
        space.offset = kSrgbOffset;
        return true;
    }
    space.gamma = curve[0] == 'g' && curve.size() == 3 ? std::strtod(curve.c_str() + 1, nullptr) / 10.0 : 0.0;
    return is_gamma(space.gamma);
}

/// gamma2.2, GammaCorrected2.2
bool find_gamma_space(const std::string& name, NamedSpace& space)
{
    if (name.rfind("gamma", 0) != 0)
        return false;
    const std::size_t digits = name.find_first_of("0123456789");
    space.gamma = digits == std::string::npos ? 0.0 : std::strtod(name.c_str() + digits, nullptr);
    return is_gamma(space.gamma);
}

}  // namespace

bool names_srgb(const std::string& name)
{
    for (const char* srgb : { "srgb", "srgb_texture", "srgb_tx", "srgb - texture", "utility - srgb - texture",
                              "srgb encoded rec.709 (srgb)", "srgb_rec709_scene", "srgb_rec709_display" })
        if (name == srgb)
            return true;
    return false;
}

bool find_named_space(const std::string& name, NamedSpace& space)
{
    static const std::pair<const char*, NamedSpace> known[] = {
        { "rec709", { kRec709Gamma, kRec709Offset, kRec709 } },
        { "rec.709", { kRec709Gamma, kRec709Offset, kRec709 } },
        { "adobergb", { 563.0 / 256.0, 0.0, kAdobe } },  // Adobe RGB (1998), 4.3.4.2
        { "acescg", { 1.0, 0.0, kAp1 } },
        { "aces - acescg", { 1.0, 0.0, kAp1 } },
        { "linear acescg", { 1.0, 0.0, kAp1 } },
        { "aces", { 1.0, 0.0, kAp0 } },
        { "aces2065-1", { 1.0, 0.0, kAp0 } },
        { "aces - aces2065-1", { 1.0, 0.0, kAp0 } },
        { "linear aces", { 1.0, 0.0, kAp0 } },
        { "linear rec.709", { 1.0, 0.0, kRec709 } },
        { "linear rec.709 (srgb)", { 1.0, 0.0, kRec709 } },
        { "utility - linear - rec.709", { 1.0, 0.0, kRec709 } },
        { "utility - linear - srgb", { 1.0, 0.0, kRec709 } },
        { "linear rec.2020", { 1.0, 0.0, kRec2020 } },
        { "utility - linear - rec.2020", { 1.0, 0.0, kRec2020 } },
        { "linear p3-d65", { 1.0, 0.0, kP3 } },
        { "utility - linear - p3-d65", { 1.0, 0.0, kP3 } },
        { "linear adobergb", { 1.0, 0.0, kAdobe } },
        { "cie xyz-d65 - scene-referred", { 1.0, 0.0, kXyzD65 } },
        { "cie-xyz-d65", { 1.0, 0.0, kXyzD65 } },
        { "raw", {} },
        { "data", {} },
    };
    space = {};
    if (names_srgb(name)) {
        space = { kSrgbGamma, kSrgbOffset, kRec709 };
        return true;
    }
    for (const auto& [known_name, values] : known)
        if (name == known_name) {
            space = values;
            return true;
        }
    return find_gamma_space(name, space) || find_interop_space(name, space);
}

std::string with_primaries(std::string name, const Chromaticities& primaries)
{
    const std::string own = "rec709";
    const std::size_t at = name.find(own);
    if (at == std::string::npos)
        return name;
    const auto are_same = [](double a, double b) {
        return std::fabs(a - b) < 1e-4;
    };
    for (const PrimariesWord& known : kWords)
        if (known.is_agreed && std::equal(primaries.begin(), primaries.end(), known.primaries.begin(), are_same))
            return name.replace(at, own.size(), known.word);
    return {};
}

}  // namespace PIMG_ABI
}  // namespace pimg
