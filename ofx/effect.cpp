// SPDX-License-Identifier: BSD-3-Clause
#include "effect.h"

#include <algorithm>
#include <iterator>

#include <OpenImageIO/strutil.h>

#include "analysis.h"
#include "shot.h"

namespace pimg_ofx {

namespace {

Parameter parameter(const pimg::OptionInfo& option, Owner owner)
{
    const char* prefix = owner == Owner::build ? "build_" : owner == Owner::shot ? "shot_" : "";
    Parameter result { option, owner, prefix + option.key, {} };
    if (option.type == "string" && !option.choices.empty()) {
        result.words = OIIO::Strutil::splits(option.choices, "|");
        if (option.default_value.empty())
            result.words.insert(result.words.begin(), kAutomatic);
    }
    return result;
}

/// Options that write files are not offered: a host renders in any order, on many threads, and as often as it likes.
/// Nor has an image of OpenFX other layers than its picture.
bool is_offered(const pimg::OptionInfo& option)
{
    return option.file != pimg::FileUse::written && option.key != std::string("aovs");
}

Effect effect_of(const pimg::Filter& filter)
{
    Effect effect { &filter, std::string("org.pimg.") + filter.name, pimg::title_of(filter), {}, {} };
    for (const pimg::OptionInfo& option : filter.options())
        if (is_offered(option))
            effect.parameters.push_back(parameter(option, Owner::filter));
    // The colour space has parameters of its own.
    for (const pimg::OptionInfo& option : pimg::describe_options<pimg::BuildOptions>())
        if (option.key != "incolorspace")
            effect.parameters.push_back(parameter(option, Owner::build));
    if (filter.name == std::string("hdr_compress")) {
        effect.found = found_keys();
        for (const pimg::OptionInfo& option : pimg::describe_options<pimg::ShotOptions>())
            if (option.key == "mode" || option.key == "radius" || option.key == "cuts")
                effect.parameters.push_back(parameter(option, Owner::shot));
    }
    return effect;
}

}  // namespace

double Parameter::preset() const
{
    return option.default_value.empty() ? kUnset : OIIO::Strutil::stod(option.default_value);
}

double Parameter::preset_index() const
{
    const auto place = std::find(words.begin(), words.end(), option.default_value);
    return place == words.end() ? 0.0 : double(std::distance(words.begin(), place));
}

const std::vector<SpaceChoice>& space_choices()
{
    static const std::vector<SpaceChoice> choices = {
        { kAutomatic, "Automatic: the host's, else scene-linear", nullptr },
        { "scene_linear", "Scene-linear: the OCIO role, else Rec. 709", "linear" },
        { "lin_rec709", "Linear Rec. 709", "lin_rec709" },
        { "acescg", "ACEScg", "acescg" },
        { "aces2065_1", "ACES2065-1", "aces2065-1" },
        { "lin_rec2020", "Linear Rec. 2020", "lin_rec2020" },
        { "lin_p3d65", "Linear P3-D65", "lin_p3d65" },
        { "srgb", "sRGB", "srgb" },
        { "rec709", "Rec. 709 camera", "rec709" },
        { "named", "The space or role named below", "" },
    };
    return choices;
}

const std::vector<Effect>& effects()
{
    static const std::vector<Effect> all = [] {
        std::vector<Effect> list;
        for (const pimg::Filter& filter : pimg::filter_table())
            list.push_back(effect_of(filter));
        return list;
    }();
    return all;
}

}  // namespace pimg_ofx
