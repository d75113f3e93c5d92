// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "host.h"

namespace test_host {

namespace {

std::string text_of(const Value& value)
{
    if (const std::string* text = std::get_if<std::string>(&value))
        return "\"" + *text + "\"";
    char buffer[40] = "pointer";
    if (const int* number = std::get_if<int>(&value))
        std::snprintf(buffer, sizeof buffer, "%d", *number);
    else if (const double* real = std::get_if<double>(&value))
        std::snprintf(buffer, sizeof buffer, "%.9g", *real);
    return buffer;
}

void print(const PropertySet& set, const char* indent)
{
    for (const std::string& name : set.names()) {
        std::printf("%s%s:", indent, name.c_str());
        for (const Value& value : set.values(name))
            std::printf(" %s", text_of(value).c_str());
        std::printf("\n");
    }
}

std::string context_of(const Words& words)
{
    return words.option("context", "filter") == "general" ? kOfxImageEffectContextGeneral
                                                          : kOfxImageEffectContextFilter;
}

bool read_frames(const std::vector<std::string>& names, Footage& footage, std::string& error)
{
    for (const std::string& name : names) {
        OIIO::ImageBuf frame(name);
        if (!frame.read(0, 0, true, OIIO::TypeDesc::FLOAT)) {
            error = frame.geterror();
            return false;
        }
        footage.frames.push_back(frame);
    }
    return !names.empty();
}

Footage footage_of(const Words& words)
{
    Footage footage;
    footage.scale = std::atof(words.option("scale", "1").c_str());
    footage.left = words.number("left", 0);
    footage.bottom = words.number("bottom", 0);
    footage.aspect = std::atof(words.option("aspect", "1").c_str());
    footage.top_down = words.number("top-down", 0) != 0;
    footage.without_end = words.number("without-end", 0) != 0;
    const std::string depth = words.option("depth", "float"), components = words.option("components", "rgba");
    footage.depth = depth == "byte" ? kOfxBitDepthByte
        : depth == "short"          ? kOfxBitDepthShort
        : depth == "half"           ? kOfxBitDepthHalf
                                    : kOfxBitDepthFloat;
    footage.components = components == "rgb" ? kOfxImageComponentRGB
        : components == "alpha"              ? kOfxImageComponentAlpha
                                             : kOfxImageComponentRGBA;
    if (words.number("straight", 0) != 0)
        footage.premultiplication = kOfxImageUnPreMultiplied;
    if (words.option("field", "none") != "none")
        footage.field = kOfxImageFieldBoth;
    return footage;
}

HostOptions host_options_of(const Words& words, const Footage& footage)
{
    HostOptions options;
    options.depths = { footage.depth };
    if (!words.option("config").empty())
        options.colour_style = kOfxImageEffectColourManagementOCIO;
    else if (words.number("manages", 0) != 0)
        options.colour_style = kOfxImageEffectColourManagementFull;
    return options;
}

/// NAME=VALUE, NAME@TIME=VALUE
bool set_parameter(Effect& effect, const std::string& name, const std::string& value, std::string& error)
{
    const std::size_t at = name.find('@');
    const double time = at == name.npos ? 0.0 : std::atof(name.c_str() + at + 1);
    Parameter* parameter = effect.parameters.find(name.substr(0, at));
    if (parameter != nullptr && parameter->set(value, at == name.npos ? nullptr : &time))
        return true;
    error = "cannot set " + name + " to \"" + value + "\"";
    return false;
}

void print_parameters(const Effect& effect)
{
    for (const Parameter& parameter : effect.parameters.all) {
        std::printf("%s = %s", parameter.name.c_str(), text_of(parameter.value).c_str());
        for (const auto& [time, value] : parameter.keys)
            std::printf(" @%g:%s", time, text_of(value).c_str());
        std::printf("\n");
    }
}

/// A number between two others; a whole one if they are.
std::string between(const std::string& from, const std::string& to, double share)
{
    const double number = (1.0 - share) * std::atof(from.c_str()) + share * std::atof(to.c_str());
    const bool whole = to.find('.') == to.npos && std::atof(from.c_str()) == std::atoi(from.c_str());
    return whole ? std::to_string(std::lround(number)) : std::to_string(number);
}

/// A command that has an instance.
class Session {
public:
    Session(const std::string& bundle, const Words& words)
        : m_words(words),
          m_footage(footage_of(words)),
          m_host(host_options_of(words, m_footage)),
          m_bundle(bundle)
    {
    }

