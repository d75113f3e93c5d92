// SPDX-License-Identifier: BSD-3-Clause
// The host as a plug-in sees it: its suites, property sets, and what is said to the user through it.
#pragma once

#include <string>
#include <vector>

#include "abi/ofx_abi.h"

namespace pimg_ofx {

/// A property set. Reading what is not there, or has another type, gives the value given for that case.
class Properties {
public:
    Properties() = default;
    Properties(const OfxPropertySuiteV1* suite, OfxPropertySetHandle handle) : m_suite(suite), m_handle(handle) { }

    explicit operator bool() const { return m_suite != nullptr && m_handle != nullptr; }

    std::string text(const char* name, int index = 0, const char* otherwise = "") const;
    std::vector<std::string> texts(const char* name) const;
    int number(const char* name, int index = 0, int otherwise = 0) const;
    double real(const char* name, int index = 0, double otherwise = 0.0) const;
    void* pointer(const char* name) const;
    OfxRectI rect(const char* name) const;  ///< empty if the four numbers are not there

    /// False if the host has no such property.
    bool set(const char* name, const std::string& value, int index = 0) const;
    bool set(const char* name, int value, int index = 0) const;
    bool set(const char* name, double value, int index = 0) const;
    bool set(const char* name, void* value) const;
    bool set(const char* name, const OfxRectD& value) const;

private:
    const OfxPropertySuiteV1* m_suite = nullptr;
    OfxPropertySetHandle m_handle = nullptr;
};

/// What one plug-in has of its host.
class Host {
public:
    void connect(OfxHost* host) { m_host = host; }

    bool is_ready() const { return m_parameters != nullptr; }

    /// Fetches the suites. False if one is missing that nothing can be done without: properties, effects, parameters.
    bool fetch();

    Properties properties(OfxPropertySetHandle handle) const { return { m_properties, handle }; }
    Properties of_host() const { return properties(m_host != nullptr ? m_host->host : nullptr); }
    Properties of_effect(OfxImageEffectHandle effect) const;
    const OfxImageEffectSuiteV1& effects() const { return *m_effects; }
    const OfxParameterSuiteV1& parameters() const { return *m_parameters; }

    /// Threads that one action may use, as the host's multi-thread suite says; 0, as many as OpenImageIO's pool has,
    /// without that suite.
    int threads() const;

    bool is_aborted(OfxImageEffectHandle effect) const { return m_effects->abort(effect) != 0; }

    /// One line for the user, of a type like kOfxMessageError; to standard error if the host has no message suite.
    void say(OfxImageEffectHandle effect, const char* type, const std::string& text) const;
    /// The same, to stay until it is taken back, where the host can do that.
    void show(OfxImageEffectHandle effect, const char* type, const std::string& text) const;
    void take_back(OfxImageEffectHandle effect) const;

    void begin_progress(OfxImageEffectHandle effect, const char* label) const;
    bool progress(OfxImageEffectHandle effect, double share) const;  ///< false if the user wants to stop
    void end_progress(OfxImageEffectHandle effect) const;

private:
    template<class Suite>
    bool fetch(const Suite*& suite, const char* name, int version) const;

    OfxHost* m_host = nullptr;
    const OfxPropertySuiteV1* m_properties = nullptr;
    const OfxImageEffectSuiteV1* m_effects = nullptr;
    const OfxParameterSuiteV1* m_parameters = nullptr;
    const OfxMultiThreadSuiteV1* m_threads = nullptr;
    const OfxMessageSuiteV1* m_messages = nullptr;
    const OfxMessageSuiteV2* m_lasting_messages = nullptr;
    const OfxProgressSuiteV1* m_progress = nullptr;
    const OfxProgressSuiteV2* m_named_progress = nullptr;
};

}  // namespace pimg_ofx
