// SPDX-License-Identifier: BSD-3-Clause
// To add a filter: one row, naming its options struct, whose table has the keys, and its function.
#include <pimg/filter_table.h>

#include <algorithm>

#include <pimg/imagebufalgo.h>

namespace pimg {

namespace {

template<class Options>
using Function = bool (*)(OIIO::ImageBuf&, const ProgressiveImage&, const Options&, OIIO::ROI, int);

template<class Options, Function<Options> function>
Filter row(const char* name, const char* summary)
{
    const auto bind = [](const OptionTexts& texts, BoundFilter& filter, std::string& error) {
        Options options;
        if (!set_options(options, texts, error))
            return false;
        filter = [options](OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI roi, int nthreads) {
            return function(dst, src, options, roi, nthreads);
        };
        return true;
    };
    return { name, summary, describe_options<Options>, bind };
}

}  // namespace

const std::vector<Filter>& filter_table()
{
    namespace iba = ImageBufAlgo;
    static const std::vector<Filter> table = {
        row<HdrCompressOptions, iba::hdr_compress>("hdr_compress", "Fits high dynamic range to a display"),
        row<FeatureLowpassOptions, iba::feature_lowpass>("feature_lowpass", "Smooths texture away and keeps features"),
        row<DetailEnhanceOptions, iba::detail_enhance>("detail_enhance", "Amplifies details"),
        row<DualPiecesOptions, iba::dual_pieces>("dual_pieces", "Pixels that each vertex of a level stands for"),
        row<SegmentOptions, iba::segment>("segment", "Merges what looks alike into connected regions"),
        row<PaintOptions, iba::paint>("paint", "Paints with brush strokes that follow the picture's forms"),
        row<MosaicOptions, iba::mosaic>("mosaic", "Lays the pieces of a level as tiles"),
        row<InkOptions, iba::ink>("ink", "Draws with pen and ink"),
        row<LevelOptions, iba::level_image>("level", "The mesh of one level as a picture"),
        row<WireframeOptions, iba::wireframe>("wireframe", "The edges of the mesh of one level"),
    };
    return table;
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

bool split_options(std::string_view text, OptionTexts& texts, std::string& error)
{
    while (!text.empty()) {
        const std::size_t equals = text.find('=');
        if (equals == 0 || equals == text.npos || text.find(':') < equals) {
            error = "\"" + std::string(text.substr(0, text.find(':'))) + "\": expected key=value";
            return false;
        }
        const std::string key(text.substr(0, equals));
        text.remove_prefix(equals + 1);
        const bool quoted = !text.empty() && text[0] == '"';
        if (quoted)
            text.remove_prefix(1);
        const std::size_t end = text.find(quoted ? '"' : ':');
        if (quoted && (end == text.npos || (end + 1 < text.size() && text[end + 1] != ':'))) {
            error = key + ": expected the value in quotes to end with a quote";
            return false;
        }
        texts.emplace_back(key, text.substr(0, end));
        text.remove_prefix(std::min(text.size(), end == text.npos ? end : end + (quoted ? 2 : 1)));
    }
    return true;
}

}  // namespace pimg
