// SPDX-License-Identifier: BSD-3-Clause
// What all filters have in common: they prepare the destination, and write rows of results into it.
#pragma once

#include <algorithm>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/detail/format.h>
#include <pimg/detail/parallel.h>
#include <pimg/threads.h>

#include "source/progressive_image_data.h"
#include "source/to_picture.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Pixel type of a destination that does not exist yet.
enum class ResultType {
    as_source,  ///< results are in the source's range
    floating,   ///< results may leave it: float unless the source is floating point
    full_float  ///< float
};

/// Whether a filter can work on previews (BuildOptions::preview).
enum class Previews { refused, taken };

/// Checks the source and the region, and initializes `dst` as OpenImageIO's own functions do. On failure returns false
/// with an error in `dst`. Afterwards `roi` lies within both pictures; it may be empty, and then there is nothing to
/// do.
bool prepare(OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI& roi, ResultType type,
             Previews previews = Previews::refused);

/// The same for results of one channel called `name`: a new `dst` has no other, and only the first of an old one
/// changes. UNKNOWN: the pixel type of the source.
bool prepare_single(OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI& roi, const char* name,
                    const OIIO::TypeDesc& type, Previews previews = Previews::refused);

/// Pixels [xbegin, xend) of row y, in the source's coordinates.
struct RowSpan {
    int y, xbegin, xend;

    std::size_t width() const { return std::size_t(xend - xbegin); }
};

/// Makes results of the colour channels of a span. `row` holds all channels of its pixels, as in the source.
using RowFilter = std::function<void(const RowSpan& span, float* row)>;

/// How results of pictures whose sides meet are made of what is in the margins: mixed, or cut where the picture ends, for
/// lines, of which a mixture would show twice as many, and for what fits already.
enum class Seams { mixed, cut };

/// Runs `filter` on every row of `roi` and writes the channels of `roi` to `dst`, whatever its pixel type.
void write_rows(OIIO::ImageBuf& dst, const ProgressiveImage::Data& data, OIIO::ROI roi, const ParallelFor& parallel,
                const RowFilter& filter, Seams seams = Seams::mixed);

/// What results have where samples of the source were not finite.
enum class Specials { restored, replaced };

/// write_rows() with the colour channels taken from `results`, one raster of the picture's size each.
void write_channels(OIIO::ImageBuf& dst, const ProgressiveImage::Data& data, OIIO::ROI roi, const ParallelFor& parallel,
                    const std::vector<std::vector<float>>& results, Specials specials = Specials::restored,
                    Seams seams = Seams::mixed);

/// The alpha that goes with the picture's colours, one float per pixel; empty if it has none.
std::vector<float> alpha_of(const ProgressiveImage::Data& data);

/// Calls body(sample) for the samples of `count` pixels from number `first` on that were not finite.
template<class Body>
void for_specials(const ProgressiveImage::Data& data, Index first, std::size_t count, Body&& body)
{
    const auto before = [](const SpecialSample& s, Index pixel) {
        return s.pixel < pixel;
    };
    auto s = std::lower_bound(data.specials.begin(), data.specials.end(), first, before);
    for (; s != data.specials.end() && s->pixel < first + Index(count); ++s)
        body(*s);
}

/// Checks the options, then runs the body of a filter. Exceptions of the body become errors of `dst`.
template<class Options, class Body>
bool run_filter(OIIO::ImageBuf& dst, const Options& options, Body&& body)
{
    try {
        std::string error;
        if (check_options(options, error))
            return body();
        set_error(dst, error);
    } catch (const std::bad_alloc&) {
        set_error(dst, "not enough memory");
    } catch (const std::exception& exception) {
        set_error(dst, exception.what());
    }
    return false;
}

/// The arguments of a filter but its options.
struct FilterCall {
    OIIO::ImageBuf& dst;
    const ProgressiveImage& src;
    OIIO::ROI roi;
    int nthreads;
};

/// What a filter makes: one raster of the picture's size for each colour.
struct PictureResult {
    Channels channels;
    Specials specials = Specials::restored;
    Seams seams = Seams::mixed;
};

/// The result of a filter that draws on mesh pixels what was not there before: cropped to the picture, and nothing
/// where the picture has no pixels. Samples that were not finite are drawn over.
PictureResult drawn_result(const ProgressiveImage::Data& data, Channels&& channels);

/// A filter whose result is a picture: make(data, parallel, result, error) makes its colours, or returns false with one
/// line in `error`. Everything else is done here.
template<class Options, class Make>
bool filter_picture(const FilterCall& call, const Options& options, ResultType type, Make&& make)
{
    return run_filter(call.dst, options, [&] {
        OIIO::ROI roi = call.roi;
        if (!prepare(call.dst, call.src, roi, type))
            return false;
        ProgressiveImage::Data& data = *call.src.data();
        const ParallelFor parallel = pool_loop(call.nthreads);
        PictureResult result;
        std::string error;
        if (!make(data, parallel, result, error)) {
            set_error(call.dst, error);
            return false;
        }
        write_channels(call.dst, data, roi, parallel, result.channels, result.specials, result.seams);
        return true;
    });
}

}  // namespace PIMG_ABI
}  // namespace pimg
