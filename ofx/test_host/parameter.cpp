// SPDX-License-Identifier: BSD-3-Clause
#include "parameter.h"

#include <array>
#include <cfloat>
#include <climits>
#include <cstdarg>
#include <cstdlib>

namespace test_host {

namespace {

using Text = std::string;

bool is_value_type(const std::string& type)
{
    return type == kOfxParamTypeInteger || type == kOfxParamTypeDouble || type == kOfxParamTypeBoolean
        || type == kOfxParamTypeChoice || type == kOfxParamTypeString;
}

/// The properties that the specification gives a parameter of that type.
void define_properties(Parameter& p)
{
    PropertySet& set = p.properties;
    set.define(kOfxPropType, 1, { Text(kOfxTypeParameter) }).define(kOfxPropName, 1, { p.name });
    set.define(kOfxParamPropType, 1, { p.type }).define(kOfxParamPropHint, 1, { Text() });
    for (const char* label : { kOfxPropLabel, kOfxPropShortLabel, kOfxPropLongLabel })
        set.define(label, 1, { p.name });
    set.define(kOfxParamPropParent, 1, { Text() }).define(kOfxParamPropScriptName, 1, { p.name });
    set.define(kOfxParamPropEnabled, 1, { 1 });
    if (p.type == kOfxParamTypeGroup)
        set.define(kOfxParamPropGroupOpen, 1, { 1 });
    if (p.type == kOfxParamTypePage)
        set.define_list(kOfxParamPropPageChild, Text());
    if (!is_value_type(p.type))
        return;
    set.define(kOfxParamPropAnimates, 1, { 1 }).define(kOfxParamPropEvaluateOnChange, 1, { 1 });
    const Value none = p.is_text() ? Value(Text()) : p.is_real() ? Value(0.0) : Value(0);
    set.define(kOfxParamPropDefault, 1, { none });
    if (p.type == kOfxParamTypeChoice) {
        set.define_list(kOfxParamPropChoiceOption, Text());
        set.define_list(kOfxParamPropChoiceEnum, Text());
    }
    if (p.is_text())
        set.define(kOfxParamPropStringMode, 1, { Text(kOfxParamStringIsSingleLine) })
            .define(kOfxParamPropStringFilePathExists, 1, { 1 });
    if (p.is_real())
        set.define(kOfxParamPropDoubleType, 1, { Text(kOfxParamDoubleTypePlain) });
    if (p.type != kOfxParamTypeInteger && !p.is_real())
        return;
    for (const char* least : { kOfxParamPropMin, kOfxParamPropDisplayMin })
        set.define(least, 1, { p.is_real() ? Value(-DBL_MAX) : Value(INT_MIN) });
    for (const char* most : { kOfxParamPropMax, kOfxParamPropDisplayMax })
        set.define(most, 1, { p.is_real() ? Value(DBL_MAX) : Value(INT_MAX) });
}

/// A copy of the text that C can use. It lasts until the same thread has asked for 64 more.
char* lasting(const std::string& text)
{
    thread_local std::array<std::string, 64> ring;
    thread_local std::size_t next = 0;
    std::string& place = ring[next++ % ring.size()];
    place = text;
    return place.data();
}

OfxStatus define(OfxParamSetHandle set, const char* type, const char* name, OfxPropertySetHandle* properties)
{
    ParameterSet& parameters = ParameterSet::of(set);
    if (parameters.find(name) != nullptr) {
        violation(std::string("a parameter is defined twice: ") + name);
        return kOfxStatErrExists;
    }
    Parameter& p = parameters.all.emplace_back();
    p.type = type;
    p.name = name;
    define_properties(p);
    if (properties != nullptr)
        *properties = p.properties.handle();
    return kOfxStatOK;
}

OfxStatus get_handle(OfxParamSetHandle set, const char* name, OfxParamHandle* handle, OfxPropertySetHandle* properties)
{
    Parameter* parameter = ParameterSet::of(set).find(name);
    if (parameter == nullptr)
        return kOfxStatErrUnknown;
    *handle = parameter->handle();
    if (properties != nullptr)
        *properties = parameter->properties.handle();
    return kOfxStatOK;
}

OfxStatus give(const Parameter& p, const Value& value, va_list arguments)
{
    if (p.is_text())
        *va_arg(arguments, char**) = lasting(std::get<Text>(value));
    else if (p.is_real())
        *va_arg(arguments, double*) = std::get<double>(value);
    else if (p.is_whole())
        *va_arg(arguments, int*) = std::get<int>(value);
    else {
        violation("the value of " + p.name + " is asked for, which has none");
        return kOfxStatErrBadHandle;
    }
    return kOfxStatOK;
}

OfxStatus get_value(OfxParamHandle handle, ...)
{
    const Parameter& p = Parameter::of(handle);
    const std::lock_guard<std::mutex> lock(*p.mutex);
    va_list arguments;
    va_start(arguments, handle);
    const OfxStatus status = give(p, p.at(0.0), arguments);
    va_end(arguments);
    return status;
}

OfxStatus get_value_at_time(OfxParamHandle handle, OfxTime time, ...)
{
    const Parameter& p = Parameter::of(handle);
    const std::lock_guard<std::mutex> lock(*p.mutex);
    va_list arguments;
    va_start(arguments, time);
    const OfxStatus status = give(p, p.at(time), arguments);
    va_end(arguments);
    return status;
}

Value taken(const Parameter& p, va_list arguments)
{
    if (p.is_text())
        return Text(va_arg(arguments, const char*));
    if (p.is_real())
        return va_arg(arguments, double);
    return va_arg(arguments, int);
}

OfxStatus set_value(OfxParamHandle handle, ...)
{
    Parameter& p = Parameter::of(handle);
    const std::lock_guard<std::mutex> lock(*p.mutex);
    va_list arguments;
    va_start(arguments, handle);
    p.value = taken(p, arguments);
    va_end(arguments);
    return kOfxStatOK;
}

OfxStatus set_value_at_time(OfxParamHandle handle, OfxTime time, ...)
{
    Parameter& p = Parameter::of(handle);
    const std::lock_guard<std::mutex> lock(*p.mutex);
    if (p.properties.number(kOfxParamPropAnimates) == 0) {
        violation("a key is set of " + p.name + ", which does not animate");
        return kOfxStatErrValue;
    }
    va_list arguments;
    va_start(arguments, time);
    p.keys[time] = taken(p, arguments);
    va_end(arguments);
    return kOfxStatOK;
}

OfxStatus begin_edit(OfxParamSetHandle set, const char*)
{
    ++ParameterSet::of(set).open_edits;
    return kOfxStatOK;
}

OfxStatus no_derivative(OfxParamHandle, OfxTime, ...)
{
    return kOfxStatErrUnsupported;
}

OfxStatus no_integral(OfxParamHandle, OfxTime, OfxTime, ...)
{
    return kOfxStatErrUnsupported;
}

}  // namespace

bool Parameter::is_whole() const
{
    return type == kOfxParamTypeInteger || type == kOfxParamTypeBoolean || type == kOfxParamTypeChoice;
}

/// Linear between keys where that makes sense.
Value Parameter::at(double time) const
{
    if (keys.empty())
        return value;
    const auto after = keys.lower_bound(time);
    if (after == keys.end())
        return keys.rbegin()->second;
    if (after == keys.begin() || after->first == time)
        return after->second;
    const auto before = std::prev(after);
    if (!is_real())
        return before->second;
    const double share = (time - before->first) / (after->first - before->first);
    return (1.0 - share) * std::get<double>(before->second) + share * std::get<double>(after->second);
}

bool Parameter::set(const std::string& text, const double* time)
{
    Value given = text;
    char* end = nullptr;
    if (type == kOfxParamTypeChoice) {
        const std::vector<Value> words = properties.values(kOfxParamPropChoiceEnum);
        int index = -1;
        for (std::size_t i = 0; i < words.size(); ++i)
            if (std::get<Text>(words[i]) == text)
                index = int(i);
        if (index < 0)
            return false;
        given = index;
    } else if (is_real())
        given = std::strtod(text.c_str(), &end);
    else if (is_whole())
        given = int(std::strtol(text.c_str(), &end, 10));
    if (end != nullptr && (end == text.c_str() || *end != '\0'))
        return false;
    const std::lock_guard<std::mutex> lock(*mutex);
    if (time != nullptr)
        keys[*time] = given;
    else
        value = given;
    return true;
}

Parameter* ParameterSet::find(const std::string& name)
{
    for (Parameter& parameter : all)
        if (parameter.name == name)
            return &parameter;
    return nullptr;
}

void ParameterSet::copy_from(const ParameterSet& descriptor)
{
    properties = descriptor.properties;
    for (const Parameter& theirs : descriptor.all) {
        Parameter& p = all.emplace_back(theirs);
        p.mutex = &mutex;
        if (is_value_type(p.type))
            p.value = p.properties.values(kOfxParamPropDefault).at(0);
    }
}

const OfxParameterSuiteV1& parameter_suite()
{
    static const OfxParameterSuiteV1 suite = {
        define,
        get_handle,
        [](OfxParamSetHandle set, OfxPropertySetHandle* properties) -> OfxStatus {
            *properties = ParameterSet::of(set).properties.handle();
            return kOfxStatOK;
        },
        [](OfxParamHandle handle, OfxPropertySetHandle* properties) -> OfxStatus {
            *properties = Parameter::of(handle).properties.handle();
            return kOfxStatOK;
        },
        get_value,
        get_value_at_time,
        no_derivative,
        no_integral,
        set_value,
        set_value_at_time,
        [](OfxParamHandle handle, unsigned int* count) -> OfxStatus {
            *count = unsigned(Parameter::of(handle).keys.size());
            return kOfxStatOK;
        },
        [](OfxParamHandle handle, unsigned int key, OfxTime* time) -> OfxStatus {
            const Parameter& p = Parameter::of(handle);
            if (key >= p.keys.size())
                return kOfxStatErrBadIndex;
            *time = std::next(p.keys.begin(), long(key))->first;
            return kOfxStatOK;
        },
        [](OfxParamHandle, OfxTime, int, int*) -> OfxStatus { return kOfxStatErrUnsupported; },
        [](OfxParamHandle handle, OfxTime time) -> OfxStatus {
            return Parameter::of(handle).keys.erase(time) > 0 ? kOfxStatOK : kOfxStatErrBadIndex;
        },
        [](OfxParamHandle handle) -> OfxStatus {
            Parameter::of(handle).keys.clear();
            return kOfxStatOK;
        },
        [](OfxParamHandle, OfxParamHandle, OfxTime, const OfxRangeD*) -> OfxStatus { return kOfxStatErrUnsupported; },
        begin_edit,
        [](OfxParamSetHandle set) -> OfxStatus {
            if (--ParameterSet::of(set).open_edits < 0)
                violation("an edit ends that has not begun");
            return kOfxStatOK;
        },
    };
    return suite;
}

}  // namespace test_host
