// SPDX-License-Identifier: BSD-3-Clause
// Segmentation (paper, section 4.2): a cut through the merges of adjacent pieces.
#include <pimg/imagebufalgo.h>

#include <algorithm>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/regions.h>

#include "ops/regions/partition.h"
#include "ops/regions/region_report.h"

namespace pimg {
inline namespace PIMG_ABI {
namespace ImageBufAlgo {

namespace {

constexpr int kDefaultRegions = 200;

bool find_regions(ProgressiveImage::Data& data, const SegmentOptions& options, const ParallelFor& parallel,
                  Partition& regions, std::string& error)
{
    const std::size_t pixels = data.picture.image_pixels();
    const bool by_threshold = options.threshold >= 0.0f;
    if (options.regions > 0 && std::size_t(options.regions) > pixels) {
        error = format("regions={}: expected at most {}, the picture's pixels", options.regions, pixels);
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

}  // namespace

bool on_hierarchy::segment(ImageBuf& dst, const ProgressiveImage& src, const SegmentOptions& options, ROI roi,
                           int nthreads)
{
    return run_filter(dst, options, [&] {
        if (!prepare_partition(dst, src, roi, options.output))
            return false;
        ProgressiveImage::Data& data = *src.data();
        const ParallelFor parallel = pool_loop(nthreads);
        Partition regions;
        std::string error;
        if (!find_regions(data, options, parallel, regions, error)
            || (!options.stats.empty() && !write_region_report(data, regions, options.stats, error))) {
            set_error(dst, error);
            return false;
        }
        return write_partition(dst, data, roi, parallel, regions, options.output);
    });
}

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
