// SPDX-License-Identifier: BSD-3-Clause
#include "property_set.h"

#include <atomic>
#include <cstdio>

namespace test_host {

namespace {

std::atomic<int> violations { 0 };

}  // namespace

void violation(const std::string& text)
{
    ++violations;
    std::fprintf(stderr, "violation: %s\n", text.c_str());
}

int count_violations()
{
    return violations;
}

PropertySet& PropertySet::define(const std::string& name, int dimension, std::vector<Value> values)
{
    m_properties[name] = { values.at(0), dimension, values, values };
    return *this;
}

PropertySet& PropertySet::define_list(const std::string& name, const Value& like)
{
    m_properties[name] = { like, 0, {}, {} };
    return *this;
}

void PropertySet::set_values(const std::string& name, std::vector<Value> values)
{
    m_properties.at(name).values = std::move(values);
}

std::vector<Value> PropertySet::values(const std::string& name) const
{
    const auto found = m_properties.find(name);
    return found == m_properties.end() ? std::vector<Value>() : found->second.values;
}

std::string PropertySet::text(const std::string& name, std::size_t index) const
{
    const std::vector<Value> all = values(name);
    return index < all.size() ? std::get<std::string>(all[index]) : "";
}

int PropertySet::number(const std::string& name) const
{
    const std::vector<Value> all = values(name);
    return all.empty() ? 0 : std::get<int>(all[0]);
}

double PropertySet::real(const std::string& name, std::size_t index) const
{
    const std::vector<Value> all = values(name);
    return index < all.size() ? std::get<double>(all[index]) : 0.0;
}

std::vector<std::string> PropertySet::names() const
{
    std::vector<std::string> all;
    for (const auto& [name, property] : m_properties)
        all.push_back(name);
    return all;
}

/// The functions of the suite.
struct PropertyAccess {
    /// The property, if there is one with values of type T. To read a property that only other versions of a host have
    /// is no violation, but to use a wrong type is.
    template<class T>
    static PropertySet::Property* find(OfxPropertySetHandle handle, const char* name, OfxStatus& status)
    {
        if (handle == nullptr || name == nullptr) {
            violation("a property set or name is null");
            status = kOfxStatErrBadHandle;
            return nullptr;
        }
        auto& properties = PropertySet::of(handle).m_properties;
        const auto found = properties.find(name);
        status = kOfxStatErrUnknown;
        if (found == properties.end())
            return nullptr;
        status = kOfxStatErrValue;
        if (!std::holds_alternative<T>(found->second.like)) {
            violation(std::string("another type of value is in ") + name);
            return nullptr;
        }
        status = kOfxStatOK;
        return &found->second;
    }

    template<class T>
    static OfxStatus set(OfxPropertySetHandle handle, const char* name, int index, const T& value)
    {
        OfxStatus status = kOfxStatOK;
        PropertySet::Property* property = find<T>(handle, name, status);
        if (property == nullptr) {
            if (status == kOfxStatErrUnknown)
                violation(std::string("the set has no property ") + name);
            return status;
        }
        const std::size_t size = property->values.size(), place = std::size_t(index);
        if (index < 0 || (property->dimension > 0 && index >= property->dimension) || place > size) {
            violation(std::string("wrong index for ") + name);
            return kOfxStatErrBadIndex;
        }
        if (place == size)
            property->values.emplace_back(value);
        else
            property->values[place] = value;
        return kOfxStatOK;
    }

    template<class T>
    static OfxStatus get(OfxPropertySetHandle handle, const char* name, int index, T*& value)
    {
        OfxStatus status = kOfxStatOK;
        PropertySet::Property* property = find<T>(handle, name, status);
        if (property == nullptr)
            return status;
        if (index < 0 || std::size_t(index) >= property->values.size())
            return kOfxStatErrBadIndex;
        value = &std::get<T>(property->values[std::size_t(index)]);
        return kOfxStatOK;
    }

    template<class T, class Given>
    static OfxStatus set_all(OfxPropertySetHandle handle, const char* name, int count, const Given* values)
    {
        OfxStatus status = kOfxStatOK;
        for (int i = 0; i < count && status == kOfxStatOK; ++i)
            status = set<T>(handle, name, i, T(values[i]));
        return status;
    }

    template<class T>
    static OfxStatus get_all(OfxPropertySetHandle handle, const char* name, int count, T* values)
    {
        OfxStatus status = kOfxStatOK;
        for (int i = 0; i < count && status == kOfxStatOK; ++i) {
            T* value = nullptr;
            status = get<T>(handle, name, i, value);
            if (status == kOfxStatOK)
                values[i] = *value;
        }
        return status;
    }

    template<class T>
    static OfxStatus get_one(OfxPropertySetHandle handle, const char* name, int index, T* value)
    {
        T* found = nullptr;
        const OfxStatus status = get<T>(handle, name, index, found);
        if (status == kOfxStatOK)
            *value = *found;
        return status;
    }

    static OfxStatus get_text(OfxPropertySetHandle handle, const char* name, int index, char** value)
    {
        std::string* found = nullptr;
        const OfxStatus status = get<std::string>(handle, name, index, found);
        if (status == kOfxStatOK)
            *value = found->data();
        return status;
    }

    static OfxStatus get_texts(OfxPropertySetHandle handle, const char* name, int count, char** values)
    {
        OfxStatus status = kOfxStatOK;
        for (int i = 0; i < count && status == kOfxStatOK; ++i)
            status = get_text(handle, name, i, &values[i]);
        return status;
    }

    static OfxStatus reset(OfxPropertySetHandle handle, const char* name)
    {
        auto& properties = PropertySet::of(handle).m_properties;
        const auto found = properties.find(name);
        if (found == properties.end())
            return kOfxStatErrUnknown;
        found->second.values = found->second.defaults;
        return kOfxStatOK;
    }

    static OfxStatus dimension(OfxPropertySetHandle handle, const char* name, int* count)
    {
        const auto& properties = PropertySet::of(handle).m_properties;
        const auto found = properties.find(name);
        if (found == properties.end())
            return kOfxStatErrUnknown;
        *count = int(found->second.values.size());
        return kOfxStatOK;
    }
};

const OfxPropertySuiteV1& property_suite()
{
    using Set = OfxPropertySetHandle;
    using Access = PropertyAccess;
    static const OfxPropertySuiteV1 suite = {
        [](Set s, const char* n, int i, void* v) { return Access::set<void*>(s, n, i, v); },
        [](Set s, const char* n, int i, const char* v) { return Access::set<std::string>(s, n, i, v); },
        [](Set s, const char* n, int i, double v) { return Access::set<double>(s, n, i, v); },
        [](Set s, const char* n, int i, int v) { return Access::set<int>(s, n, i, v); },
        [](Set s, const char* n, int c, void* const* v) { return Access::set_all<void*>(s, n, c, v); },
        [](Set s, const char* n, int c, const char* const* v) { return Access::set_all<std::string>(s, n, c, v); },
        [](Set s, const char* n, int c, const double* v) { return Access::set_all<double>(s, n, c, v); },
        [](Set s, const char* n, int c, const int* v) { return Access::set_all<int>(s, n, c, v); },
        Access::get_one<void*>,
        Access::get_text,
        Access::get_one<double>,
        Access::get_one<int>,
        Access::get_all<void*>,
        Access::get_texts,
        Access::get_all<double>,
        Access::get_all<int>,
        Access::reset,
        Access::dimension,
    };
    return suite;
}

}  // namespace test_host
