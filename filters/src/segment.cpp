// SPDX-License-Identifier: BSD-3-Clause
// Segmentation (paper, section 4.2): a cut through the merges of adjacent pieces.
#include <pimg/imagebufalgo.h>

#include <algorithm>

#include <OpenImageIO/half.h>
#include <OpenImageIO/strutil.h>

#include <pimg/dual_pieces.h>
#include <pimg/regions.h>

#include "image_filter.h"
#include "region_report.h"

namespace pimg {
namespace ImageBufAlgo {

namespace {

constexpr int kDefaultRegions = 200;

/// Regions of a picture.
struct Regions {
    Index count = 0;
    std::vector<Index> labels;  ///< row-major
};

bool find_regions(ProgressiveImage::Data& data, const SegmentOptions& options, const ParallelFor& parallel,
                  Regions& regions, std::string& error)
{
    const std::size_t pixels = data.spec.image_pixels();
    const bool by_threshold = options.threshold >= 0.0f;
    if (options.regions > 0 && std::size_t(options.regions) > pixels) {
        error = OIIO::Strutil::fmt::format("regions={}: expected at most {}, the picture's pixels", options.regions,
                                           pixels);
        return false;
    }
    const std::size_t wanted = std::min(std::size_t(options.regions > 0 ? options.regions : kDefaultRegions), pixels);
    const auto tree = data.region_tree(by_threshold ? 1 : wanted, parallel, error);
    if (tree == nullptr)
        return false;
    regions.count = by_threshold ? tree->regions_above(options.threshold) : Index(wanted);
    regions.labels = tree->labels(regions.count);
    return true;
}

/// Labels as numbers in the first channel: not scaled between integers and floats, as pixels are elsewhere. T is made from
/// a Via.
template<class T, class Via = T>
void write_as(ImageBuf& dst, const OIIO::ImageSpec& spec, ROI roi, const std::vector<Index>& labels)
{
    for (int y = roi.ybegin; y < roi.yend; ++y) {
        const Index* row = &labels[std::size_t(y - spec.y) * std::size_t(spec.width)];
        for (int x = roi.xbegin; x < roi.xend; ++x)
            *static_cast<T*>(dst.pixeladdr(x, y, roi.zbegin)) = T(Via(row[x - spec.x]));
    }
}

/// Largest label a pixel type holds exactly.
double largest_label(OIIO::TypeDesc type)
{
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
        return 255.0;
    case OIIO::TypeDesc::INT8:
        return 127.0;
    case OIIO::TypeDesc::UINT16:
        return 65535.0;
    case OIIO::TypeDesc::INT16:
        return 32767.0;
    case OIIO::TypeDesc::HALF:
        return 2048.0;
    case OIIO::TypeDesc::FLOAT:
        return 16777216.0;
    default:
        return 2147483647.0;
    }
}

bool write_labels(ImageBuf& dst, const OIIO::ImageSpec& spec, ROI roi, const Regions& regions)
{
    const OIIO::TypeDesc type = dst.spec().format;
    if (double(regions.count - 1) > largest_label(type)) {
        dst.errorfmt("{} regions: pixels of type {} hold no label above {}", regions.count, type, largest_label(type));
        return false;
    }
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
        write_as<std::uint8_t>(dst, spec, roi, regions.labels);
        break;
    case OIIO::TypeDesc::INT8:
        write_as<std::int8_t>(dst, spec, roi, regions.labels);
        break;
    case OIIO::TypeDesc::UINT16:
        write_as<std::uint16_t>(dst, spec, roi, regions.labels);
        break;
    case OIIO::TypeDesc::INT16:
        write_as<std::int16_t>(dst, spec, roi, regions.labels);
        break;
    case OIIO::TypeDesc::UINT32:
        write_as<std::uint32_t>(dst, spec, roi, regions.labels);
        break;
    case OIIO::TypeDesc::INT32:
        write_as<std::int32_t>(dst, spec, roi, regions.labels);
        break;
    case OIIO::TypeDesc::HALF:
        write_as<half, float>(dst, spec, roi, regions.labels);
        break;
    case OIIO::TypeDesc::FLOAT:
        write_as<float>(dst, spec, roi, regions.labels);
        break;
    case OIIO::TypeDesc::DOUBLE:
        write_as<double>(dst, spec, roi, regions.labels);
        break;
    default:
        dst.errorfmt("labels cannot be stored in pixels of type {}", type);
        return false;
    }
    return true;
}

/// 1 where a pixel and its right or lower neighbour are of different regions, else 0.
void write_boundaries(ImageBuf& dst, const ProgressiveImage::Data& data, ROI roi, const ParallelFor& parallel,
                      const std::vector<Index>& labels)
{
    const OIIO::ImageSpec& spec = data.spec;
    const int width = spec.width, height = spec.height;
    write_rows(dst, data, roi, parallel, [&](int y, float* row) {
        for (int x = roi.xbegin - spec.x; x < roi.xend - spec.x; ++x, row += spec.nchannels) {
            const Index* here = &labels[std::size_t(y - spec.y) * std::size_t(width) + std::size_t(x)];
            const bool ends =
                (x + 1 < width && here[1] != *here) || (y - spec.y + 1 < height && here[std::size_t(width)] != *here);
            *row = ends ? 1.0f : 0.0f;
        }
    });
}

/// The colour channels with every pixel at the mean of its region.
std::vector<std::vector<float>> region_means(const ProgressiveImage::Data& data, const Regions& regions)
{
    const std::size_t stride = std::size_t(data.source.nchannels());
    std::vector<std::vector<float>> results;
    for (int i = 0; i < data.colour.count(); ++i) {
        const float* p = static_cast<const float*>(data.source.localpixels()) + data.colour.channel(i);
        std::vector<float> samples(regions.labels.size());
        for (float& sample : samples) {
            sample = *p;
            p += stride;
        }
        const std::vector<float> means = label_means(regions.labels, regions.count, samples.data());
        for (std::size_t k = 0; k < samples.size(); ++k)
            samples[k] = means[regions.labels[k]];
        results.push_back(std::move(samples));
    }
    return results;
}

/// What a new destination is: one channel, or all of the source's.
bool prepare_result(ImageBuf& dst, const ProgressiveImage& src, ROI& roi, const std::string& output)
{
    if (output == "mean")
        return prepare(dst, src, roi, ResultType::as_source);
    if (output == "labels")
        return prepare_single(dst, src, roi, "label", OIIO::TypeDesc::UINT32);
    return prepare_single(dst, src, roi, "boundary", OIIO::TypeDesc::UNKNOWN);
}

}  // namespace

