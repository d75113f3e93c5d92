// SPDX-License-Identifier: BSD-3-Clause
// Trials for a plug-in: many threads, and a host that does everything wrong.
#include <algorithm>
#include <cstdio>
#include <map>
#include <random>
#include <thread>

#include "commands.h"
#include "host.h"

namespace test_host {

namespace {

constexpr int kFrames = 20;  ///< different settings of each instance

/// A bundle with one instance of each of several effects.
struct Stage {
    Footage footage;
    std::unique_ptr<Host> host;
    std::vector<std::unique_ptr<Effect>> descriptors;
    std::vector<std::unique_ptr<Instance>> instances;
};

/// Parameters of filters with a range, at random within what their sliders offer; a key for each frame.
void set_random_keys(Effect& effect, std::mt19937& random)
{
    for (Parameter& parameter : effect.parameters.all) {
        const bool of_filter = parameter.properties.text(kOfxParamPropParent) == "group_filter";
        // Options that are unset by default stay so: some of them exclude each other.
        if (!of_filter || !parameter.is_real() || parameter.properties.real(kOfxParamPropDefault) < 0.0)
            continue;
        const double low = parameter.properties.real(kOfxParamPropDisplayMin),
                     high = parameter.properties.real(kOfxParamPropDisplayMax),
                     preset = parameter.properties.real(kOfxParamPropDefault);
        for (int frame = 1; frame <= kFrames; ++frame) {
            const double share = std::uniform_real_distribution<double>(0.0, 0.2)(random);
            const double end = random() % 2 == 0 ? low : high;
            parameter.keys[frame] = preset + share * (end - preset);
        }
    }
}

bool set_stage(const std::string& bundle, const Words& words, Stage& stage, std::string& error)
{
    for (const std::string& name : words.rest) {
        OIIO::ImageBuf frame(name);
        if (!frame.read(0, 0, true, OIIO::TypeDesc::FLOAT)) {
            error = frame.geterror();
            return false;
        }
        stage.footage.frames.push_back(frame);
    }
    HostOptions options;
    options.threads = unsigned(std::max(1, words.number("cpus", 2)));
    stage.host = std::make_unique<Host>(options);
    if (stage.footage.frames.empty() || !stage.host->load(bundle, error))
        return false;
    std::mt19937 random(1);
    const int wanted = words.number("instances", 4);
    const std::string effects = words.option("effects", "hdr_compress,detail_enhance,feature_lowpass,hdr_compress");
    std::size_t begin = 0;
    for (int i = 0; i < wanted; ++i) {
        const std::size_t end = effects.find(',', begin);
        OfxPlugin* plugin = stage.host->find(effects.substr(begin, end - begin), error);
        begin = end == effects.npos ? 0 : end + 1;
        if (plugin == nullptr)
            return false;
        stage.descriptors.push_back(std::make_unique<Effect>());
        if (stage.host->open(*plugin, kOfxImageEffectContextFilter, *stage.descriptors.back()) != kOfxStatOK) {
            error = "the effect cannot be described";
            return false;
        }
        stage.instances.push_back(std::make_unique<Instance>(*plugin, *stage.descriptors.back(),
                                                             kOfxImageEffectContextFilter, &stage.footage));
        set_random_keys(stage.instances.back()->effect(), random);
    }
    return true;
}

/// Whether two pictures are the same to the last bit.
bool same(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b)
{
    const auto* p = static_cast<const unsigned char*>(a.localpixels());
    const auto* q = static_cast<const unsigned char*>(b.localpixels());
    return std::equal(p, p + a.spec().image_bytes(), q);
}

/// Renders at random; what is rendered twice must be the same both times.
class Crowd {
public:
    explicit Crowd(Stage& stage) : m_stage(stage) { }

    void work(unsigned seed, int renders)
    {
        std::mt19937 random(seed);
        for (int i = 0; i < renders; ++i) {
            const std::size_t who = random() % m_stage.instances.size();
            RenderOptions options;
            options.time = 1.0 + double(random() % kFrames);
            options.tile = random() % 3 == 0 ? 40 + int(random() % 60) : 0;
            const OfxRectI box = m_stage.footage.pixels(options.time);
            OIIO::ImageBuf picture(OIIO::ImageSpec(box.x2 - box.x1, box.y2 - box.y1, 4, OIIO::TypeDesc::FLOAT));
            const OfxStatus status = m_stage.instances[who]->render(options, picture);
            const std::lock_guard<std::mutex> lock(m_mutex);
            if (status != kOfxStatOK)
                violation("a render returned " + std::to_string(status));
            const auto [place, is_new] = m_seen.emplace(std::pair(who, options.time), picture);
            if (!is_new && !same(place->second, picture))
                violation("the same render gave other pixels");
            if (random() % 40 == 0)
                m_stage.instances[who]->action(kOfxActionPurgeCaches, nullptr, nullptr);
        }
    }

