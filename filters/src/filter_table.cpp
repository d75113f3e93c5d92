// SPDX-License-Identifier: BSD-3-Clause
// To add a filter: one row, naming its options struct, whose table has the keys, and its function.
#include <pimg/filter_table.h>

#include <algorithm>
#include <cctype>

#include <OpenImageIO/strutil.h>

#include <pimg/imagebufalgo.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

template<class Options>
using Function = bool (*)(OIIO::ImageBuf&, const ProgressiveImage&, const Options&, OIIO::ROI, int);

/// The kind of result that these options give, where `usual` is that of the defaults.
template<class Options>
FilterOutput output_of(const Options&, FilterOutput usual)
{
    return usual;
}
FilterOutput output_of(const std::string& partition)
{
    return partition == "labels"    ? FilterOutput::labels
        : partition == "boundaries" ? FilterOutput::mask
                                    : FilterOutput::picture;
}
FilterOutput output_of(const SegmentOptions& options, FilterOutput)
{
    return output_of(options.output);
}
FilterOutput output_of(const DualPiecesOptions& options, FilterOutput)
{
    return output_of(options.output);
}

FilterOutput output_of(const HdrCompressOptions& options, FilterOutput usual)
{
    return options.output == "gain" ? FilterOutput::gain : usual;
}

/// The name of the file that these options ask to write.
template<class Options>
std::string written_by(const Options& options)
{
    for (const Option<Options>& option : option_table<Options>())
        if (option.rule.file == FileUse::written && !std::get<std::string>(option.get(options)).empty())
            return option.rule.key;
    return "";
}

template<class Options, Function<Options> Run, FilterOutput Output>
bool bind(const OptionTexts& texts, BoundFilter& filter, std::string& error)
{
    Options options;
    if (!set_options(options, texts, error))
        return false;
    filter.output = output_of(options, Output);
    filter.written = written_by(options);
    filter.run = [options](OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI roi, int nthreads) {
        return Run(dst, src, options, roi, nthreads);
    };
    return true;
}

struct Names {
    const char *name, *command, *summary;
};

constexpr BareValue kSwitch = { "1", "", "" };

template<class Options, Function<Options> Run, FilterOutput Output>
Filter row(const Names& names, const BareValue& bare = kSwitch, const std::vector<Preset>& (*presets)() = nullptr)
{
    return {
        names.name, names.command, names.summary, bare, Output, describe_options<Options>, bind<Options, Run, Output>,
        presets
    };
}

}  // namespace

const std::vector<Filter>& filter_table()
{
    namespace iba = ImageBufAlgo;
    using Out = FilterOutput;
    static const std::vector<Filter> table = {
        row<LevelOptions, iba::level_image, Out::picture>(
            { "level", "--level",
              "shows a coarser mesh as a picture; at most one key chooses the level, none the finest" },
            { "SPLITS", "splits", "" }),
        row<WireframeOptions, iba::wireframe, Out::picture>(
            { "wireframe", "--wireframe", "draws the edges of the mesh of a level, chosen as for the filter level" }),
        row<FeatureLowpassOptions, iba::feature_lowpass, Out::picture>(
            { "feature_lowpass", "--feature-lowpass",
              "removes texture and small features, and keeps the edges of large ones" },
            { "SPLITS", "splits", "fraction" }),
        row<DetailEnhanceOptions, iba::detail_enhance, Out::unbounded>(
            { "detail_enhance", "--detail-enhance",
              "amplifies details: those of a range of vertex splits, or those of low contrast" },
            { "GAIN", "gain", "" }),
        row<HdrCompressOptions, iba::hdr_compress, Out::light>(
            { "hdr_compress", "--hdr-compress", "fits high dynamic range to a display: linear light, white at 1" }),
        row<DualPiecesOptions, iba::dual_pieces, Out::labels>(
            { "dual_pieces", "--dual-pieces",
              "finds the pixels that each vertex of a level stands for; the level is chosen as for the filter level" }),
        row<SegmentOptions, iba::segment, Out::labels>(
            { "segment", "--segment", "partitions the picture into connected regions of similar colour" },
            { "REGIONS", "regions", "" }),
        row<PaintOptions, iba::paint, Out::picture>(
            { "paint", "--paint", "paints with brush strokes that follow the picture's forms" }, kSwitch, paint_styles),
        row<MosaicOptions, iba::mosaic, Out::picture>(
            { "mosaic", "--mosaic", "makes a mosaic of tiles that follow the picture's forms" }),
        row<InkOptions, iba::ink, Out::picture>({ "ink", "--ink", "draws the picture with pen and ink" }),
    };
    return table;
}

std::string title_of(const Filter& filter)
{
    std::string title;
    for (const std::string& word : OIIO::Strutil::splits(filter.name, "_"))
        title += (title.empty() ? "" : " ") + (word == "hdr" ? "HDR" : word == "lowpass" ? "Low-pass" : label_of(word));
    return title;
}

std::string label_of(std::string text)
{
    std::replace(text.begin(), text.end(), '_', ' ');
    if (!text.empty())
        text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

const Filter* find_filter(std::string_view name, std::string& error)
{
    std::string wanted(name), names;
    std::replace(wanted.begin(), wanted.end(), '-', '_');
    for (const Filter& filter : filter_table()) {
        if (wanted == filter.name)
            return &filter;
        names += (names.empty() ? "" : ", ") + std::string(filter.name);
    }
    error = "unknown filter \"" + std::string(name) + "\": expected one of " + names;
    return nullptr;
}

}  // namespace PIMG_ABI
}  // namespace pimg
