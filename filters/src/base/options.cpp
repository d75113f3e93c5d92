// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/options.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <system_error>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr double kAnyInt = std::numeric_limits<int>::max();
constexpr double kAnyFloat = 3.4e38;  ///< the largest float, to two digits

std::string quoted(std::string_view text)
{
    return "\"" + std::string(text) + "\"";
}

/// Shortest text that reads back as the same float.
std::string to_text(double number)
{
    char buffer[32];
    if (number == std::floor(number) && std::fabs(number) < 1e9)
        std::snprintf(buffer, sizeof buffer, "%.0f", number);
    else
        for (int digits = 3; digits <= 9; ++digits) {
            std::snprintf(buffer, sizeof buffer, "%.*g", digits, number);
            float back = 0.0f;
            std::from_chars(buffer, buffer + sizeof buffer, back);
            if (back == float(number))
                break;
        }
    return buffer;
}

std::string to_text(const OptionValue& value)
{
    if (const bool* flag = std::get_if<bool>(&value))
        return *flag ? "1" : "0";
    if (const int* number = std::get_if<int>(&value))
        return std::to_string(*number);
    if (const float* number = std::get_if<float>(&value))
        return to_text(double(*number));
    return std::get<std::string>(value);
}

std::string range_text(const OptionRule& rule)
{
    if (rule.min == rule.max)
        return "";
    const bool open = rule.max >= kAnyInt;
    return open ? to_text(rule.min) + " or more" : to_text(rule.min) + " to " + to_text(rule.max);
}

std::string expected(const OptionRule& rule, const OptionValue& type)
{
    if (*rule.choices != '\0') {
        std::string words = rule.choices;
        for (std::size_t at; (at = words.find('|')) != std::string::npos;)
            words.replace(at, 1, ", ");
        return "one of " + words;
    }
    if (std::holds_alternative<bool>(type))
        return "1 or 0, true or false";
    if (std::holds_alternative<std::string>(type))
        return "text";
    const std::string kind = std::holds_alternative<int>(type) ? "a whole number" : "a number";
    return rule.min == rule.max ? kind : kind + ", " + range_text(rule);
}

bool fail(const OptionRule& rule, std::string_view text, const OptionValue& type, std::string& error)
{
    error = std::string(rule.key) + "=" + quoted(text) + ": expected " + expected(rule, type);
    return false;
}

/// Whole text as a finite number, whatever the locale; "+1", "1.0" and "1e3" are fine.
bool to_number(std::string_view text, double& number)
{
    if (text.size() > 1 && text[0] == '+' && text[1] != '-')
        text.remove_prefix(1);
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
    return status == std::errc() && end == text.data() + text.size() && std::isfinite(number);
}

bool to_flag(std::string_view text, bool& flag)
{
    for (const char* word : { "1", "true", "on", "yes" })
        if (text == word)
            return flag = true;
    flag = false;
    return text == "0" || text == "false" || text == "off" || text == "no";
}

bool is_choice(std::string_view choices, std::string_view word)
{
    while (!choices.empty()) {
        const std::size_t bar = choices.find('|');
        if (choices.substr(0, bar) == word)
            return true;
        choices.remove_prefix(bar == choices.npos ? choices.size() : bar + 1);
    }
    return false;
}

}  // namespace

bool check_option(const OptionRule& rule, const OptionValue& value, std::string& error)
{
    bool fine = true;
    double number = rule.min;
    if (const int* whole = std::get_if<int>(&value))
        number = *whole;
    else if (const float* real = std::get_if<float>(&value))
        number = double(*real);
    else if (const std::string* word = std::get_if<std::string>(&value))
        fine = *rule.choices == '\0' || is_choice(rule.choices, *word);
    if (rule.min == rule.max)
        fine = fine && std::isfinite(number);
    else
        fine = fine && number >= double(float(rule.min)) && number <= double(float(rule.max));  // false for NaN
    return fine || fail(rule, to_text(value), value, error);
}

bool check_alternatives(const std::vector<const OptionRule*>& given, std::string& error)
{
    for (const OptionRule* rule : given)
        for (const OptionRule* other : given)
            if (rule != other && *rule->sets != '\0' && std::string_view(rule->sets) == other->sets) {
                error = std::string(rule->key) + " and " + other->key + " both set the " + rule->sets
                    + ": expected only one of them";
                return false;
            }
    return true;
}

