// SPDX-License-Identifier: BSD-3-Clause
// The test host itself: its suites, the bundle it has loaded, and the actions it sends.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "effect.h"

namespace test_host {

/// What kind of host to be.
struct HostOptions {
    std::set<std::string> without;  ///< suites that are missing
    std::vector<std::string> depths = { kOfxBitDepthByte, kOfxBitDepthShort, kOfxBitDepthFloat };
    std::string colour_style;  ///< in which it manages colours; "": it does not
    unsigned int threads = 2;  ///< that the multi-thread suite speaks of
};

/// One host for one bundle.
class Host {
public:
    explicit Host(const HostOptions& options = {});
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;
    ~Host();

    /// Loads the bundle, or the library in it, with RTLD_NOW and RTLD_LOCAL. False with a line in `error`.
    bool load(const std::string& bundle, std::string& error);

    const std::vector<OfxPlugin*>& plugins() const { return m_plugins; }
    OfxPlugin* find(const std::string& identifier, std::string& error) const;

    /// setHost, load, describe and describe in context. The first status that is neither OK nor the default.
    OfxStatus open(OfxPlugin& plugin, const std::string& context, Effect& descriptor);
    void close(OfxPlugin& plugin);

private:
    OfxHost m_host {};
    PropertySet m_properties;
    void* m_library = nullptr;
    std::vector<OfxPlugin*> m_plugins;
};

/// One render as a user asks for it.
struct RenderOptions {
    double time = 1.0;
    int tile = 0;  ///< side of tiles in pixels; 0: the whole picture at once
    int threads = 1;
    std::string field = kOfxImageFieldNone;
    double abort_after = -1.0;  ///< in milliseconds; -1: never
};

/// An instance that lives as long as this.
class Instance {
public:
    Instance(OfxPlugin& plugin, const Effect& descriptor, const std::string& context, const Footage* footage);
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;
    ~Instance();

    OfxStatus status() const { return m_status; }  ///< of its creation
    Effect& effect() { return m_effect; }

    /// Sends the actions a render consists of and adds the tiles to `picture`.
    OfxStatus render(const RenderOptions& options, OIIO::ImageBuf& picture);
    double render_seconds() const { return m_seconds; }               ///< of the render actions of the last render()
    double processor_seconds() const { return m_processor_seconds; }  ///< of the whole process meanwhile
    OfxStatus press(const std::string& button, double time);
    OfxStatus clip_preferences(const std::string& space);  ///< that clips get which ask for scene-linear ones
    OfxStatus output_colourspace(std::string& space);
    bool is_identity(double time);
    OfxStatus action(const char* name, PropertySet* in, PropertySet* out);

private:
    OfxStatus render_window(const RenderOptions& options, const OfxRectI& window, OIIO::ImageBuf& picture);
    OfxStatus regions(const RenderOptions& options, const OfxRectI& window);

    OfxPlugin& m_plugin;
    const Footage* m_footage;
    Effect m_effect;
    OfxStatus m_status = kOfxStatFailed;
    double m_seconds = 0.0, m_processor_seconds = 0.0;
    std::mutex m_mutex;
};

/// A suite of this host; null if it has none of that name and version.
const void* fetch_suite(OfxPropertySetHandle host, const char* name, int version);

/// Suites that fetch_suite() is to hide, and the number of processors it speaks of.
void set_up_suites(const HostOptions& options);

}  // namespace test_host
