// SPDX-License-Identifier: BSD-3-Clause
#include "identity.h"

#include <cstring>

namespace pimg_ofx {

namespace {

/// What imagebufalgo.h says of a filter: it returns the source if `key` has that value and neither of `unless` is given.
struct Rule {
    const char *filter, *key, *value;
    const char* unless[2];
};
constexpr Rule kRules[] = {
    { "feature_lowpass", "strength", "0", { "", "" } },
    { "feature_lowpass", "noise", "0", { "", "" } },
    { "detail_enhance", "gain", "1", { "curve", "" } },
    { "paint", "opacity", "0", { "canvas", "style" } },
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
    const auto is_given = [&](const char* key) {
        return *key != '\0' && !instance.option(key, time).empty();
    };
    for (const Rule& rule : kRules)
        if (std::strcmp(filter.name, rule.filter) == 0 && instance.option(rule.key, time) == rule.value
            && !is_given(rule.unless[0]) && !is_given(rule.unless[1]))
            return true;
    return false;
}

}  // namespace pimg_ofx