bool parse_option(const OptionRule& rule, std::string_view text, OptionValue& value, std::string& error)
{
    const OptionValue type = value;
    double number = 0.0;
    bool flag = false;
    if (text.find('\0') != text.npos) {  // the name of a file would end there
        error = std::string(rule.key) + ": expected text without a zero character";
        return false;
    }
    if (std::holds_alternative<std::string>(type))
        value = std::string(text);
    else if (std::holds_alternative<bool>(type) && to_flag(text, flag))
        value = flag;
    else if (std::holds_alternative<float>(type) && to_number(text, number) && std::fabs(number) <= kAnyFloat)
        value = float(number);
    else if (std::holds_alternative<int>(type) && to_number(text, number) && number == std::floor(number)
             && std::fabs(number) <= kAnyInt)
        value = int(number);
    else
        return fail(rule, text, type, error);
    return check_option(rule, value, error) || fail(rule, text, type, error);
}

OptionInfo describe_option(const OptionRule& rule, const OptionValue& default_value)
{
    static const char* const types[] = { "flag", "int", "float", "string" };
    OptionInfo info;
    info.key = rule.key;
    info.type = types[default_value.index()];
    info.unit = rule.unit;
    info.range = range_text(rule);
    info.choices = rule.choices;
    info.default_value = to_text(default_value);
    if (rule.min > double(-1) && rule.min != rule.max && info.default_value == "-1")
        info.default_value.clear();  // -1 stands for "not set"
    info.help = rule.help;
    info.min = rule.min;
    info.max = rule.max;
    info.alias = rule.alias;
    info.file = rule.file;
    return info;
}

std::string unknown_option(std::string_view key, const std::vector<std::string_view>& known)
{
    std::string message = "unknown option " + quoted(key) + ": expected ";
    for (std::size_t i = 0; i < known.size(); ++i)
        message += (i == 0 ? "" : i + 1 == known.size() ? " or " : ", ") + std::string(known[i]);
    return known.empty() ? "unknown option " + quoted(key) + ": expected none" : message;
}

// ---- the tables -------------------------------------------------------------------------------------------
// key, min, max, unit, choices, help; a range of 0, 0 stands for any number.

template<>
const std::vector<Option<BuildOptions>>& option_table<BuildOptions>()
{
    using T = BuildOptions;
    static const std::vector<Option<T>> table = {
        { &T::guide,
          { "guide", 0, 0, "", "luma|log|rgb|lab", "what decides the mesh; log for half/float pictures, else luma" } },
        { &T::weights,
          { "weights", 0, 0, "", "", "factors on the errors of the guide's channels, such as 1,0.5,0.5; else 1" } },
        { &T::base, { "base", 2, kAnyInt, "faces", "", "triangles of the base mesh, the coarsest level" } },
        { &T::metric,
          { "metric", 0, 0, "", "volume|quadric|exact",
            "cost of a collapse; quadric and exact are slow, for comparison" } },
        { &T::incolorspace,
          { "incolorspace", 0, 0, "", "",
            "colour space; else that of the metadata; else floats linear, others sRGB" } },
        { &T::layer,
          { "layer", 0, 0, "", "", "layer that is the picture; else R,G,B, or the beauty, or the only layer" } },
        { &T::wrap,
          { "wrap", 0, 0, "", "none|x|xy",
            "sides that meet: x, a lat-long panorama; xy, a tile; else as metadata say" } },
        { &T::mesh,
          { "mesh", 0, 0, "", "auto|full|adaptive",
            "auto: full, but quick about the finest; adaptive: fewer vertices" } },
        { &T::density, { "density", 1e-6, 1, "", "", "share of the pixels that are vertices of an adaptive mesh" } },
        { &T::control,
          { "control", 0, 0, "", "", "what density follows: gradient, curvature, or an image's brightness", "", "",
            FileUse::read } },
        { &T::preview, { "preview", 0, 1, "", "", "for a quick look at hdr_compress, builds from a reduced picture" } },
    };
    return table;
}

