// SPDX-License-Identifier: BSD-3-Clause
// The options of all operations. Each is declared once, with key, unit, range, default and help. The command line, the
// options of a file's name that the plugin reads, Python and the documentation all take them from these tables.
//
// To add an operation: write its struct below (the member initialisers are the defaults), declare its option_table, and
// define the table in options.cpp. Options are listed nowhere else.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What happens to a file that the value of an option names. `read` also stands for options whose value may be a file or
/// something else.
enum class FileUse { none, read, written };

/// One option: all that is known of it except the struct member where it is stored.
struct OptionRule {
    const char* key;         ///< name of the option
    double min, max;         ///< smallest and largest number allowed; both 0: any number
    const char* unit;        ///< like "pixels"; "" for none
    const char* choices;     ///< the words allowed, like "a|b|c"; "": any text
    const char* help;        ///< what it does, in one line
    const char* sets = "";   ///< what it sets, if others set it, too: only one of these may be given; "": no others
    const char* alias = "";  ///< an older spelling of the key, still understood; "" for none
    FileUse file = FileUse::none;
};

/// The value of an option.
using OptionValue = std::variant<bool, int, float, std::string>;

/// One option of the struct T.
template<class T>
struct Option {
    /// `member` points to the member of T, or of a base of T, that stores the option: a bool, int, float or std::string.
    template<class Owner, class Value>
    Option(Value Owner::*member, const OptionRule& its_rule)
        : rule(its_rule),
          get([member](const T& options) { return OptionValue(options.*member); }),
          set([member](T& options, const OptionValue& value) { options.*member = std::get<Value>(value); })
    {
    }

    OptionRule rule;
    std::function<OptionValue(const T&)> get;
    std::function<void(T&, const OptionValue&)> set;  ///< the value must have the type that get() returns
};

/// What --help, the documentation and Python show of an option, as text. `default_value` is empty if the option is not set
/// by default.
struct OptionInfo {
    std::string key, type, unit, range, choices, default_value, help;
    double min = 0.0, max = 0.0;  ///< as in OptionRule
    std::string alias;            ///< an older spelling of the key, not shown but understood; empty for none
    FileUse file = FileUse::none;

    /// Whether `name` is the key or its older spelling.
    bool is_called(std::string_view name) const { return name == key || (!alias.empty() && name == alias); }
};

/// The table of all options of the struct T. There is one for each struct below.
template<class T>
const std::vector<Option<T>>& option_table();

/// Sets one option from text, such as "0.3", "true" or "rgb". Returns false, and leaves `options` unchanged, for an
/// unknown key and for a value that cannot be parsed or is out of range. `error` then names the key, what was given and
/// what was expected, in one line.
template<class T>
bool set_option(T& options, std::string_view key, std::string_view value, std::string& error);

/// Checks options that were set in code against the same ranges. A default is always fine. Also returns false if two
/// options are set of which only one may be given. `error` says what is wrong in one line.
template<class T>
bool check_options(const T& options, std::string& error);

/// Whether all options of two structs have the same values.
template<class T>
bool same_options(const T& a, const T& b);

/// Unit of a length in pixels that may also be given as a share of the picture's diagonal, below 1.
constexpr char kPixelsOrShare[] = "pixels or share";

/// What a number of this option is in the same picture `factor` times as large: lengths in pixels grow with it.
PIMG_EXPORT double resized_length(const OptionInfo& option, double value, double factor);

/// Describes all options of the struct T, in the order of its table.
template<class T>
std::vector<OptionInfo> describe_options();

/// A named set of values for options that are not given.
struct Preset {
    const char* name;
    const char* values;   ///< pairs as on the command line: "min=4:brush=flat"
    const char* summary;  ///< in one line
};

// ---- the options ------------------------------------------------------------------------------------------

