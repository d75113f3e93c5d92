// SPDX-License-Identifier: BSD-3-Clause
#include "base/curve_text.h"

#include <charconv>
#include <cmath>

#include <OpenImageIO/strutil.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

bool parse_number(std::string_view word, double& value)
{
    word = OIIO::Strutil::strip(word);
    if (word.size() > 1 && word[0] == '+' && word[1] != '-')
        word.remove_prefix(1);
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    return status == std::errc() && end == word.data() + word.size() && std::isfinite(value);
}

}  // namespace

bool parse_curve(std::string_view text, std::vector<CurvePoint>& points)
{
    points.clear();
    for (const std::string_view word : OIIO::Strutil::splitsv(text, ",")) {
        const std::size_t colon = word.find(':');
        CurvePoint point {};
        if (colon == word.npos || !parse_number(word.substr(0, colon), point.position)
            || !parse_number(word.substr(colon + 1), point.value))
            return false;
        points.push_back(point);
    }
    return !points.empty();
}

}  // namespace PIMG_ABI
}  // namespace pimg
