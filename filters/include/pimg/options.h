// SPDX-License-Identifier: BSD-3-Clause
// Every parameter of every operation, declared once: key, unit, range, default and help. The
// command line, the plugin's read-time keys, Python and the documentation all read these tables.
//
// To add an operation: write its struct below (defaults are the member initialisers), declare its
// option_table, and define the table in options.cpp. Nothing else lists options.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace pimg {

/// What becomes of a file that an option names; `read` also where it may name something else.
enum class FileUse { none, read, written };

/// What is known of one option apart from where it is stored.
struct OptionRule {
    const char* key;
    double min, max;         ///< inclusive range of numbers; both 0 for any
    const char* unit;        ///< "" for none
    const char* choices;     ///< words allowed, "a|b|c"; "" for any
    const char* help;        ///< one line
    const char* sets = "";   ///< what it sets, if others set it too: only one of those may be given
    const char* alias = "";  ///< an older spelling of the key, still understood; "" for none
    FileUse file = FileUse::none;
};

/// A value of any type an option may have.
using OptionValue = std::variant<bool, int, float, std::string>;

/// One option of the struct T.
template<class T>
struct Option {
    /// `member` of T or of a base of it: bool, int, float or std::string.
    template<class Owner, class Value>
    Option(Value Owner::*member, const OptionRule& its_rule)
        : rule(its_rule),
          get([member](const T& options) { return OptionValue(options.*member); }),
          set([member](T& options, const OptionValue& value) { options.*member = std::get<Value>(value); })
    {
    }

    OptionRule rule;
    std::function<OptionValue(const T&)> get;
    std::function<void(T&, const OptionValue&)> set;  ///< of the type get() returns
};

/// What --help, documentation and Python show of an option. `default_value` is empty for an option that is not set.
struct OptionInfo {
    std::string key, type, unit, range, choices, default_value, help;
    double min = 0.0, max = 0.0;  ///< as in OptionRule
    std::string alias;            ///< an older spelling of the key, not shown but understood; empty for none
    FileUse file = FileUse::none;

    /// Whether `name` is its key, or the older spelling.
    bool is_called(std::string_view name) const { return name == key || (!alias.empty() && name == alias); }
};

/// The table of an options struct; specialised for each below.
template<class T>
const std::vector<Option<T>>& option_table();

/// Sets one option from text ("0.3", "true", "rgb"). False, with a one-line message naming the key, what was given and
/// what was expected, for an unknown key, a value that does not parse or one out of range; `options` is then unchanged.
template<class T>
bool set_option(T& options, std::string_view key, std::string_view value, std::string& error);

/// Checks values assigned in code against the same ranges; a default always passes.
template<class T>
bool check_options(const T& options, std::string& error);

template<class T>
std::vector<OptionInfo> describe_options();

// ---- the options ------------------------------------------------------------------------------------------

/// How the picture is read and its hierarchy built.
struct BuildOptions {
    std::string guide;              ///< luma, log, rgb or lab (CIELAB); empty: log for half/float pictures, else luma
    std::string weights;            ///< of the errors of the guide's channels, above 0: "1,0.5,0.5"; empty: 1 each
    int base = 128;                 ///< faces of the base mesh
    std::string metric = "volume";  ///< cost of a collapse; quadric and exact are slow, for comparison
    std::string
        incolorspace;  ///< colour space of the picture; empty: its oiio:ColorSpace, else sRGB for whole numbers,
                       ///< else scene-linear
    std::string mesh = "full";         ///< full: one vertex per pixel; adaptive: fewer, and a residual (section 6)
    float density = 0.33f;             ///< share of the pixels an adaptive mesh keeps
    std::string control = "gradient";  ///< what its density follows: gradient, curvature, or an image file's brightness
};

