// SPDX-License-Identifier: BSD-3-Clause
// The registry: every filter of imagebufalgo.h, by name, with its options as text. pimgtool, its manual and completion,
// the plugin, Python, C and GEGL all offer what is listed here, so that a new filter is one row in filter_table.cpp. A
// host finds here what it shows of a filter: ranges, units, defaults, choices and help (OptionInfo in options.h).
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

/// What the pixels of a filter's result are.
enum class FilterOutput {
    picture,    ///< a picture in the range of the source's samples
    unbounded,  ///< a picture whose samples may leave that range
    light,      ///< linear light, 1 is white; float
    labels,     ///< one channel of whole numbers from 0, not scaled to a range (labels.h)
    mask        ///< one channel, 0 or 1
};

/// A filter with its options, checked.
struct BoundFilter {
    std::function<bool(OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI roi, int nthreads)> run;
    FilterOutput output = FilterOutput::picture;
    std::string written;  ///< key of an option given that makes it write a file besides; empty: none

    bool operator()(OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI roi, int nthreads) const
    {
        return run(dst, src, roi, nthreads);
    }
};

/// What the value of a filter's own name means where a file is read through it, as in `a.pimg?level=200`.
struct BareValue {
    const char* word;   ///< "SPLITS"; "1" where it only says that the filter is wanted
    const char* key;    ///< the option it sets; "" for none. Words such as `on` set none, and the defaults hold
    const char* share;  ///< the option that numbers below 1 set instead; "" for the same
};

/// One row of the table.
struct Filter {
    const char* name;     ///< "hdr_compress"; "level" stands for level_image
    const char* command;  ///< of pimgtool: "--hdr-compress"
    const char* summary;  ///< one line, beginning with a small letter
    BareValue bare;
    FilterOutput output;  ///< with default options
    std::vector<OptionInfo> (*options)();
    /// Sets and checks options. False, with a one-line message, for any that is wrong.
    bool (*bind)(const OptionTexts& texts, BoundFilter& filter, std::string& error);
};

/// All filters. The first is `level`, whose options alone ask a reader for it.
const std::vector<Filter>& filter_table();

/// Null, with a one-line message that lists the names, if there is none. A dash may stand for an underscore.
const Filter* find_filter(std::string_view name, std::string& error);

/// Options of `T` from pairs of key and value.
template<class T>
bool set_options(T& options, const OptionTexts& texts, std::string& error)
{
    for (const auto& [key, value] : texts)
        if (!set_option(options, key, value, error))
            return false;
    return check_options(options, error);
}

}  // namespace pimg
