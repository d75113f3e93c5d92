// SPDX-License-Identifier: BSD-3-Clause
// Commands on channels and colour, spelt as oiiotool spells them.
#include <cstdlib>
#include <utility>

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

#include "command/rows.h"
#include "session/colour.h"

namespace pimg {

namespace {

/// The keys that all conversions have. T is ConversionOptions or a struct derived from it.
template<class T>
std::vector<Option<T>> conversion_table()
{
    return {
        { &T::key, { "key", 0, 0, "", "", "variables of the OpenColorIO context to set, with commas between them" } },
        { &T::value, { "value", 0, 0, "", "", "their values, with commas between them" } },
        { &T::unpremult,
          { "unpremult", 0, 0, "", "",
            "divide colours by alpha before the conversion, and multiply them again after it" } },
    };
}

}  // namespace

template<>
const std::vector<Option<pimgtool::ConversionOptions>>& option_table<pimgtool::ConversionOptions>()
{
    static const std::vector<Option<pimgtool::ConversionOptions>> table =
        conversion_table<pimgtool::ConversionOptions>();
    return table;
}

template<>
const std::vector<Option<pimgtool::DisplayOptions>>& option_table<pimgtool::DisplayOptions>()
{
    using T = pimgtool::DisplayOptions;
    static const std::vector<Option<T>> table = [] {
        std::vector<Option<T>> all = conversion_table<T>();
        all.insert(all.begin(),
                   { { &T::from, { "from", 0, 0, "", "", "colour space to convert from; empty: the picture's own" } },
                     { &T::looks, { "looks", 0, 0, "", "", "looks to apply instead of the view's own" } } });
        return all;
    }();
    return table;
}

}  // namespace pimg