/// How the picture is read and its hierarchy built.
struct BuildOptions {
    std::string guide;    ///< luma, log, rgb or lab (CIELAB); empty: log for half/float pictures, else luma
    std::string weights;  ///< factors above 0 on the errors of the guide's channels, like "1,0.5,0.5"; empty: 1 each
    int base = 128;       ///< triangles of the base mesh, 2 or more
    std::string metric = "volume";  ///< cost of a collapse; quadric and exact are slow, for comparison
    std::string
        incolorspace;   ///< colour space of the picture; empty: its oiio:ColorSpace, else sRGB for whole numbers,
                        ///< else scene-linear
    std::string layer;  ///< which channels are the picture; empty: see Colour::count()
    /// Which sides meet, so that filters leave no seam: none; x for panoramas in latitude and longitude, whose left and
    /// right sides meet; xy for tiles. Empty: x if the metadata say that the picture is such a panorama, else none.
    std::string wrap;
    /// auto: one vertex per pixel; collapses that hardly change the picture are chosen by bisection, which is fast
    /// (SimplifyOptions::bisection), all others as with full. full: every collapse is the cheapest (section 3.2).
    /// adaptive: fewer vertices, and a residual (section 6). Whichever it is, the picture is represented exactly. With
    /// another metric than volume, auto is full.
    std::string mesh = "auto";
    /// For a quick look at hdr_compress: the hierarchy is that of a reduced picture of at most half a million pixels, and what it
    /// gives is enlarged with the full picture as guide. Other filters refuse such an image. `guide` is log.
    bool preview = false;
    float density = 0.33f;             ///< share of the pixels that are vertices of an adaptive mesh
    std::string control = "gradient";  ///< what it follows: gradient, curvature, or the brightness of an image file
};

/// Which level M_i to show. At most one of these may be set; if none is, the finest is shown. -1: not set.
struct LevelOptions {
    int splits = -1;         ///< number of vertex splits applied to the base mesh
    int faces = -1;          ///< largest number of triangles of M_i
    int vertices = -1;       ///< largest number of vertices of M_i
    float fraction = -1.0f;  ///< the same as a share of the vertices of the finest mesh, 0..1
    float error = -1.0f;     ///< largest cost (Hierarchy::costs) of a split that is left out
};

/// The edges of a level.
struct WireframeOptions : LevelOptions {
    bool overlay = false;  ///< draw them over the level's picture instead of on white
    float line = 1.0f;     ///< width of the lines in pixels
};

/// The dual pieces of a level (section 4.2).
struct DualPiecesOptions : LevelOptions {
    std::string output = "labels";  ///< labels, mean or boundaries
};

/// How much contrast counts as detail, for the filters that smooth by strength. At most one of strength and noise may be
/// set. -1: not set.
struct StrengthOptions {
    float strength = -1.0f;  ///< contrast that is smoothed away, in units of the samples; with log in stops
    float noise = -1.0f;     ///< the same as a multiple of the estimated standard deviation of the noise
    bool log = false;        ///< work on the logarithms of the channels, for scene-referred pictures
};

/// Low-pass by strength or, with splits or fraction, by position in the hierarchy (section 4.1). At most one of strength,
/// noise, splits and fraction may be set. If none is, the strength is 0.03, or 0.3 stops with log.
struct FeatureLowpassOptions : StrengthOptions {
    int splits = -1;         ///< number of vertex splits whose details are kept: n_l of the paper
    float fraction = -1.0f;  ///< the same as a share of all splits
};

/// Amplifies the details of a range of splits (section 4.1) or, with strength, noise or log, what feature_lowpass() of that
/// strength removes.
struct DetailEnhanceOptions : StrengthOptions {
    float gain = 2.0f;     ///< factor on the details; 1 changes nothing
    float from = 0.1f;     ///< first split that is amplified: a share of all splits or, above 1, their number
    float to = 1.0f;       ///< end of the range, in the same way
    float denoise = 1.0f;  ///< details within this many times the noise are not amplified; 0: none is noise
    /// The gain as a function of the position among the splits, instead of gain, from and to: pairs of position and gain,
    /// such as "0:1,0.1:1,0.2:3,1:3". The gain is linear between these positions and constant outside. Positions are as
    /// for `from` and must not fall; a position that stands twice makes a jump.
    std::string curve;
};

/// Merges pieces of the picture into regions (section 4.2). At most one of regions and threshold may be set.
struct SegmentOptions {
    int regions = -1;               ///< number of regions; 200 if threshold is not set either
    float threshold = -1.0f;        ///< merge until every border costs more; squared CIELAB units times pixels
    std::string output = "labels";  ///< labels, mean or boundaries
    std::string stats;  ///< file for a table of the regions: JSON if its name ends in .json, else CSV; empty: none
};

