// SPDX-License-Identifier: BSD-3-Clause
#include "host/host.h"

#include <algorithm>
#include <cstdio>

namespace pimg_ofx {

namespace {

/// Goes before every message, so that the user knows who speaks.
constexpr char kMessageId[] = "pimg";

}  // namespace

std::string Properties::text(const char* name, int index, const char* otherwise) const
{
    char* value = nullptr;
    const bool found = *this && m_suite->propGetString(m_handle, name, index, &value) == kOfxStatOK;
    return found && value != nullptr ? value : otherwise;
}

std::vector<std::string> Properties::texts(const char* name) const
{
    int count = 0;
    if (!*this || m_suite->propGetDimension(m_handle, name, &count) != kOfxStatOK)
        count = 0;
    std::vector<std::string> values(std::size_t(std::max(count, 0)));
    for (int i = 0; i < count; ++i)
        values[std::size_t(i)] = text(name, i);
    return values;
}

int Properties::number(const char* name, int index, int otherwise) const
{
    int value = otherwise;
    return *this && m_suite->propGetInt(m_handle, name, index, &value) == kOfxStatOK ? value : otherwise;
}

double Properties::real(const char* name, int index, double otherwise) const
{
    double value = otherwise;
    return *this && m_suite->propGetDouble(m_handle, name, index, &value) == kOfxStatOK ? value : otherwise;
}

void* Properties::pointer(const char* name) const
{
    void* value = nullptr;
    return *this && m_suite->propGetPointer(m_handle, name, 0, &value) == kOfxStatOK ? value : nullptr;
}

OfxRectI Properties::rect(const char* name) const
{
    int v[4] = { 0, 0, 0, 0 };
    if (!*this || m_suite->propGetIntN(m_handle, name, 4, v) != kOfxStatOK)
        return { 0, 0, 0, 0 };
    return { v[0], v[1], v[2], v[3] };
}

bool Properties::set(const char* name, const std::string& value, int index) const
{
    return *this && m_suite->propSetString(m_handle, name, index, value.c_str()) == kOfxStatOK;
}

bool Properties::set(const char* name, int value, int index) const
{
    return *this && m_suite->propSetInt(m_handle, name, index, value) == kOfxStatOK;
}

bool Properties::set(const char* name, double value, int index) const
{
    return *this && m_suite->propSetDouble(m_handle, name, index, value) == kOfxStatOK;
}

bool Properties::set(const char* name, void* value) const
{
    return *this && m_suite->propSetPointer(m_handle, name, 0, value) == kOfxStatOK;
}

bool Properties::set(const char* name, const OfxRectD& value) const
{
    const double values[4] = { value.x1, value.y1, value.x2, value.y2 };
    return *this && m_suite->propSetDoubleN(m_handle, name, 4, values) == kOfxStatOK;
}

template<class Suite>
bool Host::fetch(const Suite*& suite, const char* name, int version) const
{
    suite = static_cast<const Suite*>(m_host->fetchSuite(m_host->host, name, version));
    return suite != nullptr;
}

bool Host::fetch()
{
    if (m_host == nullptr || m_host->fetchSuite == nullptr)
        return false;
    fetch(m_threads, kOfxMultiThreadSuite, 1);
    fetch(m_messages, kOfxMessageSuite, 1);
    fetch(m_lasting_messages, kOfxMessageSuite, 2);
    fetch(m_progress, kOfxProgressSuite, 1);
    fetch(m_named_progress, kOfxProgressSuite, 2);
    return fetch(m_properties, kOfxPropertySuite, 1) && fetch(m_effects, kOfxImageEffectSuite, 1)
        && fetch(m_parameters, kOfxParameterSuite, 1);
}

Properties Host::of_effect(OfxImageEffectHandle effect) const
{
    OfxPropertySetHandle handle = nullptr;
    if (m_effects->getPropertySet(effect, &handle) != kOfxStatOK)
        return {};
    return properties(handle);
}

int Host::threads() const
{
    if (m_threads == nullptr)
        return 0;
    // On a thread that the host has spawned for us, one thread is used: its siblings use the other processors.
    unsigned int count = 1;
    if (m_threads->multiThreadIsSpawnedThread() != 0 || m_threads->multiThreadNumCPUs(&count) != kOfxStatOK)
        return 1;
    return std::max(1, int(count));
}

void Host::say(OfxImageEffectHandle effect, const char* type, const std::string& text) const
{
    if (m_messages != nullptr)
        m_messages->message(effect, type, kMessageId, "%s", text.c_str());
    else
        std::fprintf(stderr, "%s: %s\n", kMessageId, text.c_str());
}

void Host::show(OfxImageEffectHandle effect, const char* type, const std::string& text) const
{
    if (m_lasting_messages == nullptr
        || m_lasting_messages->setPersistentMessage(effect, type, kMessageId, "%s", text.c_str()) != kOfxStatOK)
        say(effect, type, text);
}

void Host::take_back(OfxImageEffectHandle effect) const
{
    if (m_lasting_messages != nullptr)
        m_lasting_messages->clearPersistentMessage(effect);
}

void Host::begin_progress(OfxImageEffectHandle effect, const char* label) const
{
    if (m_named_progress != nullptr)
        m_named_progress->progressStart(effect, label, kMessageId);
    else if (m_progress != nullptr)
        m_progress->progressStart(effect, label);
}

bool Host::progress(OfxImageEffectHandle effect, double share) const
{
    if (m_named_progress != nullptr)
        return m_named_progress->progressUpdate(effect, share) != kOfxStatReplyNo;
    return m_progress == nullptr || m_progress->progressUpdate(effect, share) != kOfxStatReplyNo;
}

void Host::end_progress(OfxImageEffectHandle effect) const
{
    if (m_named_progress != nullptr)
        m_named_progress->progressEnd(effect);
    else if (m_progress != nullptr)
        m_progress->progressEnd(effect);
}

}  // namespace pimg_ofx
