// SPDX-License-Identifier: BSD-3-Clause
#include "analysis.h"

#include <cmath>

#include <pimg/detail/format.h>
#include <pimg/imagebufalgo.h>

#include "colour_space.h"
#include "shot.h"

namespace pimg_ofx {

namespace {

using pimg::Anchors;
using pimg::HdrCompressOptions;

/// The most frames of a shot; pimgtool has the same limit.
constexpr int kMostFrames = 100000;

/// Reads the options of a frame and fills in everything that is found from its picture. `anew`: dmax, key and white are
/// found, too, even if they are given.
bool find(const Instance& instance, OfxTime time, bool anew, HdrCompressOptions& options, std::string& error)
{
    OfxRectD region {};
    const bool has_region = instance.source_region(time, region);
    const Image image(instance.host(), instance.source_clip(), time, has_region ? &region : nullptr);
    if (!image || is_empty(image.picture())) {
        error = pimg::format("the clip Source gave no image of a known kind at time {}", time);
        return false;
    }
    pimg::BuildOptions build;
    if (!source_space(instance, time, image.depth(), build.incolorspace, error)
        || !pimg::set_options(options, instance.options(Owner::filter, time), error))
        return false;
    if (anew)
        options.dmax = options.key = options.white = 0.0f;
    const int threads = instance.host().threads();
    return pimg::ImageBufAlgo::resolve_hdr_compress(picture_of(image, threads), options, error, build, threads);
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

bool measure(Instance& instance, int first, int last, pimg::Shot& shot, std::string& error)
{
    for (int frame = first; frame <= last; ++frame) {
        const Host& host = instance.host();
        if (host.is_aborted(instance.handle())
            || !host.progress(instance.handle(), double(frame - first) / double(last - first + 1))) {
            error.clear();
            return false;
        }
        HdrCompressOptions options;
        if (!find(instance, frame, true, options, error))
            return false;
        shot.add(frame, { options.dmax, options.key, options.white });
    }
    return true;
}

void set_keys(Instance& instance, int first, int last, const pimg::Shot& shot, const pimg::ShotOptions& options)
{
    const OfxParameterSuiteV1& suite = instance.host().parameters();
    const Edit edit(instance, "Analyse shot");
    for (const auto& [name, member] :
         { std::pair("dmax", &Anchors::dmax), { "key", &Anchors::key }, { "white", &Anchors::white } }) {
        const OfxParamHandle parameter = instance.parameter(name);
        if (parameter == nullptr)
            continue;
        suite.paramDeleteAllKeys(parameter);
        for (int frame = first; frame <= last; ++frame)
            suite.paramSetValueAtTime(parameter, OfxTime(frame), double(shot.anchors(frame, options).*member));
    }
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
    HdrCompressOptions options;
    if (!find(instance, time, false, options, error))
        return false;
    const Edit edit(instance, "Analyse frame");
    for (const std::string& key : instance.effect().found)
        if (const OfxParamHandle parameter = instance.parameter(kFoundPrefix + key))
            instance.host().parameters().paramSetValue(parameter, value_of(options, key));
    return true;
}

bool analyse_shot(Instance& instance, std::string& error)
{
    int first = 0, last = 0;
    pimg::ShotOptions options;
    if (!frames_of(instance, first, last, error)
        || !pimg::set_options(options, instance.options(Owner::shot, OfxTime(first)), error))
        return false;
    pimg::Shot shot;
    instance.host().begin_progress(instance.handle(), "Analysing the shot");
    const bool measured = measure(instance, first, last, shot, error);
    instance.host().end_progress(instance.handle());
    if (measured)
        set_keys(instance, first, last, shot, options);
    return measured;
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