/// Luminance of the white of an SDR picture on a display, in nits: reference white of ITU-R BT.2408.
constexpr float kSdrWhiteNits = 203.0f;

/// HDR compression (section 5.1, Eq. 2) with a contrast envelope and automatic exposure. Where 0 means "found", the value
/// is found from the picture; resolve_hdr_compress() tells which it is.
struct HdrCompressOptions {
    float s0 = 0.0f;       ///< scale of the base and of the largest details; 0: found
    float beta = 10.0f;    ///< how fast compression gets weaker towards smaller details
    float dmax = 0.0f;     ///< size in stops from which on details are compressed fully; 0: found
    float detail = 0.0f;   ///< gain of the smallest details, 1 in Eq. (2); 0: found, or 1 without fit or coherence
    float denoise = 1.0f;  ///< details within this many times the noise are calmed, not amplified; 0: none is noise
    float coherence =
        0.75f;  ///< how far details are compressed like the coarser features around them; 0: Eq. (2) as printed
    float saturation = 1.0f;         ///< colourfulness; 1 looks like the scene, 0 makes grey
    bool fit = true;                 ///< place middle grey and white on the display; false: stay in the picture's units
    float contrast = 1.0f;           ///< factor on the compressed log luminance
    float key = 0.0f;                ///< luminance of the compressed picture shown as middle grey (0.18); 0: found
    float white = 0.0f;              ///< luminance of the compressed picture shown as white; 0: found
    float exposure = 0.0f;           ///< added to the exposure, in stops
    std::string output = "display";  ///< display; scene: scene-linear; gain: log2 of the factor from source to scene
    float peak =
        kSdrWhiteNits;        ///< luminance in nits of the brightest that the display shows; white is at kSdrWhiteNits
    bool aovs = false;        ///< output=scene: every layer that holds light gets the picture's gain
    float fine = 0.0f;        ///< stops by which the gain of details is raised, if they are small,
    float medium = 0.0f;      ///< of middle size,
    float coarse = 0.0f;      ///< or large
    float shadows = 0.0f;     ///< stops by which what is dark is raised, 3 stops below middle grey and further,
    float midtones = 0.0f;    ///< what is middle grey,
    float highlights = 0.0f;  ///< and what is 3 stops above it and further
    /// The same at any exposure, instead of these three: pairs of stops above middle grey and of stops it is raised by,
    /// such as "-6:+2,-3:+1,0:0,4:-1". Linear between these points and constant outside.
    std::string zones;
    std::string gamut = "rec709";  ///< colours that the display shows: those of rec709, or those of p3, Display P3
};

/// Painterly rendering (section 5.2). What is not set has the value of the style (paint_styles()): -1 and empty strings
/// stand for "not set".
struct PaintOptions {
    std::string style = "oil";  ///< oil, impasto, wash, pastel or pointillist
    float min = -1.0f;     ///< width of the narrowest brush in pixels or, below 1, as a share of the picture's diagonal
    float max = -1.0f;     ///< width of the widest brush, in the same way
    std::string brush;     ///< round, flat, bristle, knife, chalk, wash, or a picture: alpha says where, grey how thick
    float length = -1.0f;  ///< factor on the length of strokes, which is about four widths
    float tolerance = -1.0f;      ///< least improvement a stroke must bring, in 8-bit steps; 0: all strokes are painted
    float cover = -1.0f;          ///< share of the places that get a stroke; 1: gaps are filled, too
    float opacity = -1.0f;        ///< opacity of every stroke; 0 leaves the canvas as it is
    float impasto = -1.0f;        ///< strength of the light on the relief of the paint
    float jitter_colour = -1.0f;  ///< largest random change of a stroke's brightness and warmth, as a share
    float jitter_angle = -1.0f;   ///< largest random turn of a stroke, as a share of 45 degrees
    float jitter_size = -1.0f;    ///< largest random change of a stroke's width, as a share of it
    int seed = 1;                 ///< another seed gives other random changes
    std::string canvas;           ///< what is painted on: source (the picture itself), a colour or a picture
    std::string detail;   ///< picture that scales the brushes: white to a quarter, black to four times, 0.5 not at all
    std::string strokes;  ///< FILE.svg or FILE.json to write the strokes to; empty: none
};