    bool open(std::string& error)
    {
        std::vector<std::string> names = m_words.rest;
        if (names.size() < 2) {
            error = "expected the name of an effect and of a picture";
            return false;
        }
        const std::string identifier = names[0];
        names.erase(names.begin());
        if (names.size() > 1) {
            m_target = names.back();
            names.pop_back();
        }
        if (!read_frames(names, m_footage, error) || !m_host.load(m_bundle, error))
            return false;
        OfxPlugin* plugin = m_host.find(identifier, error);
        if (plugin == nullptr)
            return false;
        const OfxStatus status = m_host.open(*plugin, context_of(m_words), m_descriptor);
        m_instance = std::make_unique<Instance>(*plugin, m_descriptor, context_of(m_words), &m_footage);
        if (status != kOfxStatOK || m_instance->status() != kOfxStatOK) {
            error = "the effect cannot be described or created";
            return false;
        }
        return true;
    }

    bool set_parameters(std::string& error, double share)
    {
        for (const auto& [name, value] : m_words.settings) {
            const std::size_t dots = value.find("..");
            std::string now = value;
            if (dots != value.npos)
                now = between(value, value.substr(dots + 2), share);
            if (!set_parameter(m_instance->effect(), name, now, error))
                return false;
        }
        return true;
    }

    bool prepare(std::string& error)
    {
        if (!set_parameters(error, 0.0))
            return false;
        const std::string config = m_words.option("config");
        const bool manages = !config.empty() || m_words.number("manages", 0) != 0;
        PropertySet& properties = m_instance->effect().properties;
        // What the effect knows is what the two agree on.
        if (!manages)
            properties.set_values(kOfxImageEffectPropColourManagementStyle,
                                  { std::string(kOfxImageEffectColourManagementNone) });
        else if (!config.empty())
            properties.set_values(kOfxImageEffectPropOCIOConfig, { config });
        m_instance->clip_preferences(m_words.option("space", "ACEScg"));
        if (manages) {
            std::printf("style: %s\n", properties.text(kOfxImageEffectPropColourManagementStyle).c_str());
            std::string space;
            const OfxStatus status = m_instance->output_colourspace(space);
            std::printf("output colourspace: %d %s\n", status, space.c_str());
        }
        const std::string button = m_words.option("press");
        if (!button.empty() && m_instance->press(button, time()) != kOfxStatOK) {
            error = "the effect reported no success of the button";
            return false;
        }
        if (m_words.number("show", 0) != 0)
            print_parameters(m_instance->effect());
        return true;
    }

    bool render_once(OIIO::ImageBuf& picture, std::string& error)
    {
        return render_once(picture, std::atof(m_words.option("abort", "-1").c_str()), error);
    }

    bool render_once(OIIO::ImageBuf& picture, double abort_after, std::string& error)
    {
        RenderOptions options;
        options.time = time();
        options.tile = m_words.number("tile", 0);
        options.threads = m_words.number("threads", 1);
        options.abort_after = abort_after;
        const std::string field = m_words.option("field", "none");
        options.field = field == "lower" ? kOfxImageFieldLower
            : field == "upper"           ? kOfxImageFieldUpper
                                         : kOfxImageFieldNone;
        const OfxStatus status = m_instance->render(options, picture);
        if (status != kOfxStatOK)
            error = "render returned " + std::to_string(status) + ": " + m_instance->effect().message;
        return status == kOfxStatOK;
    }

    OIIO::ImageBuf canvas() const
    {
        const OfxRectI box = m_footage.pixels(time());
        const int channels = m_footage.components == kOfxImageComponentRGBA ? 4
            : m_footage.components == kOfxImageComponentRGB                 ? 3
                                                                            : 1;
        return OIIO::ImageBuf(OIIO::ImageSpec(box.x2 - box.x1, box.y2 - box.y1, channels, OIIO::TypeDesc::FLOAT));
    }

