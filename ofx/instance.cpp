// SPDX-License-Identifier: BSD-3-Clause
#include "instance.h"

#include <algorithm>
#include <climits>
#include <cmath>

#include <pimg/detail/format.h>

namespace pimg_ofx {

namespace {

/// Hosts say INT_MAX, or numbers near it, for regions without an end; no picture has half as many pixels in a row.
constexpr double kInfinite = double(INT_MAX / 2);

}  // namespace

Instance::Instance(const Host& host, const Effect& effect, OfxImageEffectHandle handle)
    : m_host(host),
      m_effect(effect),
      m_handle(handle)
{
    host.effects().clipGetHandle(handle, kOfxImageEffectSimpleSourceClipName, &m_source, nullptr);
    host.effects().clipGetHandle(handle, kOfxImageEffectOutputClipName, &m_output, nullptr);
    OfxParamSetHandle set = nullptr;
    if (host.effects().getParamSet(handle, &set) != kOfxStatOK)
        return;
    std::vector<std::string> names = { kColourSpace, kColourSpaceName };
    for (const Parameter& parameter : effect.parameters)
        names.push_back(parameter.name);
    for (const std::string& key : effect.found)
        names.push_back(kFoundPrefix + key);
    for (const std::string& name : names) {
        OfxParamHandle found = nullptr;
        if (host.parameters().paramGetHandle(set, name.c_str(), &found, nullptr) == kOfxStatOK)
            m_parameters[name] = found;
    }
}

Properties Instance::of_clip(OfxImageClipHandle clip) const
{
    OfxPropertySetHandle handle = nullptr;
    if (clip == nullptr || m_host.effects().clipGetPropertySet(clip, &handle) != kOfxStatOK)
        return {};
    return m_host.properties(handle);
}

bool Instance::source_region(OfxTime time, OfxRectD& region) const
{
    if (m_source == nullptr || m_host.effects().clipGetRegionOfDefinition(m_source, time, &region) != kOfxStatOK)
        return false;
    // Generators are defined everywhere; what is seen of them is the project's window.
    const Properties instance = m_host.of_effect(m_handle);
    const auto bound = [&](double& low, double& high, int axis) {
        const double size = instance.real(kOfxImageEffectPropProjectSize, axis);
        const double offset = instance.real(kOfxImageEffectPropProjectOffset, axis);
        low = low > -kInfinite ? low : offset;
        high = high < kInfinite ? high : offset + size;
        return low < high && high - low < kInfinite;
    };
    return bound(region.x1, region.x2, 0) && bound(region.y1, region.y2, 1);
}

OfxParamHandle Instance::parameter(const std::string& name) const
{
    const auto found = m_parameters.find(name);
    return found == m_parameters.end() ? nullptr : found->second;
}

double Instance::real(const std::string& name, OfxTime time) const
{
    double value = 0.0;
    if (const OfxParamHandle handle = parameter(name))
        m_host.parameters().paramGetValueAtTime(handle, time, &value);
    return value;
}

int Instance::number(const std::string& name, OfxTime time) const
{
    int value = 0;
    if (const OfxParamHandle handle = parameter(name))
        m_host.parameters().paramGetValueAtTime(handle, time, &value);
    return value;
}

std::string Instance::text(const std::string& name, OfxTime time) const
{
    char* value = nullptr;
    if (const OfxParamHandle handle = parameter(name))
        m_host.parameters().paramGetValueAtTime(handle, time, &value);
    return value != nullptr ? value : "";
}

std::string Instance::number_text(const Parameter& parameter, OfxTime time, double scale) const
{
    const pimg::OptionInfo& option = parameter.option;
    const bool whole = option.type == "int";
    double given = whole ? number(parameter.name, time) : real(parameter.name, time);
    if (parameter.may_be_unset() && given <= kUnset)
        return "";
    given = pimg::resized_length(option, given, scale);
    // Hosts may give values outside of the range that they were told.
    if (option.min != option.max)
        given = std::clamp(given, option.min, option.max);
    if (whole)
        return given == parameter.preset() ? "" : pimg::format("{}", int(given));
    const float value = float(given);
    // In the table the default is the shortest text that gives its float.
    return value == float(parameter.preset()) ? "" : pimg::format("{:.9g}", double(value));
}

std::string Instance::text_of(const Parameter& parameter, OfxTime time, double scale) const
{
    if (m_parameters.count(parameter.name) == 0)
        return "";
    const pimg::OptionInfo& option = parameter.option;
    std::string value;
    if (parameter.is_number())
        return number_text(parameter, time, scale);
    if (option.type == "flag")
        value = number(parameter.name, time) != 0 ? "1" : "0";
    else if (parameter.is_choice()) {
        const int index = number(parameter.name, time);
        if (index >= 0 && index < int(parameter.words.size()))
            value = parameter.words[std::size_t(index)];
        if (value == kAutomatic)
            value.clear();
    } else
        value = text(parameter.name, time);
    return value == option.default_value ? "" : value;
}

pimg::OptionTexts Instance::options(Owner owner, OfxTime time, double scale) const
{
    pimg::OptionTexts texts;
    for (const Parameter& parameter : m_effect.parameters) {
        if (parameter.owner != owner)
            continue;
        const std::string text = text_of(parameter, time, scale);
        if (!text.empty())
            texts.emplace_back(parameter.option.key, text);
    }
    return texts;
}

std::string Instance::option(const std::string& key, OfxTime time) const
{
    for (const Parameter& parameter : m_effect.parameters)
        if (parameter.owner == Owner::filter && parameter.option.key == key)
            return text_of(parameter, time, 1.0);
    return "";
}

void Instance::complain(const std::string& text)
{
    m_complained = true;
    m_host.show(m_handle, kOfxMessageError, m_effect.label + ": " + text);
}

void Instance::be_content()
{
    if (m_complained.exchange(false))
        m_host.take_back(m_handle);
}

Instance* instance_of(const Host& host, OfxImageEffectHandle handle)
{
    return static_cast<Instance*>(host.of_effect(handle).pointer(kOfxPropInstanceData));
}

}  // namespace pimg_ofx
