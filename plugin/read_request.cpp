// SPDX-License-Identifier: BSD-3-Clause
// A file can be read through every filter of the registry, filter_table().
#include "read_request.h"

#include <algorithm>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/colour.h>
#include <pimg/detail/format.h>
#include <pimg/display.h>
#include <pimg/labels.h>

#include "pimg_pvt.h"

namespace pimg {
namespace io {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using pimg::format;

bool has_key(const std::vector<std::string>& keys, const std::string& key)
{
    return std::find(keys.begin(), keys.end(), key) != keys.end();
}

template<class Options>
std::vector<std::string> keys_of()
{
    std::vector<std::string> keys;
    for (const Option<Options>& option : option_table<Options>())
        keys.emplace_back(option.rule.key);
    return keys;
}

/// As set_option(), but tells keys that are not in the table from values that are wrong.
template<class Options>
bool set_if_known(Options& options, const std::string& key, const std::string& value, bool& known, std::string& error)
{
    known = has_key(keys_of<Options>(), key);
    return !known || set_option(options, key, value, error);
}

bool parse_switch(const std::string& key, const std::string& value, bool& on, std::string& error)
{
    OptionValue parsed = false;
    if (!parse_option({ key.c_str(), 0, 0, "", "", "" }, value, parsed, error))
        return false;
    on = std::get<bool>(parsed);
    return true;
}

// ---- filters ----------------------------------------------------------------------------------------------------

/// Converts labels to floats of the same value. OpenImageIO would scale whole numbers to 0..1 when a reader is asked
/// for floats.
bool labels_to_float(ImageBuf& labels)
{
    ImageSpec spec = labels.spec();
    spec.set_format(OIIO::TypeFloat);
    ImageBuf result(spec);
    const bool fit = write_labels(result, result.roi(), static_cast<const Index*>(labels.localpixels()),
                                  std::size_t(spec.width), Index(spec.get_int_attribute(kLabelCount)));
    labels = std::move(result);
    return fit;
}

bool has_option(const Filter& filter, const std::string& key)
{
    const std::vector<OptionInfo> options = filter.options();
    return std::any_of(options.begin(), options.end(), [&](const OptionInfo& o) { return o.is_called(key); });
}

/// The filter a key belongs to; "" for none.
std::string owner_of(const std::string& key)
{
    for (const Filter& filter : filter_table())
        if (has_option(filter, key))
            return filter.name;
    return "";
}

std::string keys_of(const Filter& filter)
{
    std::vector<std::string> keys;
    for (const OptionInfo& option : filter.options())
        if (option.file != FileUse::written)
            keys.push_back(option.key);
    return OIIO::Strutil::join(keys, ", ");
}

std::string known_keys()
{
    std::string keys;
    for (const Filter& filter : filter_table())
        keys += format("{}={} ({}), ", filter.name, filter.bare.word, keys_of(filter));
    return keys + OIIO::Strutil::join(keys_of<BuildOptions>(), ", ") + ", "
        + OIIO::Strutil::join(keys_of<ReadOptions>(), ", ");
}

}  // namespace

// ---- the request ------------------------------------------------------------------------------------------------

std::string file_of(const std::string& name)
{
    const std::size_t query = name.find('?');
    return query == std::string::npos || OIIO::Filesystem::exists(name) ? name : name.substr(0, query);
}

bool ReadRequest::set(const std::string& key, const std::string& value, bool& known, std::string& error)
{
    known = m_filter != nullptr && has_option(*m_filter, key);
    if (known) {
        m_texts.emplace_back(key, value);
        return true;
    }
    if (!set_if_known<BuildOptions>(build, key, value, known, error))
        return false;
    if (known) {
        rebuild |= key != "incolorspace";
        return true;
    }
    return set_if_known<ReadOptions>(*this, key, value, known, error);
}

/// Takes the value given to a filter's own key: a word such as `on`, or what BareValue says. Without an error, false
/// turns the filter off.
bool ReadRequest::start(const Filter& filter, const std::string& value, std::string& error)
{
    const std::string key = filter.bare.key, share = filter.bare.share;
    const bool number = OIIO::Strutil::string_is_float(value);
    std::string not_a_switch;
    bool on = false;
    if (key.empty() || !number) {
        if (parse_switch(filter.name, value, on, not_a_switch) || key.empty()) {
            error = not_a_switch;
            return on;
        }
    }
    const bool below_one = number && OIIO::Strutil::stof(value) < 1.0f;
    m_texts.emplace_back(below_one && !share.empty() ? share : key, value);
    return true;
}

/// The one filter named, which takes its own key out of `keys`; level is meant where only its keys are given.
bool ReadRequest::choose_filter(Keys& keys, std::string& error)
{
    bool named = false;
    for (const Filter& filter : filter_table()) {
        const auto key = keys.find(filter.name);
        if (key == keys.end())
            continue;
        named = true;
        if (start(filter, key->second.value, error)) {
            if (m_filter)
                error = format("{} and {}: one filter can be read through at a time", m_filter->name, filter.name);
            m_filter = &filter;
        }
        if (!error.empty())
            return false;
        keys.erase(key);
    }
    if (!named)
        for (const std::string& key : keys_of<LevelOptions>())
            if (keys.count(key))
                m_filter = &filter_table().front();
    return true;
}

/// Checks the options of the filter as far as can be told without the picture.
bool ReadRequest::bind(std::string& error)
{
    if (m_filter == nullptr)
        return true;
    if (!m_filter->bind(m_texts, m_bound, error))
        return false;
    if (!m_bound.written.empty())  // opening a file to read must not write another
        error =
            format("{}: reading a picture cannot write a file; pimgtool {} can", m_bound.written, m_filter->command);
    return error.empty();
}

bool ReadRequest::parse(const std::string& name, const ImageSpec& config, std::string& error)
{
    Keys keys;
    for (const OIIO::ParamValue& hint : config.extra_attribs)
        if (OIIO::Strutil::istarts_with(hint.name(), "pimg:"))
            keys[OIIO::Strutil::lower(hint.name().substr(5))] = { hint_text(hint), false };
    const std::size_t file = file_of(name).size();
    OptionTexts query;
    if (!split_options(name.substr(std::min(file + 1, name.size())), query, error, '&'))
        return false;
    for (const auto& [key, value] : query)
        keys[key] = { value, true };
    if (!choose_filter(keys, error))
        return false;
    for (const auto& [key, given] : keys) {
        bool known = false;
        if (!set(key, given.value, known, error))
            return false;
        if (known || !given.in_query)
            continue;
        const std::string owner = owner_of(key);
        error = owner.empty() ? format("unknown key \"{}\": expected some of {}", key, known_keys())
                              : format("{} needs {}", key, owner);
        return false;
    }
    return bind(error);
}

/// The name of the result's only channel; null: the channels are those of the file.
const char* ReadRequest::only_channel() const
{
    return m_bound.output == FilterOutput::labels ? "label"
        : m_bound.output == FilterOutput::mask    ? "boundary"
        : m_bound.output == FilterOutput::gain    ? "gain"
                                                  : nullptr;
}

bool ReadRequest::change_spec(ImageSpec& spec, std::string& error) const
{
    if (!m_filter)
        return true;
    if (m_bound.output == FilterOutput::light) {
        Colour colour;
        if (!Colour::resolve(spec, build.incolorspace, build.layer, colour, error))
            return false;
        if (display)
            declare_space(spec, "sRGB");
        else
            colour.declare_linear(spec);
    }
    const char* channel = only_channel();
    if (channel != nullptr) {
        spec.nchannels = 1;
        spec.channelnames = { channel };
        spec.alpha_channel = spec.z_channel = -1;
    }
    if (m_bound.output != FilterOutput::picture) {
        spec.set_format(OIIO::TypeFloat);
        spec.channelformats.clear();
        spec.erase_attribute("oiio:BitsPerSample");
    }
    return true;
}

bool ReadRequest::run(ImageBuf& dst, const ProgressiveImage& src, int nthreads) const
{
    if (!m_bound(dst, src, {}, nthreads) || (m_bound.output == FilterOutput::labels && !labels_to_float(dst)))
        return false;
    if (m_bound.output == FilterOutput::light && display)
        dst = srgb_encoded(dst, nthreads, build.layer);
    return true;
}

}  // namespace io

template<>
const std::vector<Option<io::ReadOptions>>& option_table<io::ReadOptions>()
{
    using R = io::ReadOptions;
    static const std::vector<Option<R>> table = {
        { &R::mip, { "mip", 0, 0, "", "", "show MIP levels, in tiles, as textures have them" } },
        { &R::partial, { "partial", 0, 0, "", "", "show what there is of a file that was cut short" } },
        { &R::display, { "display", 0, 0, "", "", "encode the result of hdr_compress for displays (sRGB)" } },
    };
    return table;
}

}  // namespace pimg