/// Which level M_i to show: at most one may be set; none means the finest.
struct LevelOptions {
    int splits = -1;         ///< vertex splits applied to the base mesh
    int faces = -1;          ///< faces of M_i
    int vertices = -1;       ///< vertices of M_i
    float fraction = -1.0f;  ///< share of the picture's vertices
    float error = -1.0f;     ///< largest collapse cost left out
};

struct WireframeOptions : LevelOptions {
    bool overlay = false;  ///< draw over the level's image instead of white
    float line = 1.0f;     ///< width of the lines in pixels
};

/// Dual pieces (paper, section 4.2) of a level.
struct DualPiecesOptions : LevelOptions {
    std::string output = "labels";  ///< labels, mean or boundaries
};

/// How much is detail, for the filters that smooth by strength. At most one of strength and noise may be set.
struct StrengthOptions {
    float strength = -1.0f;  ///< contrast smoothed away, in units of the samples, or in stops with log
    float noise = -1.0f;     ///< the same as a multiple of the estimated noise
    bool log = false;        ///< work on the logarithm of every channel: for scene-referred pictures
};

/// Low-pass by strength or, with splits or fraction, by position in the hierarchy (paper, section 4.1). At most one of
/// the four may be set; none means a strength of 0.03, or 0.3 stops.
struct FeatureLowpassOptions : StrengthOptions {
    int splits = -1;         ///< n_l of the paper: vertex splits whose details are kept
    float fraction = -1.0f;  ///< the same as a share of all splits
};

/// Amplifies the details of a range of splits (paper, section 4.1) or, with strength or noise, what feature_lowpass()
/// of that strength removes.
struct DetailEnhanceOptions : StrengthOptions {
    float gain = 2.0f;
    float from = 0.1f;  ///< first split amplified: a share of all splits, or a number of splits if above 1
    float to = 1.0f;    ///< end of the range, likewise
    /// Gain as a function of the position, instead of the three above: "0:1,0.1:1,0.2:3,1:3" is linear between those
    /// places and constant outside. Positions as for `from`, never falling; the same twice is a jump.
    std::string curve;
};

/// Merges adjacent pieces of the picture into regions (paper, section 4.2).
struct SegmentOptions {
    int regions = -1;               ///< how many; 200 if threshold is not given either
    float threshold = -1.0f;        ///< merge until every border costs more: squared CIELAB units times pixels
    std::string output = "labels";  ///< labels, mean or boundaries
    std::string stats;              ///< file for figures of every region, .json or else CSV; empty: none
};

/// HDR compression (paper, section 5.1, Eq. 2) with contrast envelope and automatic exposure. Values of 0 marked
/// "found" are taken from the picture; resolve_hdr_compress() tells them.
struct HdrCompressOptions {
    float s0 = 0.0f;     ///< scale of the base and of the largest details; 0: found
    float beta = 10.0f;  ///< how fast smaller details are compressed less
    float dmax = 0.0f;   ///< detail compressed fully, in stops; 0: found
    float coherence =
        0.75f;  ///< how far a detail is compressed like the coarser features around; 0: Eq. (2) as printed
    float saturation = 1.0f;  ///< exponent of the colour ratio; 1 keeps it, 0 is grey
    bool fit = true;          ///< place middle grey and white on the display; false: stay in the picture's units
    float contrast = 0.0f;    ///< factor on the compressed log luminance; 0: found
    float key = 0.0f;         ///< luminance of the compressed picture shown as middle grey (0.18); 0: found
    float white = 0.0f;       ///< luminance of the compressed picture shown as white; 0: found
    float exposure = 0.0f;    ///< brightness added to that, in stops
};

