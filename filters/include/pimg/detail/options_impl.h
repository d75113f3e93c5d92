// SPDX-License-Identifier: BSD-3-Clause
// How the functions of options.h, which includes this header, do their work with one option after the other.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <pimg/options.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Parses `text` as the type that `value` holds, and checks it; see set_option().
PIMG_EXPORT bool parse_option(const OptionRule& rule, std::string_view text, OptionValue& value, std::string& error);

/// Checks a value against the range or the choices of its option.
PIMG_EXPORT bool check_option(const OptionRule& rule, const OptionValue& value, std::string& error);

/// Returns false if two of the given options set the same thing (OptionRule::sets).
PIMG_EXPORT bool check_alternatives(const std::vector<const OptionRule*>& given, std::string& error);

/// What OptionInfo says of one option.
PIMG_EXPORT OptionInfo describe_option(const OptionRule& rule, const OptionValue& default_value);

/// The message for a key that is not among the `known` ones.
PIMG_EXPORT std::string unknown_option(std::string_view key, const std::vector<std::string_view>& known);

template<class T>
bool set_option(T& options, std::string_view key, std::string_view value, std::string& error)
{
    std::vector<std::string_view> known;
    for (const Option<T>& option : option_table<T>()) {
        known.push_back(option.rule.key);
        if (key != option.rule.key && (key.empty() || key != option.rule.alias))
            continue;
        OptionValue parsed = option.get(options);
        if (!parse_option(option.rule, value, parsed, error))
            return false;
        option.set(options, parsed);
        return true;
    }
    error = unknown_option(key, known);
    return false;
}

template<class T>
bool check_options(const T& options, std::string& error)
{
    const T defaults;
    std::vector<const OptionRule*> given;
    for (const Option<T>& option : option_table<T>()) {
        const OptionValue value = option.get(options);
        if (value == option.get(defaults))
            continue;
        if (!check_option(option.rule, value, error))
            return false;
        given.push_back(&option.rule);
    }
    return check_alternatives(given, error);
}

template<class T>
bool same_options(const T& a, const T& b)
{
    for (const Option<T>& option : option_table<T>())
        if (option.get(a) != option.get(b))
            return false;
    return true;
}

template<class T>
std::vector<OptionInfo> describe_options()
{
    const T defaults;
    std::vector<OptionInfo> infos;
    for (const Option<T>& option : option_table<T>())
        infos.push_back(describe_option(option.rule, option.get(defaults)));
    return infos;
}

}  // namespace PIMG_ABI
}  // namespace pimg