    std::size_t different() const { return m_seen.size(); }

private:
    Stage& m_stage;
    std::mutex m_mutex;
    std::map<std::pair<std::size_t, double>, OIIO::ImageBuf> m_seen;
};

void expect(OfxStatus status, std::initializer_list<OfxStatus> allowed, const std::string& what)
{
    for (const OfxStatus one : allowed)
        if (status == one)
            return;
    violation(what + ": status " + std::to_string(status));
}

void without_suites(const std::string& bundle, const std::string& effect)
{
    const struct {
        const char* suite;
        bool needed;
    } suites[] = { { kOfxPropertySuite, true },     { kOfxImageEffectSuite, true }, { kOfxParameterSuite, true },
                   { kOfxMultiThreadSuite, false }, { kOfxMessageSuite, false },    { kOfxProgressSuite, false },
                   { kOfxMemorySuite, false } };
    for (const auto& [suite, needed] : suites) {
        HostOptions options;
        options.without = { suite };
        Host host(options);
        std::string error;
        if (!host.load(bundle, error))
            continue;
        OfxPlugin* plugin = host.find(effect, error);
        Effect descriptor;
        const OfxStatus status = host.open(*plugin, kOfxImageEffectContextFilter, descriptor);
        expect(status, { needed ? kOfxStatErrMissingHostFeature : kOfxStatOK }, std::string("without ") + suite);
        if (needed)
            expect(plugin->mainEntry(kOfxActionDescribe, descriptor.handle(), nullptr, nullptr),
                   { kOfxStatErrMissingHostFeature }, std::string("describe without ") + suite);
        host.close(*plugin);
    }
}

void wrong_handles(OfxPlugin& plugin)
{
    expect(plugin.mainEntry(nullptr, nullptr, nullptr, nullptr), { kOfxStatErrValue }, "no action");
    expect(plugin.mainEntry(kOfxActionDescribe, nullptr, nullptr, nullptr), { kOfxStatErrBadHandle }, "no descriptor");
    expect(plugin.mainEntry(kOfxImageEffectActionRender, nullptr, nullptr, nullptr), { kOfxStatErrBadHandle },
           "no instance");
}

void wrong_clips(OfxPlugin& plugin, const Effect& descriptor, Footage& footage)
{
    const std::string filter = kOfxImageEffectContextFilter;
    RenderOptions options;
    OIIO::ImageBuf picture(OIIO::ImageSpec(footage.frames[0].spec().width, footage.frames[0].spec().height, 4));
    Instance instance(plugin, descriptor, filter, &footage);
    expect(instance.status(), { kOfxStatOK }, "create");
    expect(instance.action("OfxActionOfAnotherAge", nullptr, nullptr), { kOfxStatReplyDefault }, "unknown action");
    HostImage output(footage, footage.pixels(1.0), footage.pixels(1.0));
    output_of_this_thread() = &output;
    expect(instance.action(kOfxImageEffectActionRender, nullptr, nullptr), { kOfxStatOK }, "render without arguments");
    output_of_this_thread() = nullptr;
    instance.effect().clips.at(kOfxImageEffectSimpleSourceClipName).footage = nullptr;
    expect(instance.render(options, picture), { kOfxStatFailed, kOfxStatOK }, "render without a source");
    if (instance.effect().message.empty())
        violation("no message says that the source is missing");
    Footage strange;
    strange.frames = footage.frames;
    strange.components = "OfxImageComponentOfAnotherAge";
    instance.effect().clips.at(kOfxImageEffectSimpleSourceClipName).footage = &strange;
    expect(instance.render(options, picture), { kOfxStatFailed }, "render of unknown components");
    instance.effect().clips.at(kOfxImageEffectSimpleSourceClipName).footage = &footage;
    Parameter* space = instance.effect().parameters.find("colour_space_name");
    instance.effect().parameters.find("colour_space")->set("named");
    space->set("no_such_space");
    expect(instance.render(options, picture), { kOfxStatFailed }, "render in an unknown colour space");
    space->set("");
    expect(instance.render(options, picture), { kOfxStatOK }, "render when all is well again");
    if (!instance.effect().message.empty())
        violation("the message has not been taken back");
}

}  // namespace

bool stress(const std::string& bundle, const Words& words, std::string& error)
{
    Stage stage;
    if (!set_stage(bundle, words, stage, error))
        return false;
    Crowd crowd(stage);
    const int renders = words.number("renders", 100);
    std::vector<std::thread> threads;
    for (int t = 0; t < words.number("threads", 8); ++t)
        threads.emplace_back([&crowd, t, renders] { crowd.work(unsigned(t) + 1, renders); });
    for (std::thread& thread : threads)
        thread.join();
    std::printf("%zu renders of %zu settings\n", threads.size() * std::size_t(renders), crowd.different());
    if (count_images_out() != 0)
        violation("images were not given back");
    return true;
}

bool misuse(const std::string& bundle, const Words& words, std::string& error)
{
    const std::string effect = words.option("effect", "hdr_compress");
    Footage footage;
    footage.frames.emplace_back(words.rest.empty() ? "" : words.rest[0]);
    if (!footage.frames[0].read(0, 0, true, OIIO::TypeDesc::FLOAT)) {
        error = footage.frames[0].geterror();
        return false;
    }
    without_suites(bundle, effect);
    Host host {};
    if (!host.load(bundle, error))
        return false;
    OfxPlugin* plugin = host.find(effect, error);
    Effect descriptor;
    if (plugin == nullptr || host.open(*plugin, kOfxImageEffectContextFilter, descriptor) != kOfxStatOK)
        return false;
    wrong_handles(*plugin);
    wrong_clips(*plugin, descriptor, footage);
    if (count_images_out() != 0)
        violation("images were not given back");
    host.close(*plugin);
    return true;
}

}  // namespace test_host
