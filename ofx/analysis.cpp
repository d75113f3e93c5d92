// SPDX-License-Identifier: BSD-3-Clause
#include "analysis.h"

#include <cmath>
#include <functional>
#include <set>

#include <pimg/detail/format.h>
#include <pimg/detail/stop.h>
#include <pimg/imagebufalgo.h>

#include "colour_space.h"
#include "shot.h"
#include "watch.h"

namespace pimg_ofx {

namespace {

using pimg::Anchors;
using pimg::HdrCompressOptions;

/// The most frames of a shot; pimgtool has the same limit.
constexpr int kMostFrames = 100000;

/// What is found in a frame.
struct Findings {
    HdrCompressOptions options;  ///< of the frame, with everything that was 0 written in
    float light = 0.0f;          ///< median luminance; 0: nothing is lit
};

/// Reads the options of a frame and fills in everything that is found from its picture. `anew`: dmax, key and white are
/// found, too, even if they are given. May throw pimg::Stopped in a StopScope.
bool find(const Instance& instance, OfxTime time, bool anew, Findings& found, std::string& error)
{
    OfxRectD region {};
    const bool has_region = instance.source_region(time, region);
    const Image image(instance.host(), instance.source_clip(), time, has_region ? &region : nullptr);
    if (!image || is_empty(image.picture())) {
        error = pimg::format("the clip Source gave no image of a known kind at time {}", time);
        return false;
    }
    pimg::BuildOptions build;
    HdrCompressOptions& options = found.options;
    if (!source_space(instance, time, image.depth(), build.incolorspace, error)
        || !pimg::set_options(options, instance.options(Owner::filter, time), error))
        return false;
    if (anew)
        options.dmax = options.key = options.white = 0.0f;
    const int threads = instance.host().threads();
    const OIIO::ImageBuf picture = picture_of(image, threads);
    return pimg::median_light(picture, build.incolorspace, found.light, error)
        && pimg::ImageBufAlgo::resolve_hdr_compress(picture, options, error, build, threads);
}

/// find() that ends with nothing in `error` when goes_on() returns false.
bool find_stoppably(const std::function<bool()>& goes_on, const Instance& instance, OfxTime time, bool anew,
                    Findings& found, std::string& error)
{
    bool stopped = !goes_on();
    bool fine = false;
    if (!stopped) {
        const pimg::StopScope scope(goes_on);
        try {
            fine = find(instance, time, anew, found, error);
        } catch (const pimg::Stopped&) {
        }
        stopped = scope.stopped();
    }
    if (stopped)
        error.clear();
    return fine && !stopped;
}

/// Everything that is set between these two is one step for the user to undo.
class Edit {
public:
    Edit(const Instance& instance, const char* label) : m_host(instance.host())
    {
        if (m_host.effects().getParamSet(instance.handle(), &m_set) == kOfxStatOK)
            m_host.parameters().paramEditBegin(m_set, label);
    }
    Edit(const Edit&) = delete;
    Edit& operator=(const Edit&) = delete;
    ~Edit()
    {
        if (m_set != nullptr)
            m_host.parameters().paramEditEnd(m_set);
    }

private:
    const Host& m_host;
    OfxParamSetHandle m_set = nullptr;
};

/// Numbers as double, of one option.
double value_of(const HdrCompressOptions& options, const std::string& key)
{
    for (const auto& option : pimg::option_table<HdrCompressOptions>())
        if (key == option.rule.key) {
            const pimg::OptionValue value = option.get(options);
            if (const float* number = std::get_if<float>(&value))
                return double(*number);
        }
    return 0.0;
}

/// The frames of the source clip, first and last.
bool frames_of(const Instance& instance, int& first, int& last, std::string& error)
{
    const Properties clip = instance.of_clip(instance.source_clip());
    const double from = clip.real(kOfxImageEffectPropFrameRange, 0, 1.0),
                 to = clip.real(kOfxImageEffectPropFrameRange, 1, 0.0);
    if (to < from || !(to - from < kMostFrames)) {
        error = pimg::format("the source has frames from {} to {}: expected at most {}", from, to, kMostFrames);
        return false;
    }
    first = int(std::ceil(from));
    last = int(std::floor(to));
    return true;
}

/// A shot as it was measured.
struct MeasuredShot {
    int first = 0, last = 0;
    pimg::Shot figures;
    std::set<int> dark;  ///< frames in which nothing is lit, and so nothing was measured
};

bool measure(Instance& instance, MeasuredShot& shot, std::string& error)
{
    Watch watch(instance, "Analysing the shot", true);
    for (int frame = shot.first; frame <= shot.last; ++frame) {
        const double done = double(frame - shot.first) / double(shot.last - shot.first + 1);
        Findings found;
        if (!find_stoppably([&] { return watch.goes_on(done); }, instance, frame, true, found, error))
            return false;
        pimg::Anchors anchors;
        if (found.light > 0.0f)
            anchors = { found.options.dmax, found.options.key, found.options.white, found.light };
        else
            shot.dark.insert(frame);
        shot.figures.add(frame, anchors);
    }
    return true;
}

void set_keys(Instance& instance, const MeasuredShot& shot, const pimg::ShotOptions& options)
{
    const OfxParameterSuiteV1& suite = instance.host().parameters();
    const Edit edit(instance, "Analyse shot");
    for (const auto& [name, member] :
         { std::pair("dmax", &Anchors::dmax), { "key", &Anchors::key }, { "white", &Anchors::white } }) {
        const OfxParamHandle parameter = instance.parameter(name);
        if (parameter == nullptr)
            continue;
        suite.paramDeleteAllKeys(parameter);
        for (int frame = shot.first; frame <= shot.last; ++frame)
            if (shot.dark.count(frame) == 0)
                suite.paramSetValueAtTime(parameter, OfxTime(frame),
                                          double(shot.figures.anchors(frame, options).*member));
    }
}

/// "3, 7-9": ascending numbers, those that follow each other as a range.
std::string ranges_of(const std::set<int>& numbers)
{
    std::string text;
    for (auto it = numbers.begin(); it != numbers.end();) {
        const int first = *it;
        int last = first;
        while (++it != numbers.end() && *it == last + 1)
            last = *it;
        text += text.empty() ? "" : ", ";
        text += last > first ? pimg::format("{}-{}", first, last) : pimg::format("{}", first);
    }
    return text;
}

}  // namespace

std::vector<std::string> found_keys()
{
    std::vector<std::string> keys;
    for (const pimg::OptionInfo& option : pimg::describe_options<HdrCompressOptions>())
        if (option.type == "float" && option.default_value == "0" && option.help.find("found") != std::string::npos)
            keys.push_back(option.key);
    return keys;
}

bool show_found(Instance& instance, OfxTime time, std::string& error)
{
    Watch watch(instance, "Analysing the frame");
    Findings found;
    if (!find_stoppably([&] { return watch.goes_on(); }, instance, time, false, found, error))
        return false;
    const Edit edit(instance, "Analyse frame");
    for (const std::string& key : instance.effect().found)
        if (const OfxParamHandle parameter = instance.parameter(kFoundPrefix + key))
            instance.host().parameters().paramSetValue(parameter, value_of(found.options, key));
    return true;
}

bool analyse_shot(Instance& instance, std::string& error)
{
    MeasuredShot shot;
    pimg::ShotOptions options;
    if (!frames_of(instance, shot.first, shot.last, error)
        || !pimg::set_options(options, instance.options(Owner::shot, OfxTime(shot.first)), error)
        || !pimg::Shot::check_cuts(options.cuts, error) || !measure(instance, shot, error))
        return false;
    if (int(shot.dark.size()) > shot.last - shot.first) {
        error = "nothing is lit in any frame of the source: nothing was measured";
        return false;
    }
    set_keys(instance, shot, options);
    if (!shot.dark.empty())
        instance.host().say(instance.handle(), kOfxMessageWarning,
                            pimg::format("Analyse shot: nothing is lit in frame{} {}: not measured, and without keys",
                                         shot.dark.size() > 1 ? "s" : "", ranges_of(shot.dark)));
    return true;
}

OfxStatus instance_changed(Instance& instance, const Properties& in)
{
    if (!instance.effect().has_shots() || in.text(kOfxPropType) != kOfxTypeParameter
        || in.text(kOfxPropChangeReason) != kOfxChangeUserEdited)
        return kOfxStatReplyDefault;
    const std::string name = in.text(kOfxPropName);
    const OfxTime time = in.real(kOfxPropTime);
    if (name != kAnalyseShot && name != kAnalyseFrame)
        return kOfxStatReplyDefault;
    std::string error;
    bool fine = name != kAnalyseShot || analyse_shot(instance, error);
    fine = fine && show_found(instance, time, error);
    if (fine || error.empty())
        return kOfxStatOK;
    instance.complain(error);
    return kOfxStatFailed;
}

}  // namespace pimg_ofx