namespace {

/// Adds the strength options of T, a struct derived from StrengthOptions.
template<class T>
void add_strength_options(std::vector<Option<T>>& table)
{
    table.push_back({ &T::strength,
                      { "strength", 0, kAnyFloat, "", "",
                        "contrast that is smoothed away, in the picture's units; with log in stops", "cut-off" } });
    table.push_back(
        { &T::noise,
          { "noise", 0, kAnyFloat, "", "", "instead of strength: a multiple of the estimated noise", "cut-off" } });
    table.push_back(
        { &T::log, { "log", 0, 0, "", "", "work on the channels' logarithms: for scene-referred pictures" } });
}

constexpr OptionRule kPartitionOutput = { "output",
                                          0,
                                          0,
                                          "",
                                          "labels|mean|boundaries",
                                          "labels: numbers from 0; mean: mean colours; boundaries: 1 at the borders" };

/// The level options of T, a struct derived from LevelOptions.
template<class T>
std::vector<Option<T>> level_table()
{
    return {
        { &T::splits,
          { "splits", 0, kAnyInt, "splits", "", "number of vertex splits applied to the base mesh", "level" } },
        { &T::faces, { "faces", 2, kAnyInt, "faces", "", "largest number of triangles of the mesh", "level" } },
        { &T::vertices, { "vertices", 4, kAnyInt, "vertices", "", "largest number of vertices of the mesh", "level" } },
        { &T::fraction,
          { "fraction", 0, 1, "", "", "the same as a share of the vertices of the finest mesh", "level" } },
        { &T::error, { "error", 0, kAnyFloat, "", "", "largest cost of a vertex split that is left out", "level" } },
    };
}

}  // namespace

template<>
const std::vector<Option<LevelOptions>>& option_table<LevelOptions>()
{
    static const std::vector<Option<LevelOptions>> table = level_table<LevelOptions>();
    return table;
}

template<>
const std::vector<Option<WireframeOptions>>& option_table<WireframeOptions>()
{
    using T = WireframeOptions;
    static const std::vector<Option<T>> table = [] {
        std::vector<Option<T>> all = level_table<T>();
        all.push_back({ &T::overlay, { "overlay", 0, 0, "", "", "draw over the level's picture instead of white" } });
        all.push_back({ &T::line, { "line", 0.1, 100, "pixels", "", "width of the lines" } });
        return all;
    }();
    return table;
}

template<>
const std::vector<Option<DualPiecesOptions>>& option_table<DualPiecesOptions>()
{
    using T = DualPiecesOptions;
    static const std::vector<Option<T>> table = [] {
        std::vector<Option<T>> all = level_table<T>();
        all.push_back({ &T::output, kPartitionOutput });
        return all;
    }();
    return table;
}

template<>
const std::vector<Option<FeatureLowpassOptions>>& option_table<FeatureLowpassOptions>()
{
    using T = FeatureLowpassOptions;
    static const std::vector<Option<T>> table = [] {
        std::vector<Option<T>> all;
        add_strength_options(all);
        all.push_back({ &T::splits,
                        { "splits", 0, kAnyInt, "splits", "",
                          "instead of strength: number of vertex splits whose details are kept", "cut-off" } });
        all.push_back(
            { &T::fraction, { "fraction", 0, 1, "", "", "the same as a share of all vertex splits", "cut-off" } });
        return all;
    }();
    return table;
}

template<>
const std::vector<Option<DetailEnhanceOptions>>& option_table<DetailEnhanceOptions>()
{
    using T = DetailEnhanceOptions;
    static const std::vector<Option<T>> table = [] {
        std::vector<Option<T>> all = { { &T::gain,
                                         { "gain", 0, 100, "", "", "factor on the details; 1 changes nothing" } } };
        add_strength_options(all);
        all.push_back({ &T::from,
                        { "from", 0, kAnyInt, "", "",
                          "without strength, noise and log: first split amplified, a share or, above 1, a number" } });
        all.push_back({ &T::to, { "to", 0, kAnyInt, "", "", "end of the range of splits, in the same way" } });
        all.push_back({ &T::denoise,
                        { "denoise", 0, 4, "", "",
                          "details within this many times the noise are not amplified; 0: none is noise" } });
        all.push_back({ &T::curve,
                        { "curve", 0, 0, "", "",
                          "instead of gain, from and to: position:gain,position:gain,... linear in between" } });
        return all;
    }();
    return table;
}

template<>
const std::vector<Option<SegmentOptions>>& option_table<SegmentOptions>()
{
    using T = SegmentOptions;
    static const std::vector<Option<T>> table = {
        { &T::regions,
          { "regions", 1, kAnyInt, "regions", "", "number of regions; 200 if threshold is not given either",
            "number of regions" } },
        { &T::threshold,
          { "threshold", 0, kAnyFloat, "", "",
            "merge until every border costs more, in squared CIELAB units times pixels", "number of regions" } },
        { &T::output, kPartitionOutput },
        { &T::stats,
          { "stats", 0, 0, "", "", "file for a table of the regions: JSON if it ends in .json, else CSV", "", "",
            FileUse::written } },
    };
    return table;
}

