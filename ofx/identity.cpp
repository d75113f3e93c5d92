// SPDX-License-Identifier: BSD-3-Clause
#include "identity.h"

#include <cstring>

namespace pimg_ofx {

namespace {

/// What imagebufalgo.h says of a filter: it returns the source if `key` has that value and `unless` is not given.
struct Rule {
    const char *filter, *key, *value, *unless;
};
constexpr Rule kRules[] = {
    { "feature_lowpass", "strength", "0", "" },
    { "feature_lowpass", "noise", "0", "" },
    { "detail_enhance", "gain", "1", "curve" },
    { "paint", "opacity", "0", "canvas" },
};

}  // namespace

bool is_identity(const Instance& instance, OfxTime time)
{
    const pimg::Filter& filter = *instance.effect().filter;
    // Options that contradict each other must be rendered, for the user to see the message.
    pimg::BoundFilter bound;
    std::string error;
    if (!filter.bind(instance.options(Owner::filter, time), bound, error))
        return false;
    for (const Rule& rule : kRules)
        if (std::strcmp(filter.name, rule.filter) == 0 && instance.option(rule.key, time) == rule.value
            && (*rule.unless == '\0' || instance.option(rule.unless, time).empty()))
            return true;
    return false;
}

}  // namespace pimg_ofx