namespace pimgtool {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using pimg::format;

/// Converts the colours of the top picture in floating point, so that nothing is rounded before the file is written.
/// OpenImageIO gets a picture of only colour and alpha, since version 2.4 also changes the channels that follow them.
bool convert_colours(Session& session, const OIIO::ColorProcessorHandle& processor, const std::string& space,
                     bool unpremult)
{
    const std::string layer = session.top().hierarchy->options.layer;
    const bool done = session.change_pixels([&](ImageBuf& dst, const ImageBuf& src) {
        if (!dst.copy(src, OIIO::TypeFloat))
            return false;
        declare_space(dst.specmod(), space);
        pimg::Colour colour;
        std::string error;
        if (!pimg::Colour::resolve(src.spec(), "", layer, colour, error)) {
            pimg::set_error(dst, error);
            return false;
        }
        std::vector<int> colours;
        colours.reserve(4);
        for (int i = 0; i < colour.count(); ++i)
            colours.push_back(colour.channel(i));
        if (colour.alpha() >= 0)
            colours.push_back(colour.alpha());
        ImageBuf some = OIIO::ImageBufAlgo::channels(dst, int(colours.size()), colours);
        some.specmod().alpha_channel = colour.alpha() >= 0 ? colour.count() : -1;
        ImageBuf converted = OIIO::ImageBufAlgo::colorconvert(some, processor.get(), unpremult);
        if (converted.has_error()) {
            pimg::set_error(dst, converted.geterror());
            return false;
        }
        // Not alpha, which OpenColorIO 2.5 moves by a rounding error.
        for (int i = 0; i < colour.count(); ++i) {
            const ImageBuf one = OIIO::ImageBufAlgo::channels(converted, 1, { i });
            if (!OIIO::ImageBufAlgo::paste(dst, dst.xbegin(), dst.ybegin(), dst.zbegin(), colour.channel(i), one))
                return false;
        }
        return true;
    });
    return done && session.for_parts([](Picture& picture) {
        picture.linear_light = false;  // converted as the user wants it
        return true;
    });
}

/// Finds the space of the top picture's colours. If no conversion has a name for it, the colours are made scene-linear.
bool take_space(Session& session, std::string& space)
{
    pimg::Colour colour;
    std::string error;
    const ImageSpec& spec = session.top().pixels->spec();
    if (!pimg::Colour::resolve(spec, "", session.top().hierarchy->options.layer, colour, error))
        return session.fail(error);
    space = convertible_space(colour);
    if (!colour.config_name().empty() || colour.count() < 3)
        return true;
    return session.change_pixels([&](ImageBuf& dst, const ImageBuf& src) {
        if (!dst.copy(src, OIIO::TypeFloat))
            return false;
        declare_space(dst.specmod(), space);
        std::vector<float> rgb;
        rgb.reserve(3 * dst.spec().image_pixels());
        for (ImageBuf::ConstIterator<float> pixel(dst); !pixel.done(); ++pixel)
            for (int i = 0; i < 3; ++i)
                rgb.push_back(pixel[colour.channel(i)]);
        const bool converted = colour.to_scene_linear(rgb.data(), rgb.size() / 3);
        const float* result = rgb.data();
        for (ImageBuf::Iterator<float> pixel(dst); converted && !pixel.done(); ++pixel)
            for (int i = 0; i < 3; ++i)
                pixel[colour.channel(i)] = *result++;
        return converted;
    });
}

bool check_colorconvert(const Words& words, const ConversionOptions& options, std::string& error)
{
    return bool(conversion(words[0], words[1], options, error));
}

bool colorconvert(Session& session, const Words& words, const ConversionOptions& options)
{
    std::string error;
    const OIIO::ColorProcessorHandle processor = conversion(words[0], words[1], options, error);
    return processor ? convert_colours(session, processor, words[1], options.unpremult) : session.fail(error);
}

bool check_tocolorspace(const Words& words, const ConversionOptions& options, std::string& error)
{
    return bool(conversion(scene_linear_space(), words[0], options, error));
}

bool tocolorspace(Session& session, const Words& words, const ConversionOptions& options)
{
    std::string space;
    return take_space(session, space) && colorconvert(session, { space, words[0] }, options);
}

bool check_ociodisplay(const Words& words, const DisplayOptions& options, std::string& error)
{
    std::string display = words[0], view = words[1];
    return find_display(display, view, options.from, error)
        && (options.from.empty() || is_known_space(options.from, error));
}

bool ociodisplay(Session& session, const Words& words, const DisplayOptions& options)
{
    std::string display = words[0], view = words[1], error;
    std::string from = options.from.empty() ? "" : own_name_of_space(options.from);
    if (from.empty() && !take_space(session, from))
        return false;
    OIIO::ColorProcessorHandle processor;
    if (find_display(display, view, from, error))
        processor = display_transform(display, view, from, options, error);
    return processor ? convert_colours(session, processor, display_space(display, view), options.unpremult)
                     : session.fail(error);
}

bool incolorspace(Session& session, const Words& words)
{
    const bool done = session.change_pixels([&](ImageBuf& dst, const ImageBuf& src) {
        if (!dst.copy(src))
            return false;
        declare_space(dst.specmod(), words[0]);
        return true;
    });
    return done && session.for_parts([](Picture& picture) {
        ImageSpec stored = picture.pixels->spec();
        stored.format = picture.stored.all;
        picture.linear_light = holds_linear_light(stored);
        return true;
    });
}

/// Division by alpha and back, in floating point.
template<bool (*Operation)(ImageBuf&, const ImageBuf&, OIIO::ROI, int)>
bool alpha_operation(Session& session, const Words&)
{
    const auto run = [](ImageBuf& dst, const ImageBuf& src) {
        ImageSpec spec = src.spec();
        spec.set_format(OIIO::TypeFloat);
        dst.reset(spec);
        return Operation(dst, src, {}, 0);
    };
    return session.change_pixels(run) && session.for_parts([](Picture& picture) {
        picture.is_straight = false;  // written as the user wants it
        return true;
    });
}

bool channels(Session& session, const Words& words)
{
    const ImageSpec& spec = session.top().pixels->spec();
    std::vector<int> order;
    for (const std::string& name : OIIO::Strutil::splits(words[0], ",")) {
        order.push_back(spec.channelindex(name));
        if (order.back() < 0)
            return session.fail(
                format("no channel \"{}\": expected some of {}", name, OIIO::Strutil::join(spec.channelnames, ", ")));
    }
    if (order.empty())
        return session.fail("\"\": expected names of channels, such as R,G,B");
    PixelTypes stored = session.top().stored;
    if (int(stored.per_channel.size()) == spec.nchannels) {
        const std::vector<OIIO::TypeDesc> before = std::exchange(stored.per_channel, {});
        for (const int c : order)
            stored.per_channel.push_back(before[std::size_t(c)]);
    }
    session.top().others.clear();  // the channels chosen are all of this part
    const bool done = session.change_pixels([&](ImageBuf& dst, const ImageBuf& src) {
        return OIIO::ImageBufAlgo::channels(dst, src, int(order.size()), order);
    });
    session.top().stored = stored;
    return done;
}

bool layer(Session& session, const Words& words)
{
    pimg::Colour colour;
    std::string error;
    if (!pimg::Colour::resolve(session.top().pixels->spec(), "", words[0], colour, error))
        return session.fail(error);
    auto hierarchy = std::make_shared<LazyHierarchy>();
    hierarchy->options = session.top().hierarchy->options;
    hierarchy->options.layer = words[0];
    session.top().hierarchy = hierarchy;
    session.top().rendition = {};  // of another layer
    return true;
}

bool colour_config_file(const Call& call, Program&, std::string& error)
{
    return use_colour_config(call.words[0], error);
}

bool context_variable(const Call& call, Program&, std::string& error)
{
    return set_context_variable(call.words[0], error);
}

}  // namespace

CommandGroup colour_group()
{
    namespace iba = OIIO::ImageBufAlgo;
    return {
        "Channels and colour",
        {
            worded("--ch", "NAMES", "keeps only the named channels, in this order: R,G,B", channels),
            worded("--layer", "NAME", "says which layer is the picture, which is filtered and written as PNG", layer),
            worded("--unpremult", "", "divides colours by alpha", alpha_operation<iba::unpremult>),
            worded("--premult", "", "multiplies colours by alpha", alpha_operation<iba::premult>),
            worded("--incolorspace", "SPACE", "sets the colour space that the top picture is taken to be in",
                   incolorspace),
            worded("--colorconvert", "FROM TO", "converts between colour spaces", colorconvert, check_colorconvert),
            worded("--tocolorspace", "SPACE", "converts from the picture's own colour space", tocolorspace,
                   check_tocolorspace),
            worded("--ociodisplay", "DISPLAY VIEW",
                   "applies OpenColorIO's display transform; either name may be \"default\"", ociodisplay,
                   check_ociodisplay),
            general_setting("--ocio", "CONFIG", "OpenColorIO configuration to use instead of $OCIO",
                            colour_config_file),
            general_setting("--colorconfig", "CONFIG", "the same, as oiiotool spells it", colour_config_file),
            general_setting("--ociokey", "KEY=VALUE", "sets a variable of the configuration's context",
                            context_variable),
        }
    };
}

}  // namespace pimgtool