template<>
const std::vector<Option<HdrCompressOptions>>& option_table<HdrCompressOptions>()
{
    using T = HdrCompressOptions;
    static const std::vector<Option<T>> table = {
        { &T::s0, { "s0", 0, 1, "", "", "factor on the base and on the largest details; 0: found from the picture" } },
        { &T::beta, { "beta", 0, 1000, "", "", "how fast compression gets weaker towards smaller details" } },
        { &T::dmax, { "dmax", 0, 256, "stops", "", "size from which on details are compressed fully; 0: found" } },
        { &T::detail, { "detail", 0, 8, "", "", "factor on the smallest details, 1 in Eq. (2); 0: found" } },
        { &T::denoise,
          { "denoise", 0, 4, "", "", "details within this many times the noise are calmed; 0: none is noise" } },
        { &T::coherence,
          { "coherence", 0, 1, "", "", "how far details are compressed like coarser features around them; 0: not" } },
        { &T::saturation, { "saturation", 0, 4, "", "", "colourfulness: 1 looks like the scene, 0 makes grey" } },
        { &T::fit, { "fit", 0, 0, "", "", "fit the result to the display; 0: leave it in the picture's units" } },
        { &T::contrast, { "contrast", 0.01, 8, "", "", "factor on the compressed log luminance" } },
        { &T::key, { "key", 0, kAnyFloat, "", "", "luminance after compression shown as middle grey; 0: found" } },
        { &T::white, { "white", 0, kAnyFloat, "", "", "luminance after compression shown as white; 0: found" } },
        { &T::exposure, { "exposure", -20, 20, "stops", "", "added to the exposure" } },
        { &T::output,
          { "output", 0, 0, "", "display|scene|gain",
            "for a display; scene-linear, where 0.18 stays; or log2 of the factor to that" } },
        { &T::peak, { "peak", 100, 4000, "nits", "", "brightest that the display shows; white, 1, is 203 nits" } },
        { &T::aovs, { "aovs", 0, 0, "", "", "with output=scene: every layer of light gets the picture's gain" } },
        { &T::fine, { "fine", -8, 4, "stops", "", "raises the gain of small details, to 1/400 of the diagonal" } },
        { &T::medium, { "medium", -8, 4, "stops", "", "raises the gain of details of middle size" } },
        { &T::coarse, { "coarse", -8, 4, "stops", "", "raises the gain of large details, from 1/40 of the diagonal" } },
        { &T::shadows,
          { "shadows", -8, 8, "stops", "", "raises what is 3 stops or more below middle grey, without halos" } },
        { &T::midtones, { "midtones", -8, 8, "stops", "", "raises what is near middle grey" } },
        { &T::highlights, { "highlights", -8, 8, "stops", "", "raises what is 3 stops or more above middle grey" } },
        { &T::zones,
          { "zones", 0, 0, "", "", "the same as a curve: stops above middle grey:stops raised,... linear between" } },
        { &T::gamut,
          { "gamut", 0, 0, "", "rec709|p3", "colours the display shows; files of p3 have the profile of Display P3" } },
    };
    return table;
}

double resized_length(const OptionInfo& option, double value, double factor)
{
    const bool share = option.unit == kPixelsOrShare;
    if ((!share && option.unit != "pixels") || (share && value < 1.0))
        return value;
    return share ? std::max(1.0, factor * value) : factor * value;
}

template<>
const std::vector<Option<PaintOptions>>& option_table<PaintOptions>()
{
    using T = PaintOptions;
    static const std::vector<Option<T>> table = {
        { &T::style,
          { "style", 0, 0, "", "oil|impasto|wash|pastel|pointillist", "gives the options below that are not given" } },
        { &T::min,
          { "min", 0.0001, 1000, kPixelsOrShare, "", "width of the narrowest brush; below 1: share of the diagonal" } },
        { &T::max,
          { "max", 0.0001, 1000, kPixelsOrShare, "", "width of the widest brush; below 1: share of the diagonal" } },
        { &T::brush,
          { "brush", 0, 0, "", "", "round, flat, bristle, knife, chalk, wash, or a picture", "", "", FileUse::read } },
        { &T::length, { "length", 0, 10, "", "", "factor on the length of strokes" } },
        { &T::tolerance,
          { "tolerance", 0, 255, "8-bit steps", "", "least improvement by a stroke; 0: all strokes are painted" } },
        { &T::cover, { "cover", 0, 1, "", "", "share of the places painted; below 1 the canvas shows" } },
        { &T::opacity, { "opacity", 0, 1, "", "", "opacity of every stroke; 0 leaves the canvas as it is" } },
        { &T::impasto, { "impasto", 0, 1, "", "", "strength of the light on the relief of the paint" } },
        { &T::jitter_colour,
          { "jitter_colour", 0, 1, "", "", "largest random change of a stroke's brightness and warmth", "",
            "jitter_color" } },
        { &T::jitter_angle,
          { "jitter_angle", 0, 1, "", "", "largest random turn of a stroke, as a share of 45 degrees" } },
        { &T::jitter_size,
          { "jitter_size", 0, 1, "", "", "largest random change of a stroke's width, as a share of it" } },
        { &T::seed, { "seed", 0, kAnyInt, "", "", "another seed gives other random changes" } },
        { &T::canvas,
          { "canvas", 0, 0, "", "", "canvas to paint on: source, white, black, R,G,B or a picture", "", "",
            FileUse::read } },
        { &T::detail,
          { "detail", 0, 0, "", "", "picture that scales brushes: white by 1/4, black by 4", "", "", FileUse::read } },
        { &T::strokes,
          { "strokes", 0, 0, "", "", "FILE.svg or FILE.json to write the strokes to", "", "", FileUse::written } },
    };
    return table;
}

