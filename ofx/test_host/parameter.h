// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the test host: descriptors and values with keys. Values may be read by many threads while another sets them.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "property_set.h"

namespace test_host {

struct Parameter {
    std::string type, name;
    PropertySet properties;
    Value value;                   ///< without keys
    std::map<double, Value> keys;  ///< by time
    std::mutex* mutex = nullptr;   ///< of the set

    bool is_text() const { return type == kOfxParamTypeString; }
    bool is_real() const { return type == kOfxParamTypeDouble; }
    bool is_whole() const;
    Value at(double time) const;
    /// From text as on a command line; a choice by its word. False if it cannot be read.
    bool set(const std::string& text, const double* time = nullptr);

    OfxParamHandle handle() { return reinterpret_cast<OfxParamHandle>(this); }
    static Parameter& of(OfxParamHandle handle) { return *reinterpret_cast<Parameter*>(handle); }
};

struct ParameterSet {
    PropertySet properties;
    std::deque<Parameter> all;  ///< in the order of their definition; addresses stay
    std::mutex mutex;
    int open_edits = 0;

    Parameter* find(const std::string& name);
    /// What an instance begins with: the defaults.
    void copy_from(const ParameterSet& descriptor);

    OfxParamSetHandle handle() { return reinterpret_cast<OfxParamSetHandle>(this); }
    static ParameterSet& of(OfxParamSetHandle handle) { return *reinterpret_cast<ParameterSet*>(handle); }
};

const OfxParameterSuiteV1& parameter_suite();

}  // namespace test_host
