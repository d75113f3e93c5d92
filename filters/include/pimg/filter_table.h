// SPDX-License-Identifier: BSD-3-Clause
// The filters of imagebufalgo.h by name, with their options as text: for hosts that know a filter only when they run,
// such as Python, C and GEGL.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/options.h>
#include <pimg/progressive_image.h>

namespace pimg {

/// Options as given: pairs of key and value.
using OptionTexts = std::vector<std::pair<std::string, std::string>>;

/// A filter with its options, checked.
using BoundFilter = std::function<bool(OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI roi, int nthreads)>;

/// One row of the table.
struct Filter {
    const char* name;     ///< "hdr_compress"; "level" stands for level_image
    const char* summary;  ///< one line
    std::vector<OptionInfo> (*options)();
    /// Sets and checks options. False, with a one-line message, for any that is wrong.
    bool (*bind)(const OptionTexts& texts, BoundFilter& filter, std::string& error);
};

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

/// Splits "key=value:key=value". A value in double quotes may hold colons.
bool split_options(std::string_view text, OptionTexts& texts, std::string& error);

}  // namespace pimg