    Instance& instance() { return *m_instance; }
    double time() const { return std::atof(m_words.option("time", "1").c_str()); }
    const std::string& target() const { return m_target; }

private:
    const Words& m_words;
    Footage m_footage;
    Host m_host;
    std::string m_bundle, m_target;
    Effect m_descriptor;
    std::unique_ptr<Instance> m_instance;
};

}  // namespace

std::string Words::option(const std::string& name, const std::string& otherwise) const
{
    for (const auto& [key, value] : options)
        if (key == name)
            return value;
    return otherwise;
}

int Words::number(const std::string& name, int otherwise) const
{
    const std::string text = option(name);
    return text.empty() ? otherwise : std::atoi(text.c_str());
}

bool list(const std::string& bundle, const Words&, std::string& error)
{
    Host host {};
    if (!host.load(bundle, error))
        return false;
    for (OfxPlugin* plugin : host.plugins()) {
        Effect descriptor;
        if (host.open(*plugin, kOfxImageEffectContextFilter, descriptor) != kOfxStatOK) {
            error = std::string("cannot describe ") + plugin->pluginIdentifier;
            return false;
        }
        std::printf("%s %u.%u %s\n", plugin->pluginIdentifier, plugin->pluginVersionMajor, plugin->pluginVersionMinor,
                    descriptor.properties.text(kOfxPropLabel).c_str());
        host.close(*plugin);
    }
    return true;
}

bool describe(const std::string& bundle, const Words& words, std::string& error)
{
    Host host(host_options_of(words, footage_of(words)));
    if (!host.load(bundle, error))
        return false;
    OfxPlugin* plugin = host.find(words.rest.empty() ? "" : words.rest[0], error);
    if (plugin == nullptr)
        return false;
    Effect descriptor;
    if (host.open(*plugin, context_of(words), descriptor) != kOfxStatOK) {
        error = "the effect cannot be described";
        return false;
    }
    print(descriptor.properties, "");
    for (const auto& [name, clip] : descriptor.clips) {
        std::printf("clip %s\n", name.c_str());
        print(clip.properties, "  ");
    }
    for (const Parameter& parameter : descriptor.parameters.all) {
        std::printf("parameter %s %s\n", parameter.name.c_str(), parameter.type.c_str());
        print(parameter.properties, "  ");
    }
    host.close(*plugin);
    return true;
}

bool render(const std::string& bundle, const Words& words, std::string& error)
{
    Session session(bundle, words);
    if (!session.open(error) || !session.prepare(error))
        return false;
    if (words.number("identity", 0) != 0) {
        std::printf("identity: %d\n", session.instance().is_identity(session.time()) ? 1 : 0);
        return true;
    }
    OIIO::ImageBuf picture = session.canvas();
    const int repeats = std::max(1, words.number("repeat", 1));
    for (int i = 0; i < repeats; ++i)
        if (!session.set_parameters(error, repeats > 1 ? double(i) / (repeats - 1) : 0.0)
            || !session.render_once(picture, error))
            return false;
        else
            std::printf("%.1f ms, %.1f of processors\n", 1000.0 * session.instance().render_seconds(),
                        1000.0 * session.instance().processor_seconds());
    if (count_images_out() != 0)
        violation("images were not given back");
    if (!session.target().empty() && !picture.write(session.target())) {
        error = picture.geterror();
        return false;
    }
    return true;
}

namespace {

/// Asks to stop at random moments of renders, and prints how long it took until they did.
bool stop_renders(Session& session, bool purges, int moments, bool verbose, std::string& error)
{
    OIIO::ImageBuf picture = session.canvas();
    const auto render = [&](double abort_after) {
        if (purges)
            session.instance().action(kOfxActionPurgeCaches, nullptr, nullptr);
        return session.render_once(picture, abort_after, error);
    };
    // From the cache: when all is in it.
    for (int i = purges ? 2 : 0; i < 3; ++i)
        if (!render(-1.0))
            return false;
    const double whole = 1000.0 * session.instance().render_seconds();
    std::mt19937 random(1);
    std::vector<double> taken;
    for (int i = 0; i < moments; ++i) {
        const double moment = std::uniform_real_distribution<double>(0.0, whole)(random);
        if (!render(moment))
            return false;
        taken.push_back(std::max(0.0, 1000.0 * session.instance().render_seconds() - moment));
        if (verbose)
            std::printf("%.1f: %.1f\n", moment, taken.back());
    }
    std::sort(taken.begin(), taken.end());
    const auto share = [&](double q) {
        return taken[std::size_t(q * double(taken.size() - 1))];
    };
    std::printf("%s: %.0f ms, stopped after %.1f ms (median), %.1f (9 of 10), %.1f (most)\n",
                purges ? "with a build" : "from the cache", whole, share(0.5), share(0.9), taken.back());
    return true;
}

}  // namespace

bool stops(const std::string& bundle, const Words& words, std::string& error)
{
    Session session(bundle, words);
    const int moments = std::max(1, words.number("moments", 30));
    const bool verbose = words.number("verbose", 0) != 0;
    return session.open(error) && session.prepare(error) && stop_renders(session, true, moments, verbose, error)
        && stop_renders(session, false, moments, verbose, error);
}

}  // namespace test_host
