// SPDX-License-Identifier: BSD-3-Clause
// The table of filters a file can be read through is filters() below: to add one is to add a row.
#include "read_request.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/colour.h>
#include <pimg/detail/format.h>
#include <pimg/display.h>
#include <pimg/imagebufalgo.h>
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

/// set_option(), telling keys that are not in the table from bad values.
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

/// Whether a filter's result is a mask of one channel; its name, or "".
template<class Options>
const char* mask_name(const Options&)
{
    return "";
}
const char* partition_mask(const std::string& output)
{
    return output == "labels" ? "label" : output == "boundaries" ? "boundary" : "";
}
const char* mask_name(const SegmentOptions& options)
{
    return partition_mask(options.output);
}
const char* mask_name(const DualPiecesOptions& options)
{
    return partition_mask(options.output);
}

/// Opening a file to read must not write another.
template<class Options>
bool only_reads(const Options&, std::string&)
{
    return true;
}
bool only_reads(const SegmentOptions& options, std::string& error)
{
    error = options.stats.empty() ? "" : "stats: pimgtool --segment writes it, reading a file cannot";
    return error.empty();
}
bool only_reads(const PaintOptions& options, std::string& error)
{
    error = options.strokes.empty() ? "" : "strokes: pimgtool --paint writes them, reading a file cannot";
    return error.empty();
}

/// Readers are asked for floating-point numbers, which OpenImageIO would scale to 0..1: labels are made floats as they
/// are.
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

/// What the value given to a filter's own key does; false, without an error, when it turns the filter off.
template<class Options>
using Start = bool (*)(Options&, const std::string& key, const std::string& value, std::string& error);

template<class Options>
using Function = bool (*)(ImageBuf&, const ProgressiveImage&, const Options&, OIIO::ROI, int);

template<class Options>
class FilterOf final : public ReadFilter {
public:
    FilterOf(std::string key, Function<Options> function, Start<Options> first)
        : m_key(std::move(key)),
          m_function(function),
          m_start(first)
    {
    }
    bool set(const std::string& key, const std::string& value, bool& known, std::string& error) override
    {
        return set_if_known(m_options, key, value, known, error);
    }
    bool start(const std::string& value, std::string& error) override
    {
        return m_start(m_options, m_key, value, error) && error.empty();
    }
    bool check(std::string& error) const override
    {
        return check_options(m_options, error) && only_reads(m_options, error);
    }
    std::string mask() const override { return mask_name(m_options); }
    bool run(ImageBuf& dst, const ProgressiveImage& src, int nthreads) const override
    {
        return m_function(dst, src, m_options, {}, nthreads) && (mask() != "label" || labels_to_float(dst));
    }
    std::string keys() const override { return OIIO::Strutil::join(keys_of<Options>(), ", "); }

private:
    std::string m_key;
    Options m_options;
    Function<Options> m_function;
    Start<Options> m_start;
};

/// hdr_compress=1
template<class Options>
bool start_switched(Options&, const std::string& key, const std::string& value, std::string& error)
{
    bool on = false;
    return parse_switch(key, value, on, error) && on;
}

/// level=SPLITS
bool start_level(LevelOptions& options, const std::string&, const std::string& value, std::string& error)
{
    return value.empty() || set_option(options, "splits", value, error);
}

/// feature_lowpass=SPLITS, or a share of them below 1; feature_lowpass=on goes by strength or noise
bool start_lowpass(FeatureLowpassOptions& options, const std::string& key, const std::string& value, std::string& error)
{
    if (!value.empty() && !OIIO::Strutil::string_is_float(value))
        return start_switched(options, key, value, error);
    const bool share = OIIO::Strutil::string_is_float(value) && OIIO::Strutil::stof(value) < 1.0f;
    return set_option(options, share ? "fraction" : "splits", value, error);
}

/// detail_enhance=GAIN
bool start_enhance(DetailEnhanceOptions& options, const std::string&, const std::string& value, std::string& error)
{
    return set_option(options, "gain", value, error);
}

/// segment=REGIONS
bool start_segment(SegmentOptions& options, const std::string&, const std::string& value, std::string& error)
{
    return set_option(options, "regions", value, error);
}

struct FilterRow {
    const char* key;
    const char* value;  ///< what its value means, for messages and documentation
    std::shared_ptr<ReadFilter> (*make_called)(const char* key);
    std::shared_ptr<ReadFilter> make() const { return make_called(key); }
};

enum class Range { stored, any, light };

template<class Options, Function<Options> function, Start<Options> start, Range range>
FilterRow row(const char* key, const char* value)
{
    const auto make = [](const char* called) -> std::shared_ptr<ReadFilter> {
        auto filter = std::make_shared<FilterOf<Options>>(called, function, start);
        filter->floating = range != Range::stored;
        filter->light = range == Range::light;
        return filter;
    };
    return { key, value, make };
}