/// Painterly rendering (paper, section 5.2).
struct PaintOptions {
    float min = 3.0f;               ///< narrowest brush in pixels
    float max = 32.0f;              ///< widest brush in pixels
    std::string brush = "bristle";  ///< round, flat, bristle, knife, or a picture: alpha says where, grey how thick
    float length = 1.0f;            ///< factor on the length of strokes
    float tolerance = 3.0f;      ///< least improvement a stroke must bring, in 8-bit steps; 0: strokes for all splits
    float opacity = 1.0f;        ///< of every stroke; 0 leaves the canvas
    float impasto = 0.0f;        ///< strength of the light on the relief of the paint
    float jitter_colour = 0.0f;  ///< random change of a stroke's brightness, as a share of it
    float jitter_angle = 0.0f;   ///< random turn of a stroke, as a share of 45 degrees
    float jitter_size = 0.0f;    ///< random change of a stroke's width, as a share of it
    int seed = 1;                ///< of all that is random
    std::string canvas;          ///< colour or picture painted on; empty: the picture itself
    std::string
        detail;  ///< picture that scales the brushes: white for a quarter, grey 0.5 as they are, black for four times
    std::string strokes;  ///< FILE.svg or FILE.json the strokes are written to; empty: none
};

/// Dual pieces as the tiles of a mosaic (paper, section 7).
struct MosaicOptions {
    int tiles = 2000;             ///< number of tiles
    float grout = 1.5f;           ///< width of the joints in pixels
    float bevel = 2.0f;           ///< width of the slope around a tile in pixels
    float relief = 0.5f;          ///< how strongly the slopes are lit
    std::string colour = "0.15";  ///< of the joints, in the picture's units
};

/// Pen and ink (paper, section 7).
struct InkOptions {
    float width = 1.3f;    ///< of the pen in pixels
    float length = 1.0f;   ///< factor on the length of lines
    float density = 1.0f;  ///< factor on the darkness
    float outline = 1.0f;  ///< darkness added along edges
    bool cross = true;     ///< a second direction where it is dark
    int seed = 1;          ///< of all that is random
    std::string strokes;   ///< FILE.svg or FILE.json the lines are written to; empty: none
};

template<>
const std::vector<Option<BuildOptions>>& option_table<BuildOptions>();
template<>
const std::vector<Option<LevelOptions>>& option_table<LevelOptions>();
template<>
const std::vector<Option<WireframeOptions>>& option_table<WireframeOptions>();
template<>
const std::vector<Option<DualPiecesOptions>>& option_table<DualPiecesOptions>();
template<>
const std::vector<Option<FeatureLowpassOptions>>& option_table<FeatureLowpassOptions>();
template<>
const std::vector<Option<DetailEnhanceOptions>>& option_table<DetailEnhanceOptions>();
template<>
const std::vector<Option<HdrCompressOptions>>& option_table<HdrCompressOptions>();
template<>
const std::vector<Option<SegmentOptions>>& option_table<SegmentOptions>();
template<>
const std::vector<Option<PaintOptions>>& option_table<PaintOptions>();
template<>
const std::vector<Option<MosaicOptions>>& option_table<MosaicOptions>();
template<>
const std::vector<Option<InkOptions>>& option_table<InkOptions>();

// ---- implementation ---------------------------------------------------------------------------------------

/// Parses `text` as the type `value` holds, and checks it; see set_option().
bool parse_option(const OptionRule& rule, std::string_view text, OptionValue& value, std::string& error);

bool check_option(const OptionRule& rule, const OptionValue& value, std::string& error);

/// False if two of the options given say the same thing in different ways (OptionRule::sets).
bool check_alternatives(const std::vector<const OptionRule*>& given, std::string& error);
OptionInfo describe_option(const OptionRule& rule, const OptionValue& default_value);
std::string unknown_option(std::string_view key, const std::vector<std::string_view>& known);

template<class T>
OptionValue get_option(const T& options, const Option<T>& option)
{
    return option.get(options);
}

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
std::vector<OptionInfo> describe_options()
{
    const T defaults;
    std::vector<OptionInfo> infos;
    for (const Option<T>& option : option_table<T>())
        infos.push_back(describe_option(option.rule, option.get(defaults)));
    return infos;
}

}  // namespace pimg
