// SPDX-License-Identifier: BSD-3-Clause
// The two functions that a host looks for, and the actions that it sends. No exception leaves these functions.
#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <utility>

#include <pimg/detail/colour_config.h>
#include <pimg/version.h>

#include "analysis.h"
#include "cache.h"
#include "colour_space.h"
#include "describe.h"
#include "identity.h"
#include "render.h"

namespace pimg_ofx {

namespace {

/// A host tells effects apart by their entry points, so there is one for each filter that the registry may have.
constexpr std::size_t kMostEffects = 32;

Host& host_of(std::size_t index)
{
    static std::array<Host, kMostEffects> hosts;
    return hosts[index];
}

OfxStatus create_instance(const Host& host, const Effect& effect, OfxImageEffectHandle handle)
{
    auto* instance = new Instance(host, effect, handle);
    if (host.of_effect(handle).set(kOfxPropInstanceData, static_cast<void*>(instance)))
        return kOfxStatOK;
    delete instance;
    return kOfxStatErrBadHandle;
}

OfxStatus destroy_instance(const Host& host, OfxImageEffectHandle handle)
{
    delete instance_of(host, handle);
    host.of_effect(handle).set(kOfxPropInstanceData, static_cast<void*>(nullptr));
    return kOfxStatOK;
}

OfxStatus region_of_definition(const Instance& instance, const Properties& in, const Properties& out)
{
    OfxRectD region {};
    if (!instance.source_region(in.real(kOfxPropTime), region))
        return kOfxStatReplyDefault;
    return out.set(kOfxImageEffectPropRegionOfDefinition, region) ? kOfxStatOK : kOfxStatReplyDefault;
}

/// Every pixel depends on the whole source.
OfxStatus regions_of_interest(const Instance& instance, const Properties& in, const Properties& out)
{
    OfxRectD region {};
    if (!instance.source_region(in.real(kOfxPropTime), region))
        return kOfxStatReplyDefault;
    const std::string name = kClipRegionOfInterest + std::string(kOfxImageEffectSimpleSourceClipName);
    return out.set(name.c_str(), region) ? kOfxStatOK : kOfxStatReplyDefault;
}

/// The result is of the source's kind, and the same at all times if the source and the parameters are.
OfxStatus clip_preferences(const Instance& instance, const Properties& out)
{
    const Properties source = instance.of_clip(instance.source_clip());
    const auto same = [&](const std::string& name, const char* property) {
        const std::string value = source.text(property);
        return !value.empty() && value != kOfxImageComponentNone && out.set(name.c_str(), value);
    };
    bool changed = same(kClipComponents + std::string(kOfxImageEffectOutputClipName), kOfxImageEffectPropComponents);
    changed |= same(kOfxImageEffectPropPreMultiplication, kOfxImageEffectPropPreMultiplication);
    changed |= out.set(kOfxImageEffectFrameVarying, 0);
    changed |= prefer_spaces(instance, 0.0, out);
    return changed ? kOfxStatOK : kOfxStatReplyDefault;
}

OfxStatus identity(const Instance& instance, const Properties& in, const Properties& out)
{
    const OfxTime time = in.real(kOfxPropTime);
    if (!is_identity(instance, time) || !out.set(kOfxPropName, std::string(kOfxImageEffectSimpleSourceClipName)))
        return kOfxStatReplyDefault;
    out.set(kOfxPropTime, time);
    return kOfxStatOK;
}

/// Actions on an instance that has been created.
OfxStatus on_instance(const std::string& action, Instance& instance, const Properties& in, const Properties& out)
{
    const pimg::ColourConfigScope colours(host_config(instance));
    if (action == kOfxImageEffectActionRender)
        return render(instance, in);
    if (action == kOfxImageEffectActionIsIdentity)
        return identity(instance, in, out);
    if (action == kOfxImageEffectActionGetRegionOfDefinition)
        return region_of_definition(instance, in, out);
    if (action == kOfxImageEffectActionGetRegionsOfInterest)
        return regions_of_interest(instance, in, out);
    if (action == kOfxImageEffectActionGetClipPreferences)
        return clip_preferences(instance, out);
    if (action == kOfxImageEffectActionGetOutputColourspace)
        return output_space(instance, 0.0, out);
    if (action == kOfxActionInstanceChanged)
        return instance_changed(instance, in);
    if (action == kOfxImageEffectActionBeginSequenceRender || action == kOfxImageEffectActionEndSequenceRender)
        return kOfxStatOK;
    return kOfxStatReplyDefault;
}

OfxStatus on_effect(const std::string& action, std::size_t index, OfxImageEffectHandle handle, OfxPropertySetHandle in,
                    OfxPropertySetHandle out)
{
    Host& host = host_of(index);
    const Effect& effect = effects()[index];
    if (action == kOfxActionLoad)
        return host.fetch() ? kOfxStatOK : kOfxStatErrMissingHostFeature;
    if (action == kOfxActionUnload || action == kOfxActionPurgeCaches) {
        shared_cache().clear();
        return kOfxStatOK;
    }
    if (!host.is_ready())
        return kOfxStatErrMissingHostFeature;
    if (handle == nullptr)
        return kOfxStatErrBadHandle;
    if (action == kOfxActionDescribe)
        return describe(host, effect, handle);
    if (action == kOfxImageEffectActionDescribeInContext)
        return describe_in_context(host, effect, handle);
    if (action == kOfxActionCreateInstance)
        return create_instance(host, effect, handle);
    if (action == kOfxActionDestroyInstance)
        return destroy_instance(host, handle);
    Instance* instance = instance_of(host, handle);
    if (instance == nullptr)
        return kOfxStatErrBadHandle;
    return on_instance(action, *instance, host.properties(in), host.properties(out));
}

/// Reports what went wrong, if that is still possible.
OfxStatus failed(std::size_t index, const void* handle, const char* what)
{
    try {
        host_of(index).say(static_cast<OfxImageEffectHandle>(const_cast<void*>(handle)), kOfxMessageError, what);
    } catch (...) {
        return kOfxStatFailed;
    }
    return kOfxStatFailed;
}

template<std::size_t Index>
OfxStatus entry(const char* action, const void* handle, OfxPropertySetHandle in, OfxPropertySetHandle out)
{
    try {
        auto* effect = static_cast<OfxImageEffectHandle>(const_cast<void*>(handle));
        return action != nullptr ? on_effect(action, Index, effect, in, out) : kOfxStatErrValue;
    } catch (const std::bad_alloc&) {
        shared_cache().clear();
        return kOfxStatErrMemory;
    } catch (const std::exception& exception) {
        return failed(Index, handle, exception.what());
    } catch (...) {
        return failed(Index, handle, "unknown exception");
    }
}

template<std::size_t Index>
void set_host(OfxHost* host)
{
    host_of(Index).connect(host);
}

template<std::size_t... Indices>
std::array<OfxPlugin, sizeof...(Indices)> make_plugins(std::index_sequence<Indices...>)
{
    std::array<OfxPlugin, sizeof...(Indices)> plugins { { { kOfxImageEffectPluginApi, kOfxImageEffectPluginApiVersion,
                                                            "", PIMG_VERSION_MAJOR, PIMG_VERSION_MINOR,
                                                            set_host<Indices>, entry<Indices> }... } };
    for (std::size_t i = 0; i < std::min(plugins.size(), effects().size()); ++i)
        plugins[i].pluginIdentifier = effects()[i].identifier.c_str();
    return plugins;
}

int count_plugins()
{
    return int(std::min(kMostEffects, effects().size()));
}

}  // namespace

}  // namespace pimg_ofx

extern "C" {

// NOLINTBEGIN(readability-identifier-naming): the names are those of the interface
__attribute__((visibility("default"))) int OfxGetNumberOfPlugins(void)
{
    try {
        return pimg_ofx::count_plugins();
    } catch (...) {
        return 0;
    }
}

__attribute__((visibility("default"))) OfxPlugin* OfxGetPlugin(int nth)
{
    try {
        static auto plugins = pimg_ofx::make_plugins(std::make_index_sequence<pimg_ofx::kMostEffects>());
        return nth >= 0 && nth < pimg_ofx::count_plugins() ? &plugins[std::size_t(nth)] : nullptr;
    } catch (...) {
        return nullptr;
    }
}
// NOLINTEND(readability-identifier-naming)
}
