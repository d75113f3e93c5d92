// SPDX-License-Identifier: BSD-3-Clause
// An effect is a filter of the registry: its names for hosts, and its parameters, made from the option tables.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <pimg/filter_table.h>
#include <pimg/options.h>

namespace pimg_ofx {

/// Which options struct a parameter belongs to.
enum class Owner { filter, build, shot };

/// One option as a parameter.
struct Parameter {
    pimg::OptionInfo option;
    Owner owner = Owner::filter;
    std::string name;                ///< unique in the effect: the key, with "build_" or "shot_" before those of others
    std::vector<std::string> words;  ///< of a choice, in order; the first may be kAutomatic, which stands for not given

    bool is_choice() const { return !words.empty(); }
    bool may_be_unset() const { return option.default_value.empty() && (is_number() || is_choice()); }
    bool is_number() const { return option.type == "int" || option.type == "float"; }
    double preset() const;        ///< default of a number; kUnset if there is none
    double preset_index() const;  ///< default of a choice
};

constexpr char kAutomatic[] = "automatic";

/// What a number is that is not given, as in the options structs.
constexpr double kUnset = -1.0;

// Parameters that come from no table.
constexpr char kColourSpace[] = "colour_space";
constexpr char kColourSpaceName[] = "colour_space_name";
constexpr char kAnalyseShot[] = "analyse_shot";
constexpr char kAnalyseFrame[] = "analyse_frame";
constexpr char kFoundPrefix[] = "found_";

/// A colour space to choose.
struct SpaceChoice {
    const char *word, *label;
    const char* space;  ///< for the option incolorspace; null: the host's word; "": the name in kColourSpaceName
};
const std::vector<SpaceChoice>& space_choices();

struct Effect {
    const pimg::Filter* filter = nullptr;
    std::string identifier;  ///< "org.pimg.hdr_compress"
    std::string label;       ///< "HDR Compress"
    std::vector<Parameter> parameters;
    std::vector<std::string> found;  ///< keys of options that are found from the picture if they are 0

    bool has_shots() const { return !found.empty(); }
};

/// One for each filter, in the order of the registry.
const std::vector<Effect>& effects();

}  // namespace pimg_ofx
