// SPDX-License-Identifier: BSD-3-Clause
#include "colour/colour_config.h"

#include <pimg/detail/colour_config.h>

#include <cstdlib>
#include <map>
#include <mutex>
#include <utility>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Configurations kept: those of $OCIO and of a few projects that a host has open.
constexpr std::size_t kMostKept = 8;

thread_local std::string config_of_scope;

}  // namespace

ColourConfigScope::ColourConfigScope(std::string config) : m_before(std::exchange(config_of_scope, std::move(config)))
{
}

ColourConfigScope::~ColourConfigScope()
{
    config_of_scope.swap(m_before);
}

OCIO_NAMESPACE::ConstConfigRcPtr current_colour_config()
{
    static std::mutex mutex;
    static std::map<std::string, OCIO_NAMESPACE::ConstConfigRcPtr> kept;
    const std::string name = name_of_colour_config();
    // Without this OpenColorIO would print that colour management is disabled.
    if (name.empty())
        return nullptr;
    std::lock_guard<std::mutex> lock(mutex);
    const auto found = kept.find(name);
    if (found != kept.end())
        return found->second;
    const OCIO_NAMESPACE::ConstConfigRcPtr config = OCIO_NAMESPACE::Config::CreateFromFile(name.c_str());
    if (kept.size() >= kMostKept)
        kept.clear();
    return kept.emplace(name, config).first->second;
}

std::string name_of_colour_config()
{
    const char* environment = std::getenv("OCIO");
    return !config_of_scope.empty() ? config_of_scope : environment != nullptr ? environment : "";
}

std::string source_of_colour_config()
{
    return config_of_scope.empty() ? "$OCIO" : config_of_scope;
}

}  // namespace PIMG_ABI
}  // namespace pimg
