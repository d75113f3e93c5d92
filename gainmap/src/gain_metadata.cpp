// SPDX-License-Identifier: BSD-3-Clause
#include "gain_metadata.h"

#include <cmath>

#include <pimg/detail/format.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// No display is 2^32 times as bright as SDR white; more in a file is damage.
constexpr double kMostStops = 32.0;

bool in_range(double number, double least, double most)
{
    return number >= least && number <= most;  // false for NaN
}

}  // namespace

bool check_gain_metadata(const GainMetadata& metadata, std::string& error)
{
    const auto fail = [&](const char* what, double number, const char* expected) {
        error = format("its gain map has the {} {}, expected {}", what, number, expected);
        return false;
    };
    for (const double headroom : { metadata.base_headroom, metadata.alternate_headroom })
        if (!in_range(headroom, 0.0, kMostStops))
            return fail("headroom", headroom, "0 to 32 stops");
    if (metadata.alternate_headroom <= metadata.base_headroom)
        return fail("headroom", metadata.alternate_headroom, "more than that of the base");
    for (const GainChannel& c : metadata.channel) {
        if (!in_range(c.min, -kMostStops, kMostStops))
            return fail("least gain", c.min, "-32 to 32 stops");
        if (!in_range(c.max, c.min, kMostStops))
            return fail("largest gain", c.max, "the least gain to 32 stops");
        if (!in_range(c.gamma, 0.01, 100.0))
            return fail("gamma", c.gamma, "0.01 to 100");
        for (const double offset : { c.base_offset, c.alternate_offset })
            if (!in_range(offset, -1.0, 1.0))
                return fail("offset", offset, "-1 to 1");
    }
    return true;
}

}  // namespace PIMG_ABI
}  // namespace pimg
