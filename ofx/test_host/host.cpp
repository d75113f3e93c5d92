// SPDX-License-Identifier: BSD-3-Clause
#include "host.h"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <thread>

#include <OpenImageIO/filesystem.h>

namespace test_host {

namespace {

using Text = std::string;

bool is_fine(OfxStatus status)
{
    return status == kOfxStatOK || status == kOfxStatReplyDefault;
}

template<class Function>
Function* symbol(void* library, const char* name)
{
    return reinterpret_cast<Function*>(dlsym(library, name));
}

std::vector<Value> as_values(const std::vector<std::string>& texts)
{
    return { texts.begin(), texts.end() };
}

}  // namespace

Host::Host(const HostOptions& options)
{
    set_up_suites(options);
    PropertySet& set = m_properties;
    set.define(kOfxPropType, 1, { Text(kOfxTypeImageEffectHost) })
        .define(kOfxPropName, 1, { Text("org.pimg.test_host") });
    set.define(kOfxPropLabel, 1, { Text("pimg test host") }).define(kOfxPropVersion, 0, { 1, 0 });
    set.define(kOfxPropVersionLabel, 1, { Text("1.0") }).define(kOfxPropAPIVersion, 0, { 1, 4 });
    for (const char* flag : { kOfxImageEffectHostPropIsBackground, kOfxImageEffectPropSupportsOverlays,
                              kOfxImageEffectPropSupportsMultipleClipDepths,
                              kOfxImageEffectPropSupportsMultipleClipPARs, kOfxImageEffectPropSetableFrameRate,
                              kOfxImageEffectPropSetableFielding, kOfxParamHostPropSupportsStringAnimation,
                              kOfxParamHostPropSupportsCustomAnimation, kOfxParamHostPropSupportsCustomInteract })
        set.define(flag, 1, { 0 });
    for (const char* flag : { kOfxImageEffectPropSupportsMultiResolution, kOfxImageEffectPropSupportsTiles,
                              kOfxImageEffectPropTemporalClipAccess, kOfxParamHostPropSupportsBooleanAnimation,
                              kOfxParamHostPropSupportsChoiceAnimation })
        set.define(flag, 1, { 1 });
    set.define_list(kOfxImageEffectPropSupportedPixelDepths, Text());
    set.set_values(kOfxImageEffectPropSupportedPixelDepths, as_values(options.depths));
    set.define(kOfxImageEffectPropSupportedComponents, 0,
               { Text(kOfxImageComponentRGBA), Text(kOfxImageComponentRGB), Text(kOfxImageComponentAlpha) });
    set.define(kOfxImageEffectPropSupportedContexts, 0,
               { Text(kOfxImageEffectContextFilter), Text(kOfxImageEffectContextGeneral) });
    set.define(kOfxParamHostPropMaxParameters, 1, { -1 }).define(kOfxParamHostPropMaxPages, 1, { -1 });
    set.define(kOfxParamHostPropPageRowColumnCount, 2, { 0, 0 });
    if (!options.colour_style.empty()) {
        set.define(kOfxImageEffectPropColourManagementStyle, 1, { options.colour_style });
        set.define(kOfxImageEffectPropColourManagementAvailableConfigs, 0, { Text(kOfxConfigIdentifier) });
    }
    m_host = { set.handle(), fetch_suite };
}

Host::~Host()
{
    if (m_library != nullptr)
        dlclose(m_library);
}

bool Host::load(const std::string& bundle, std::string& error)
{
    const std::string inside = bundle + "/Contents/Linux-x86-64/pimg.ofx";
    const std::string path = OIIO::Filesystem::exists(inside) ? inside : bundle;
    m_library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (m_library == nullptr) {
        error = dlerror();
        return false;
    }
    auto* count = symbol<int()>(m_library, "OfxGetNumberOfPlugins");
    auto* get = symbol<OfxPlugin*(int)>(m_library, "OfxGetPlugin");
    if (count == nullptr || get == nullptr) {
        error = path + " lacks OfxGetNumberOfPlugins or OfxGetPlugin";
        return false;
    }
    for (int i = 0; i < count(); ++i)
        m_plugins.push_back(get(i));
    if (get(-1) != nullptr || get(count()) != nullptr)
        violation("there is a plug-in whose number is out of range");
    return true;
}

OfxPlugin* Host::find(const std::string& identifier, std::string& error) const
{
    for (OfxPlugin* plugin : m_plugins)
        if (plugin->pluginIdentifier == identifier || plugin->pluginIdentifier == "org.pimg." + identifier)
            return plugin;
    error = "there is no effect " + identifier;
    return nullptr;
}

OfxStatus Host::open(OfxPlugin& plugin, const std::string& context, Effect& descriptor)
{
    plugin.setHost(&m_host);
    OfxStatus status = plugin.mainEntry(kOfxActionLoad, nullptr, nullptr, nullptr);
    if (!is_fine(status))
        return status;
    status = plugin.mainEntry(kOfxActionDescribe, descriptor.handle(), nullptr, nullptr);
    if (!is_fine(status))
        return status;
    PropertySet in;
    in.define(kOfxImageEffectPropContext, 1, { context });
    return plugin.mainEntry(kOfxImageEffectActionDescribeInContext, descriptor.handle(), in.handle(), nullptr);
}

void Host::close(OfxPlugin& plugin)
{
    plugin.mainEntry(kOfxActionUnload, nullptr, nullptr, nullptr);
}

Instance::Instance(OfxPlugin& plugin, const Effect& descriptor, const std::string& context, const Footage* footage)
    : m_plugin(plugin),
      m_footage(footage)
{
    m_effect.make_instance_of(descriptor, context, footage);
    m_status = action(kOfxActionCreateInstance, nullptr, nullptr);
}

Instance::~Instance()
{
    if (is_fine(m_status))
        action(kOfxActionDestroyInstance, nullptr, nullptr);
    if (m_effect.parameters.open_edits != 0)
        violation("an edit of parameters was not ended");
    if (m_effect.progress_open != 0)
        violation("a bar of progress was not closed");
}

OfxStatus Instance::action(const char* name, PropertySet* in, PropertySet* out)
{
    is_in_action() = true;
    const OfxStatus status = m_plugin.mainEntry(name, m_effect.handle(), in != nullptr ? in->handle() : nullptr,
                                                out != nullptr ? out->handle() : nullptr);
    is_in_action() = false;
    return status;
}

OfxStatus Instance::clip_preferences(const std::string& space)
{
    PropertySet out;
    for (const auto& [name, clip] : m_effect.clips) {
        out.define(kClipComponents + name, 1, { clip.properties.text(kOfxImageEffectPropComponents) });
        out.define("OfxImageClipPropDepth_" + name, 1, { clip.properties.text(kOfxImageEffectPropPixelDepth) });
        out.define("OfxImageClipPropPAR_" + name, 1, { 1.0 });
        out.define_list(kClipPreferredColourspaces + name, Text());
    }
    out.define(kOfxImageEffectPropFrameRate, 1, { 24.0 }).define(kOfxImageClipPropFieldOrder, 1, { Text() });
    out.define(kOfxImageEffectPropPreMultiplication, 1, { Text(kOfxImagePreMultiplied) });
    out.define(kOfxImageClipPropContinuousSamples, 1, { 0 }).define(kOfxImageEffectFrameVarying, 1, { 0 });
    const OfxStatus status = action(kOfxImageEffectActionGetClipPreferences, nullptr, &out);
    const Footage none;
    const std::string wanted = m_footage != nullptr ? m_footage->components : none.components;
    if (m_footage != nullptr && out.text(kClipComponents + std::string(kOfxImageEffectOutputClipName)) != wanted)
        violation("the output has other components than the source");
    for (auto& [name, clip] : m_effect.clips)
        if (out.text(kClipPreferredColourspaces + name) == kOfxColourspaceOfxSceneLinear
            || out.text(kClipPreferredColourspaces + name) == "scene_linear")
            clip.properties.set_values(kOfxImageClipPropColourspace, { space });
    return status;
}

OfxStatus Instance::output_colourspace(std::string& space)
{
    PropertySet in, out;
    in.define(kOfxImageClipPropPreferredColourspaces, 0, { Text("ACEScg") });
    out.define(kOfxImageClipPropColourspace, 1, { Text() });
    const OfxStatus status = action(kOfxImageEffectActionGetOutputColourspace, &in, &out);
    space = out.text(kOfxImageClipPropColourspace);
    return status;
}

bool Instance::is_identity(double time)
{
    PropertySet in, out;
    in.define(kOfxPropTime, 1, { time }).define(kOfxImageEffectPropFieldToRender, 1, { Text(kOfxImageFieldNone) });
    in.define(kOfxImageEffectPropRenderWindow, 4, { 0, 0, 1, 1 });
    in.define(kOfxImageEffectPropRenderScale, 2, { 1.0, 1.0 });
    out.define(kOfxPropName, 1, { Text() }).define(kOfxPropTime, 1, { time });
    return action(kOfxImageEffectActionIsIdentity, &in, &out) == kOfxStatOK
        && out.text(kOfxPropName) == kOfxImageEffectSimpleSourceClipName;
}

OfxStatus Instance::press(const std::string& button, double time)
{
    PropertySet bracket, in;
    bracket.define(kOfxPropChangeReason, 1, { Text(kOfxChangeUserEdited) });
    action(kOfxActionBeginInstanceChanged, &bracket, nullptr);
    in.define(kOfxPropType, 1, { Text(kOfxTypeParameter) }).define(kOfxPropName, 1, { button });
    in.define(kOfxPropChangeReason, 1, { Text(kOfxChangeUserEdited) }).define(kOfxPropTime, 1, { time });
    in.define(kOfxImageEffectPropRenderScale, 2, { 1.0, 1.0 });
    const OfxStatus status = action(kOfxActionInstanceChanged, &in, nullptr);
    action(kOfxActionEndInstanceChanged, &bracket, nullptr);
    return status;
}

/// Checks that the region of the output is that of the source, and that the effect asks for the whole source.
OfxStatus Instance::regions(const RenderOptions& options, const OfxRectI& window)
{
    const OfxRectI whole = m_footage->pixels(options.time);
    const double scale = m_footage->scale;
    PropertySet in, defined, wanted;
    in.define(kOfxPropTime, 1, { options.time }).define(kOfxImageEffectPropRenderScale, 2, { scale, scale });
    const double across = m_footage->aspect / scale;
    in.define(kOfxImageEffectPropRegionOfInterest, 4,
              { window.x1 * across, window.y1 / scale, window.x2 * across, window.y2 / scale });
    defined.define(kOfxImageEffectPropRegionOfDefinition, 4, { 0.0, 0.0, 0.0, 0.0 });
    const OfxStatus status = action(kOfxImageEffectActionGetRegionOfDefinition, &in, &defined);
    if (!is_fine(status))
        return status;
    if (status == kOfxStatOK
        && std::lround(defined.real(kOfxImageEffectPropRegionOfDefinition, 2) / across) != long(whole.x2))
        violation("the region of definition is not the source's");
    const std::string name = kClipRegionOfInterest + std::string(kOfxImageEffectSimpleSourceClipName);
    wanted.define(name, 4, { 0.0, 0.0, 0.0, 0.0 });
    const OfxStatus second = action(kOfxImageEffectActionGetRegionsOfInterest, &in, &wanted);
    if (m_effect.clips.at(kOfxImageEffectSimpleSourceClipName).footage == nullptr)
        return second;
    if (second != kOfxStatOK || std::lround(wanted.real(name, 2) / across) != long(whole.x2)
        || std::lround(wanted.real(name, 3) * scale) != long(whole.y2))
        violation("the whole source is not asked for");
    return second;
}

OfxStatus Instance::render_window(const RenderOptions& options, const OfxRectI& window, OIIO::ImageBuf& picture)
{
    const double scale = m_footage->scale;
    const OfxRectI whole = m_footage->pixels(options.time);
    HostImage output(*m_footage, window, whole);
    PropertySet in;
    in.define(kOfxPropTime, 1, { options.time }).define(kOfxImageEffectPropFieldToRender, 1, { options.field });
    in.define(kOfxImageEffectPropRenderWindow, 4, { window.x1, window.y1, window.x2, window.y2 });
    in.define(kOfxImageEffectPropRenderScale, 2, { scale, scale });
    in.define(kOfxImageEffectPropSequentialRenderStatus, 1, { 0 });
    in.define(kOfxImageEffectPropInteractiveRenderStatus, 1, { 0 });
    in.define(kOfxImageEffectPropRenderQualityDraft, 1, { 0 });
    output_of_this_thread() = &output;
    const std::clock_t clock = std::clock();
    const auto start = std::chrono::steady_clock::now();
    const OfxStatus status = action(kOfxImageEffectActionRender, &in, nullptr);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    output_of_this_thread() = nullptr;
    if (!output.is_intact())
        violation("a render wrote beyond the ends of rows");
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_seconds += taken.count();
    m_processor_seconds += double(std::clock() - clock) / CLOCKS_PER_SEC;
    if (status == kOfxStatOK)
        add_to_picture(output, picture, whole);
    return status;
}

OfxStatus Instance::render(const RenderOptions& options, OIIO::ImageBuf& picture)
{
    const OfxRectI whole = m_footage->pixels(options.time);
    const int step = options.tile > 0 ? options.tile : std::max(whole.x2 - whole.x1, whole.y2 - whole.y1);
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_seconds = m_processor_seconds = 0.0;
    }
    m_footage->image(options.time);
    std::vector<OfxRectI> windows;
    for (int y = whole.y1; y < whole.y2; y += step)
        for (int x = whole.x1; x < whole.x2; x += step)
            windows.push_back({ x, y, std::min(x + step, whole.x2), std::min(y + step, whole.y2) });
    PropertySet sequence;
    sequence.define(kOfxImageEffectPropFrameRange, 2, { options.time, options.time });
    sequence.define(kOfxImageEffectPropFrameStep, 1, { 1.0 }).define(kOfxPropIsInteractive, 1, { 0 });
    sequence.define(kOfxImageEffectPropRenderScale, 2, { m_footage->scale, m_footage->scale });
    OfxStatus status = regions(options, windows[0]);
    if (!is_fine(status) || !is_fine(status = action(kOfxImageEffectActionBeginSequenceRender, &sequence, nullptr)))
        return status;
    const auto wait = std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double, std::milli>(options.abort_after));
    m_effect.abort_at =
        options.abort_after < 0.0 ? 0 : (std::chrono::steady_clock::now().time_since_epoch() + wait).count();
    std::atomic<std::size_t> next { 0 };
    std::atomic<int> worst { kOfxStatOK };
    const auto work = [&] {
        for (std::size_t i; (i = next++) < windows.size();) {
            const OfxStatus one = render_window(options, windows[i], picture);
            if (one != kOfxStatOK)
                worst = one;
        }
    };
    std::vector<std::thread> threads;
    for (int t = 1; t < options.threads; ++t)
        threads.emplace_back(work);
    work();
    for (std::thread& thread : threads)
        thread.join();
    m_effect.abort_at = 0;
    action(kOfxImageEffectActionEndSequenceRender, &sequence, nullptr);
    return worst;
}

}  // namespace test_host
