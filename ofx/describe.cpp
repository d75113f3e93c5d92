// SPDX-License-Identifier: BSD-3-Clause
#include "describe.h"

#include <algorithm>
#include <cmath>

#include <pimg/version.h>

namespace pimg_ofx {

namespace {

/// Ranges that end above this number have no real end, and need a shorter slider.
constexpr double kLongSlider = 1000.0;

// Groups of parameters, and the one page.
constexpr char kGroupFilter[] = "group_filter";
constexpr char kGroupColour[] = "group_colour";
constexpr char kGroupBuild[] = "group_build";
constexpr char kGroupShot[] = "group_shot";
constexpr char kGroupFound[] = "group_found";
constexpr char kPage[] = "page_controls";

/// Defines the parameters of an effect, one after the other.
class Definer {
public:
    Definer(const Host& host, OfxParamSetHandle parameters) : m_host(host), m_parameters(parameters)
    {
        m_page = define(kOfxParamTypePage, kPage, "Controls", "");
    }

    void group(const char* name, const char* label, bool open)
    {
        m_group.clear();
        const Properties group = define(kOfxParamTypeGroup, name, label, "");
        group.set(kOfxParamPropGroupOpen, open ? 1 : 0);
        m_group = name;
    }

    /// `animates`: if the host can animate parameters of that type at all.
    Properties add(const char* type, const std::string& name, const std::string& label, const std::string& hint,
                   bool animates)
    {
        const Properties parameter = define(type, name, label, hint);
        if (type != std::string(kOfxParamTypePushButton))
            parameter.set(kOfxParamPropAnimates, animates && can_animate(type) ? 1 : 0);
        m_page.set(kOfxParamPropPageChild, name, m_children++);
        return parameter;
    }

    Properties host() const { return m_host.of_host(); }

private:
    bool can_animate(const std::string& type) const
    {
        const char* property = type == kOfxParamTypeBoolean ? kOfxParamHostPropSupportsBooleanAnimation
            : type == kOfxParamTypeChoice                   ? kOfxParamHostPropSupportsChoiceAnimation
            : type == kOfxParamTypeString                   ? kOfxParamHostPropSupportsStringAnimation
                                                            : nullptr;
        return property == nullptr || host().number(property) != 0;
    }

    Properties define(const char* type, const std::string& name, const std::string& label, const std::string& hint)
    {
        OfxPropertySetHandle handle = nullptr;
        if (m_host.parameters().paramDefine(m_parameters, type, name.c_str(), &handle) != kOfxStatOK)
            return {};
        const Properties properties = m_host.properties(handle);
        properties.set(kOfxPropLabel, label);
        properties.set(kOfxPropShortLabel, label);
        properties.set(kOfxPropLongLabel, label);
        if (!hint.empty())
            properties.set(kOfxParamPropHint, hint);
        if (!m_group.empty())
            properties.set(kOfxParamPropParent, m_group);
        return properties;
    }