/// A mosaic whose tiles are dual pieces (section 7).
struct MosaicOptions {
    std::string shape =
        "cells";         ///< cells: pieces made even and round, within the edges of the picture; pieces: as they are
    int tiles = 2000;    ///< number of tiles
    float round = 0.3f;  ///< how round the corners of cells are: their radius as a share of the tile's
    float variation = 0.04f;      ///< largest random change of a tile's brightness and warmth, as a share
    float grout = 1.5f;           ///< width of the joints in pixels
    float bevel = 2.0f;           ///< width of the slope around a tile in pixels
    float relief = 0.5f;          ///< how strongly the slopes are lit
    std::string colour = "0.15";  ///< of the joints: white, black, a grey level or R,G,B, in the picture's units
    float leading = 0.0f;  ///< stained glass: width in pixels of the lead between flat, glowing tiles; 0: a mosaic
    int seed = 1;          ///< another seed gives other random changes
};

/// Pen and ink (section 7).
struct InkOptions {
    std::string style = "hatch";  ///< hatch, contour (lines follow the forms) or stipple (dots)
    std::string paper = "a5";     ///< a0 to a6 or WxH in millimetres: the sheet that the picture fills
    float pen = 0.4f;             ///< width of the pen on the paper in millimetres; at least half a pixel
    float width = 0.0f;           ///< the same in pixels; 0: found from pen and paper
    float spacing = 2.0f;         ///< least distance of hatching lines, in widths of the pen
    float detail = 0.5f;          ///< 0: outlines of the large features only; 1: of every edge
    float light = 0.0f;           ///< 0: tones of the picture; 1: half of the paper light, whatever the picture
    float length = 1.0f;          ///< factor on the length of hatching lines
    float density = 1.0f;         ///< factor on the darkness; 0: outlines only
    float outline = 1.0f;         ///< factor on the width of outlines; 0: none
    bool cross = true;            ///< draw lines in a second direction where it is dark
    int colours = 1;              ///< number of inks, the first of which is black
    bool sort = false;            ///< for plotters: lines in the order of a short way, middle lines in SVG
    int seed = 1;                 ///< another seed gives other random changes
    std::string strokes;          ///< FILE.svg or FILE.json to write the lines to; empty: none
};

/// The styles of paint(). Each sets every option that may be "not set".
PIMG_EXPORT const std::vector<Preset>& paint_styles();

/// The same options with the values of their style where none is set. An unknown style changes nothing.
PIMG_EXPORT PaintOptions with_style(const PaintOptions& options);

template<>
PIMG_EXPORT const std::vector<Option<BuildOptions>>& option_table<BuildOptions>();
template<>
PIMG_EXPORT const std::vector<Option<LevelOptions>>& option_table<LevelOptions>();
template<>
PIMG_EXPORT const std::vector<Option<WireframeOptions>>& option_table<WireframeOptions>();
template<>
PIMG_EXPORT const std::vector<Option<DualPiecesOptions>>& option_table<DualPiecesOptions>();
template<>
PIMG_EXPORT const std::vector<Option<FeatureLowpassOptions>>& option_table<FeatureLowpassOptions>();
template<>
PIMG_EXPORT const std::vector<Option<DetailEnhanceOptions>>& option_table<DetailEnhanceOptions>();
template<>
PIMG_EXPORT const std::vector<Option<HdrCompressOptions>>& option_table<HdrCompressOptions>();
template<>
PIMG_EXPORT const std::vector<Option<SegmentOptions>>& option_table<SegmentOptions>();
template<>
PIMG_EXPORT const std::vector<Option<PaintOptions>>& option_table<PaintOptions>();
template<>
PIMG_EXPORT const std::vector<Option<MosaicOptions>>& option_table<MosaicOptions>();
template<>
PIMG_EXPORT const std::vector<Option<InkOptions>>& option_table<InkOptions>();

}  // namespace PIMG_ABI
}  // namespace pimg

#include <pimg/detail/options_impl.h>
