// SPDX-License-Identifier: BSD-3-Clause
// The registry of filters: every filter of imagebufalgo.h, by name, with its options as text. pimgtool with its manual and
// completion, the plugin, Python, C and GEGL all offer what is listed here; so a new filter is one row in
// filter_table.cpp. A host finds here all it needs to show a filter: the ranges, units, defaults, choices and help texts
// of its options (OptionInfo in options.h).
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/option_text.h>
#include <pimg/options.h>
#include <pimg/progressive_image.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What kind of pixels the result of a filter has.
enum class FilterOutput {
    picture,    ///< a picture in the range of the source's samples
    unbounded,  ///< a picture whose samples may leave that range
    light,      ///< linear light as floats, 1 is white
    labels,     ///< one channel of whole numbers from 0 that are not scaled to any range (labels.h)
    mask,       ///< one channel, 0 or 1
    gain        ///< one channel: the base-2 logarithm of a factor, as float
};

/// A filter together with options that have been checked. It is called like the functions of imagebufalgo.h.
struct BoundFilter {
    std::function<bool(OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI roi, int nthreads)> run;
    FilterOutput output = FilterOutput::picture;
    std::string written;  ///< key of the option, among those given, that makes it also write a file; empty: none

    bool operator()(OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI roi, int nthreads) const
    {
        return run(dst, src, roi, nthreads);
    }
};

/// What a value means that is given to the name of a filter when a file is read through it, as in `a.pimg?level=200`.
struct BareValue {
    const char* word;   ///< how help texts show the value, like "SPLITS"; "1" if it only switches the filter on
    const char* key;    ///< the option it sets; "" for none. A word such as `on` sets no option
    const char* share;  ///< the option that a number below 1 sets instead; "" if it is the same
};

/// One filter.
struct Filter {
    const char* name;     ///< the function's name, like "hdr_compress"; "level" for level_image
    const char* command;  ///< the command of pimgtool, like "--hdr-compress"
    const char* summary;  ///< what it does, in one line that begins with a small letter
    BareValue bare;
    FilterOutput output;                   ///< what its result is with default options
    std::vector<OptionInfo> (*options)();  ///< all options of the filter
    /// Sets and checks options given as text. On failure returns false with one line in `error`.
    bool (*bind)(const OptionTexts& texts, BoundFilter& filter, std::string& error);
    const std::vector<Preset>& (
        *presets)();  ///< the values of options that are not given, by style; null: there are none
};

/// All filters. The first is `level`: a file is also read through it when only its options are given, without its name.
PIMG_EXPORT const std::vector<Filter>& filter_table();

/// The filter of that name, in which dashes may stand for underscores. If there is none, returns null with one line in
/// `error` that lists the names.
PIMG_EXPORT const Filter* find_filter(std::string_view name, std::string& error);

/// The name of a filter as menus show it: "HDR Compress" for "hdr_compress".
PIMG_EXPORT std::string title_of(const Filter& filter);

/// A key, a summary or a help text as it stands alone, with a capital letter and without underscores: "Jitter colour".
PIMG_EXPORT std::string label_of(std::string text);

/// Sets options of the struct `T` from pairs of key and value, and checks them. On failure returns false with one line in
/// `error`.
template<class T>
bool set_options(T& options, const OptionTexts& texts, std::string& error)
{
    for (const auto& [key, value] : texts)
        if (!set_option(options, key, value, error))
            return false;
    return check_options(options, error);
}

}  // namespace PIMG_ABI
}  // namespace pimg
