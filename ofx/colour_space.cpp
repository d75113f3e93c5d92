// SPDX-License-Identifier: BSD-3-Clause
#include "colour_space.h"

#include <pimg/colour.h>
#include <pimg/detail/colour_config.h>
#include <pimg/detail/format.h>

namespace pimg_ofx {

namespace {

/// The role of OpenColorIO's configurations that encoded pictures are decoded to.
constexpr char kSceneLinearRole[] = "scene_linear";

/// The user's choice; null for none.
const SpaceChoice* choice_of(const Instance& instance, OfxTime time)
{
    const auto& choices = space_choices();
    const int index = instance.number(kColourSpace, time);
    return index > 0 && index < int(choices.size()) ? &choices[std::size_t(index)] : nullptr;
}

std::string style_of(const Instance& instance)
{
    const std::string style =
        instance.host().of_effect(instance.handle()).text(kOfxImageEffectPropColourManagementStyle);
    return style != kOfxImageEffectColourManagementNone ? style : "";
}

bool is_managed(const Instance& instance)
{
    return !style_of(instance).empty();
}

bool is_known(const std::string& space, const OIIO::TypeDesc& depth, pimg::Colour& colour, std::string& error)
{
    return pimg::Colour::resolve(OIIO::ImageSpec(1, 1, 3, depth), space, "", colour, error);
}

}  // namespace

namespace {

/// OpenFX's name for the linear space with the primaries of `space`, an encoded one.
std::string linear_space(const std::string& space)
{
    static const std::pair<const char*, const char*> known[] = { { "_p3d65", "lin_p3d65" },
                                                                 { "_rec2020", "lin_rec2020" },
                                                                 { "_ap1", "ACEScg" } };
    for (const auto& [primaries, name] : known)
        if (space.find(primaries) != std::string::npos)
            return name;
    return kOfxColourspaceLinRec709Srgb;
}

}  // namespace

std::string space_of_host(const std::string& name)
{
    // Display spaces without a curve and primaries in their names: SMPTE RP 431-2 and ITU-R BT.1886.
    static const std::pair<const char*, const char*> known[] = {
        { kOfxColourspaceOfxSceneLinear, "" },
        { kOfxColourspaceOfxDisplaySdr, "srgb" },
        { kOfxColourspaceLinRec709Srgb, "lin_rec709" },
        { "srgb_display", "srgb" },
        { "srgb_tx", "srgb" },
        { "displayp3_display", "srgb_p3d65" },
        { "rec1886_rec709_display", "g24_rec709" },
        { "rec1886_rec2020_display", "g24_rec2020" },
        { "p3d65_display", "g26_p3d65" },
        { "g18_rec709_tx", "g18_rec709" },
        { "g22_rec709_tx", "g22_rec709" },
        { "g24_rec709_tx", "g24_rec709" },
        { "g22_ap1_tx", "g22_ap1" },
        { "srgb_encoded_ap1_tx", "srgb_ap1" },
        { "srgb_encoded_p3d65_tx", "srgb_p3d65" },
    };
    for (const auto& [theirs, ours] : known)
        if (name == theirs)
            return ours;
    return name;
}

namespace {

std::string named_config(const Instance& instance)
{
    if (style_of(instance) != kOfxImageEffectColourManagementOCIO)
        return "";
    return instance.host().of_effect(instance.handle()).text(kOfxImageEffectPropOCIOConfig);
}

bool can_read(const std::string& config, std::string& error)
{
    const pimg::ColourConfigScope scope(config);
    return pimg::check_colour_config(error);
}

}  // namespace

std::string host_config(const Instance& instance)
{
    std::string error;
    const std::string config = named_config(instance);
    return !config.empty() && can_read(config, error) ? config : "";
}

bool source_space(const Instance& instance, OfxTime time, const OIIO::TypeDesc& depth, std::string& space,
                  std::string& error)
{
    pimg::Colour colour;
    if (const SpaceChoice* choice = choice_of(instance, time)) {
        space = *choice->space != '\0' ? choice->space : instance.text(kColourSpaceName, time);
        return space.empty() || is_known(space, depth, colour, error);
    }
    space.clear();
    const std::string named = instance.of_clip(instance.source_clip()).text(kOfxImageClipPropColourspace);
    if (!is_managed(instance) || named.empty() || named == kOfxColourspaceOfxRaw)
        return true;
    // A configuration may have spaces called like those of OpenFX's own.
    space = named;
    if (!host_config(instance).empty() && is_known(space, depth, colour, error))
        return true;
    space = space_of_host(named);
    if (space.empty() || is_known(space, depth, colour, error))
        return true;
    const std::string config = named_config(instance);
    if (!config.empty() && !can_read(config, error))
        return false;
    error =
        pimg::format("the host's colour space \"{}\" is unknown: choose one, or a host space that is scene-linear ({})",
                     named, error);
    return false;
}

bool prefer_spaces(const Instance& instance, OfxTime time, const Properties& out)
{
    if (!is_managed(instance) || choice_of(instance, time) != nullptr)
        return false;
    const std::string name = kClipPreferredColourspaces + std::string(kOfxImageEffectSimpleSourceClipName);
    int i = 0;
    // The role of a configuration comes first; the other name is good in every style.
    if (!host_config(instance).empty() && out.set(name.c_str(), std::string(kSceneLinearRole), i))
        ++i;
    return out.set(name.c_str(), std::string(kOfxColourspaceOfxSceneLinear), i);
}

OfxStatus output_space(const Instance& instance, OfxTime time, const Properties& out)
{
    pimg::BoundFilter filter;
    std::string error, space;
    if (!instance.effect().filter->bind(instance.options(Owner::filter, time), filter, error))
        return kOfxStatReplyDefault;
    std::string name = kColourspaceOfClip + std::string(kOfxImageEffectSimpleSourceClipName);
    if (filter.output == pimg::FilterOutput::labels || filter.output == pimg::FilterOutput::mask
        || filter.output == pimg::FilterOutput::gain)
        name = kOfxColourspaceOfxRaw;
    pimg::Colour colour;
    if (filter.output == pimg::FilterOutput::light && source_space(instance, time, OIIO::TypeDesc::FLOAT, space, error)
        && is_known(space, OIIO::TypeDesc::FLOAT, colour, error) && colour.encoded())
        name = host_config(instance).empty() ? linear_space(space) : kSceneLinearRole;
    return out.set(kOfxImageClipPropColourspace, name) ? kOfxStatOK : kOfxStatReplyDefault;
}

}  // namespace pimg_ofx
