// SPDX-License-Identifier: BSD-3-Clause
// Property sets of the test host. A set knows its properties and their types. A plug-in that asks for anything else
// gets an error, which is counted as a violation of the rules.
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "abi/ofx_abi.h"

namespace test_host {

/// Notes that the plug-in broke a rule of the interface.
void violation(const std::string& text);
int count_violations();

using Value = std::variant<std::string, int, double, void*>;

class PropertySet {
public:
    /// A property of `dimension` values like the first of `values`, which are its defaults; 0: any number.
    PropertySet& define(const std::string& name, int dimension, std::vector<Value> values);
    /// The same for any number of values, of which there is none now.
    PropertySet& define_list(const std::string& name, const Value& like);

    void set_values(const std::string& name, std::vector<Value> values);
    std::vector<Value> values(const std::string& name) const;
    std::string text(const std::string& name, std::size_t index = 0) const;
    int number(const std::string& name) const;
    double real(const std::string& name, std::size_t index = 0) const;
    std::vector<std::string> names() const;

    OfxPropertySetHandle handle() { return reinterpret_cast<OfxPropertySetHandle>(this); }
    static PropertySet& of(OfxPropertySetHandle handle) { return *reinterpret_cast<PropertySet*>(handle); }

private:
    friend struct PropertyAccess;
    struct Property {
        Value like;
        int dimension = 0;
        std::vector<Value> defaults, values;
    };
    std::map<std::string, Property> m_properties;
};

const OfxPropertySuiteV1& property_suite();

}  // namespace test_host