    const Host& m_host;
    OfxParamSetHandle m_parameters;
    Properties m_page;
    std::string m_group;
    int m_children = 0;
};

void define_number(Definer& definer, const Parameter& parameter, const std::string& label, const std::string& hint)
{
    const pimg::OptionInfo& option = parameter.option;
    const bool whole = option.type == "int", unset = parameter.may_be_unset();
    const bool any = option.min == option.max;
    const double preset = parameter.preset(), least = unset ? kUnset : option.min;
    double high = any ? 1.0 : option.max;
    if (high > kLongSlider)
        high = std::max({ 1.0, 10.0 * preset, 10.0 * std::max(option.min, 0.0) });
    const Properties p = definer.add(whole ? kOfxParamTypeInteger : kOfxParamTypeDouble, parameter.name, label,
                                     unset ? hint + "; -1: not given" : hint, parameter.owner == Owner::filter);
    const auto set = [&](const char* name, double value) {
        whole ? p.set(name, int(value)) : p.set(name, value);
    };
    if (!whole)
        p.set(kOfxParamPropDoubleType, std::string(kOfxParamDoubleTypePlain));
    set(kOfxParamPropDefault, preset);
    if (!any) {
        set(kOfxParamPropMin, least);
        set(kOfxParamPropMax, option.max);
    }
    set(kOfxParamPropDisplayMin, any ? -high : least);
    set(kOfxParamPropDisplayMax, high);
}

void define_choice(const Properties& p, const std::vector<std::string>& words, const std::vector<std::string>& labels,
                   int preset)
{
    for (std::size_t i = 0; i < words.size(); ++i) {
        p.set(kOfxParamPropChoiceOption, labels[i], int(i));
        p.set(kOfxParamPropChoiceEnum, words[i], int(i));  // from version 1.5
    }
    p.set(kOfxParamPropDefault, preset);
}

void define_option(Definer& definer, const Parameter& parameter)
{
    const pimg::OptionInfo& option = parameter.option;
    const std::string label = pimg::label_of(option.key);
    std::string hint = pimg::label_of(option.help);
    if (!option.unit.empty())
        hint += " (" + option.unit + ")";
    const bool animates = parameter.owner == Owner::filter;
    if (option.type == "flag")
        definer.add(kOfxParamTypeBoolean, parameter.name, label, hint, animates)
            .set(kOfxParamPropDefault, option.default_value == "1" ? 1 : 0);
    else if (parameter.is_number())
        define_number(definer, parameter, label, hint);
    else if (parameter.is_choice())
        define_choice(definer.add(kOfxParamTypeChoice, parameter.name, label, hint, animates), parameter.words,
                      parameter.words, int(parameter.preset_index()));
    else {
        const Properties p = definer.add(kOfxParamTypeString, parameter.name, label, hint, animates);
        p.set(kOfxParamPropDefault, option.default_value);
        const bool file = option.file == pimg::FileUse::read;
        p.set(kOfxParamPropStringMode, std::string(file ? kOfxParamStringIsFilePath : kOfxParamStringIsSingleLine));
        if (file)
            p.set(kOfxParamPropStringFilePathExists, 0);  // because the text may also be a word
    }
}

void define_options(Definer& definer, const Effect& effect, Owner owner)
{
    for (const Parameter& parameter : effect.parameters)
        if (parameter.owner == owner)
            define_option(definer, parameter);
}

void define_colour(Definer& definer)
{
    definer.group(kGroupColour, "Colour", false);
    std::vector<std::string> words, labels;
    for (const SpaceChoice& choice : space_choices()) {
        words.emplace_back(choice.word);
        labels.emplace_back(choice.label);
    }
    define_choice(definer.add(kOfxParamTypeChoice, kColourSpace, "Colour space",
                              "What the samples of the source are, and those of the result", false),
                  words, labels, 0);
    definer
        .add(kOfxParamTypeString, kColourSpaceName, "Name",
             "A colour space or role of the OpenColorIO configuration in $OCIO, or one that pimg knows, such as "
             "g24_rec709",
             false)
        .set(kOfxParamPropDefault, std::string());
}

void define_shots(Definer& definer, const Effect& effect)
{
    definer.group(kGroupShot, "Shot", true);
    definer.add(kOfxParamTypePushButton, kAnalyseShot, "Analyse shot",
                "Measures all frames of the source and sets keys of dmax, key and white, so that nothing flickers",
                false);
    define_options(definer, effect, Owner::shot);
    definer.group(kGroupFound, "Found", false);
    definer.add(kOfxParamTypePushButton, kAnalyseFrame, "Analyse frame", "Shows below what is found in this frame",
                false);
    for (const std::string& key : effect.found) {
        const Properties p = definer.add(kOfxParamTypeDouble, kFoundPrefix + key, pimg::label_of(key),
                                         "Found in the frame last looked at, where that parameter is 0", false);
        p.set(kOfxParamPropDefault, 0.0);
        p.set(kOfxParamPropEnabled, 0);
        p.set(kOfxParamPropEvaluateOnChange, 0);
    }
}

void define_clip(const Host& host, OfxImageEffectHandle descriptor, const char* name)
{
    OfxPropertySetHandle handle = nullptr;
    if (host.effects().clipDefine(descriptor, name, &handle) != kOfxStatOK)
        return;
    const Properties clip = host.properties(handle);
    int i = 0;
    for (const char* components : { kOfxImageComponentRGBA, kOfxImageComponentRGB, kOfxImageComponentAlpha })
        clip.set(kOfxImageEffectPropSupportedComponents, std::string(components), i++);
    clip.set(kOfxImageEffectPropSupportsTiles, 1);
    clip.set(kOfxImageEffectPropTemporalClipAccess, 0);
    clip.set(kOfxImageClipPropOptional, 0);
    clip.set(kOfxImageClipPropIsMask, 0);
    // A field is filtered as a picture of full height, so that forms keep their proportions.
    clip.set(kOfxImageClipPropFieldExtraction, std::string(kOfxImageFieldDoubled));
}

/// Float where the host has it, else whatever it has.
void set_depths(const Properties& host, const Properties& effect)
{
    const std::vector<std::string> offered = host.texts(kOfxImageEffectPropSupportedPixelDepths);
    const auto has = [&](const char* depth) {
        return offered.empty() || std::find(offered.begin(), offered.end(), depth) != offered.end();
    };
    int i = 0;
    for (const char* depth : { kOfxBitDepthFloat, kOfxBitDepthHalf, kOfxBitDepthShort, kOfxBitDepthByte }) {
        if (!has(depth))
            continue;
        // Some hosts are older than the name of half, so a host that lists no depths is not offered it.
        if (depth == std::string(kOfxBitDepthHalf) && offered.empty())
            continue;
        effect.set(kOfxImageEffectPropSupportedPixelDepths, std::string(depth), i++);
        if (depth == std::string(kOfxBitDepthFloat) && !offered.empty())
            return;
    }
}

}  // namespace

OfxStatus describe(const Host& host, const Effect& effect, OfxImageEffectHandle descriptor)
{
    const Properties p = host.of_effect(descriptor);
    if (!p)
        return kOfxStatErrBadHandle;
    p.set(kOfxPropLabel, effect.label);
    p.set(kOfxPropShortLabel, effect.label);
    p.set(kOfxPropLongLabel, "pimg " + effect.label);
    p.set(kOfxImageEffectPluginPropGrouping, std::string("pimg"));
    p.set(kOfxPropPluginDescription, pimg::label_of(effect.filter->summary) + ".");
    p.set(kOfxPropVersionLabel, std::string(PIMG_VERSION_STRING));
    p.set(kOfxImageEffectPropSupportedContexts, std::string(kOfxImageEffectContextFilter), 0);
    p.set(kOfxImageEffectPropSupportedContexts, std::string(kOfxImageEffectContextGeneral), 1);
    set_depths(host.of_host(), p);
    p.set(kOfxImageEffectPluginPropSingleInstance, 0);
    p.set(kOfxImageEffectPluginRenderThreadSafety, std::string(kOfxImageEffectRenderFullySafe));
    p.set(kOfxImageEffectPluginPropHostFrameThreading, 0);
    p.set(kOfxImageEffectPropSupportsMultiResolution, 1);
    p.set(kOfxImageEffectPropSupportsTiles, 1);
    p.set(kOfxImageEffectPropTemporalClipAccess, 0);
    p.set(kOfxImageEffectPropSupportsMultipleClipDepths, 0);
    p.set(kOfxImageEffectPropSupportsMultipleClipPARs, 0);
    p.set(kOfxImageEffectPluginPropFieldRenderTwiceAlways, 1);
    const std::string style = host.of_host().text(kOfxImageEffectPropColourManagementStyle);
    if (style.empty())
        return kOfxStatOK;
    const bool ocio = style == kOfxImageEffectColourManagementOCIO;
    p.set(kOfxImageEffectPropColourManagementStyle,
          std::string(ocio ? kOfxImageEffectColourManagementOCIO : kOfxImageEffectColourManagementCore));
    p.set(kOfxImageEffectPropColourManagementAvailableConfigs, std::string(kOfxConfigIdentifier));
    return kOfxStatOK;
}

OfxStatus describe_in_context(const Host& host, const Effect& effect, OfxImageEffectHandle descriptor)
{
    define_clip(host, descriptor, kOfxImageEffectSimpleSourceClipName);
    define_clip(host, descriptor, kOfxImageEffectOutputClipName);
    OfxParamSetHandle parameters = nullptr;
    if (host.effects().getParamSet(descriptor, &parameters) != kOfxStatOK)
        return kOfxStatErrBadHandle;
    Definer definer(host, parameters);
    definer.group(kGroupFilter, "Filter", true);
    define_options(definer, effect, Owner::filter);
    if (effect.has_shots())
        define_shots(definer, effect);
    define_colour(definer);
    definer.group(kGroupBuild, "Hierarchy", false);
    define_options(definer, effect, Owner::build);
    return kOfxStatOK;
}

}  // namespace pimg_ofx