template<>
const std::vector<Option<MosaicOptions>>& option_table<MosaicOptions>()
{
    using T = MosaicOptions;
    static const std::vector<Option<T>> table = {
        { &T::shape,
          { "shape", 0, 0, "", "cells|pieces",
            "cells: pieces made even, within the picture's edges; pieces: as they are" } },
        { &T::tiles,
          { "tiles", 4, kAnyInt, "tiles", "", "number of tiles, at least as many as the base mesh has vertices" } },
        { &T::round, { "round", 0, 1, "", "", "how round the corners of cells are" } },
        { &T::variation, { "variation", 0, 1, "", "", "largest random change of a tile's brightness and warmth" } },
        { &T::grout, { "grout", 0, 64, "pixels", "", "width of the joints" } },
        { &T::bevel, { "bevel", 0, 64, "pixels", "", "width of the slope around a tile" } },
        { &T::relief, { "relief", 0, 1, "", "", "how strongly the slopes are lit" } },
        { &T::colour,
          { "colour", 0, 0, "", "", "colour of the joints: white, black, a grey level or R,G,B", "", "color" } },
        { &T::leading,
          { "leading", 0, 64, "pixels", "", "stained glass: width of the lead between glowing tiles; 0: a mosaic" } },
        { &T::seed, { "seed", 0, kAnyInt, "", "", "another seed gives other random changes" } },
    };
    return table;
}

template<>
const std::vector<Option<InkOptions>>& option_table<InkOptions>()
{
    using T = InkOptions;
    static const std::vector<Option<T>> table = {
        { &T::style,
          { "style", 0, 0, "", "hatch|contour|stipple",
            "hatch: calm lines; contour: lines that follow the forms; stipple: dots" } },
        { &T::paper, { "paper", 0, 0, "", "", "sheet that the picture fills: a0 to a6, or WxH in millimetres" } },
        { &T::pen,
          { "pen", 0.01, 100, "mm", "", "width of the pen on the paper; at least half a pixel of the picture" } },
        { &T::width, { "width", 0, 1000, "pixels", "", "width of the pen on the picture; 0: from pen and paper" } },
        { &T::spacing,
          { "spacing", 1, 20, "widths of the pen", "", "least distance of hatching lines, from middle to middle" } },
        { &T::detail, { "detail", 0, 1, "", "", "0: outlines of the large features only; 1: of every edge" } },
        { &T::light,
          { "light", 0, 1, "", "", "0: tones of the picture; 1: half of the paper light, whatever the picture" } },
        { &T::length, { "length", 0.1, 10, "", "", "factor on the length of hatching lines" } },
        { &T::density, { "density", 0, 4, "", "", "factor on the darkness; 0: outlines only" } },
        { &T::outline, { "outline", 0, 4, "", "", "factor on the width of outlines; 0: none" } },
        { &T::cross, { "cross", 0, 0, "", "", "draw lines in a second direction where it is dark" } },
        { &T::colours,
          { "colours", 1, 16, "inks", "", "number of inks at most, the first of which is black", "", "colors" } },
        { &T::sort,
          { "sort", 0, 0, "", "", "for plotters: lines in the order of a short way, in SVG as middle lines" } },
        { &T::seed, { "seed", 0, kAnyInt, "", "", "another seed gives other random changes" } },
        { &T::strokes,
          { "strokes", 0, 0, "", "", "FILE.svg or FILE.json to write the lines to", "", "", FileUse::written } },
    };
    return table;
}

}  // namespace PIMG_ABI
}  // namespace pimg