const std::vector<FilterRow>& filters()
{
    namespace iba = ImageBufAlgo;
    static const std::vector<FilterRow> rows = {
        row<LevelOptions, iba::level_image, start_level, Range::stored>("level", "SPLITS"),
        row<WireframeOptions, iba::wireframe, start_switched, Range::stored>("wireframe", "1"),
        row<DualPiecesOptions, iba::dual_pieces, start_switched, Range::stored>("dual_pieces", "1"),
        row<FeatureLowpassOptions, iba::feature_lowpass, start_lowpass, Range::stored>("feature_lowpass", "SPLITS"),
        row<DetailEnhanceOptions, iba::detail_enhance, start_enhance, Range::any>("detail_enhance", "GAIN"),
        row<HdrCompressOptions, iba::hdr_compress, start_switched, Range::light>("hdr_compress", "1"),
        row<SegmentOptions, iba::segment, start_segment, Range::stored>("segment", "REGIONS"),
        row<PaintOptions, iba::paint, start_switched, Range::stored>("paint", "1"),
        row<MosaicOptions, iba::mosaic, start_switched, Range::stored>("mosaic", "1"),
    };
    return rows;
}

/// The filter a key belongs to; "" for none.
std::string owner_of(const std::string& key)
{
    for (const FilterRow& row : filters())
        if (has_key(OIIO::Strutil::splits(row.make()->keys(), ", "), key))
            return row.key;
    return "";
}

std::string known_keys()
{
    std::string keys;
    for (const FilterRow& row : filters())
        keys += format("{}={} ({}), ", row.key, row.value, row.make()->keys());
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
    if (m_filter && (!m_filter->set(key, value, known, error) || known))
        return error.empty();
    if (!set_if_known<BuildOptions>(build, key, value, known, error))
        return false;
    if (known) {
        rebuild |= key != "incolorspace";
        return true;
    }
    return set_if_known<ReadOptions>(*this, key, value, known, error);
}

/// The one filter named, which takes its own key out of `keys`; level is meant where only its keys are given.
bool ReadRequest::choose_filter(Keys& keys, std::string& error)
{
    std::string chosen;
    const auto choose = [&](const FilterRow& row, const std::string& value) {
        const std::shared_ptr<ReadFilter> filter = row.make();
        if (!filter->start(value, error))
            return error.empty();
        if (m_filter)
            error = format("{} and {}: one filter can be read through at a time", chosen, row.key);
        m_filter = filter;
        chosen = row.key;
        return error.empty();
    };
    bool named = false;
    for (const FilterRow& row : filters()) {
        const auto key = keys.find(row.key);
        if (key == keys.end())
            continue;
        named = true;
        if (!choose(row, key->second.value))
            return false;
        keys.erase(key);
    }
    if (!named)
        for (const std::string& key : keys_of<LevelOptions>())
            if (keys.count(key))
                return choose(filters()[0], "");
    return true;
}

bool ReadRequest::parse(const std::string& name, const ImageSpec& config, std::string& error)
{
    Keys keys;
    for (const OIIO::ParamValue& hint : config.extra_attribs)
        if (OIIO::Strutil::istarts_with(hint.name(), "pimg:"))
            keys[OIIO::Strutil::lower(hint.name().substr(5))] = { hint_text(hint), false };
    const std::size_t file = file_of(name).size();
    for (const std::string& pair : OIIO::Strutil::splits(name.substr(std::min(file + 1, name.size())), "&")) {
        const std::size_t equals = pair.find('=');
        if (equals == std::string::npos || equals == 0) {
            error = format("\"{}\": expected key=value", pair);
            return false;
        }
        keys[pair.substr(0, equals)] = { pair.substr(equals + 1), true };
    }
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
    return !m_filter || m_filter->check(error);
}

bool ReadRequest::change_spec(ImageSpec& spec, std::string& error) const
{
    if (!m_filter)
        return true;
    if (m_filter->light) {
        Colour colour;
        if (!Colour::resolve(spec, build.incolorspace, colour, error))
            return false;
        if (display)
            declare_space(spec, "sRGB");
        else
            colour.declare_linear(spec);
    }
    const std::string mask = m_filter->mask();
    if (!mask.empty()) {
        spec.nchannels = 1;
        spec.channelnames = { mask };
        spec.alpha_channel = spec.z_channel = -1;
    }
    if (m_filter->floating || !mask.empty()) {
        spec.set_format(OIIO::TypeFloat);
        spec.channelformats.clear();
        spec.erase_attribute("oiio:BitsPerSample");
    }
    return true;
}

bool ReadRequest::run(ImageBuf& dst, const ProgressiveImage& src, int nthreads) const
{
    if (!m_filter->run(dst, src, nthreads))
        return false;
    if (m_filter->light && display)
        dst = srgb_encoded(dst, nthreads);
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