bool segment(ImageBuf& dst, const ProgressiveImage& src, const SegmentOptions& options, ROI roi, int nthreads)
{
    return run_filter(dst, options, [&] {
        if (!prepare_result(dst, src, roi, options.output))
            return false;
        ProgressiveImage::Data& data = *src.data();
        const ParallelFor parallel = pool_loop(nthreads);
        Regions regions;
        std::string error;
        if (!find_regions(data, options, parallel, regions, error)
            || (!options.stats.empty()
                && !write_region_report(data.source, regions.labels, regions.count, options.stats, error))) {
            dst.errorfmt("{}", error);
            return false;
        }
        if (options.output == "labels") {
            dst.specmod().attribute("pimg:regions", int(regions.count));
            return write_labels(dst, data.spec, roi, regions);
        }
        if (options.output == "mean")
            write_channels(dst, data, roi, parallel, region_means(data, regions), Specials::replaced);
        else
            write_boundaries(dst, data, roi, parallel, regions.labels);
        return true;
    });
}

bool segment(ImageBuf& dst, const ImageBuf& src, const SegmentOptions& options, ROI roi, int nthreads)
{
    ProgressiveImage progressive;
    return build_source(dst, src, nthreads, progressive) && segment(dst, progressive, options, roi, nthreads);
}

ImageBuf segment(const ImageBuf& src, const SegmentOptions& options, ROI roi, int nthreads)
{
    return returned("segment", [&](ImageBuf& dst) { return segment(dst, src, options, roi, nthreads); });
}

ImageBuf segment(const ProgressiveImage& src, const SegmentOptions& options, ROI roi, int nthreads)
{
    return returned("segment", [&](ImageBuf& dst) { return segment(dst, src, options, roi, nthreads); });
}

}  // namespace ImageBufAlgo
}  // namespace pimg
