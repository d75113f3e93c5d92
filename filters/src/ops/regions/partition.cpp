// SPDX-License-Identifier: BSD-3-Clause
#include "ops/regions/partition.h"

#include <pimg/detail/stop.h>
#include <pimg/dual_pieces.h>
#include <pimg/labels.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

using OIIO::ImageBuf;
using OIIO::ROI;

/// 1 where a pixel and its right or lower neighbour are of different parts, else 0.
void write_boundaries(ImageBuf& dst, const ProgressiveImage::Data& data, ROI roi, const ParallelFor& parallel,
                      const Partition& partition)
{
    const OIIO::ImageSpec& spec = data.spec;
    const int width = spec.width, height = spec.height;
    const std::vector<Index> labels = with_margins(data.wrap, partition.labels);
    write_rows(dst, data, roi, parallel, [&](const RowSpan& span, float* row) {
        const int y = span.y - spec.y;
        for (int x = span.xbegin - spec.x; x < span.xend - spec.x; ++x, row += spec.nchannels) {
            const Index* here = &labels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
            const bool ends =
                (x + 1 < width && here[1] != *here) || (y + 1 < height && here[std::size_t(width)] != *here);
            *row = ends ? 1.0f : 0.0f;
        }
    });
}

/// The colour channels with every pixel at the mean of its part.
std::vector<std::vector<float>> part_means(const ProgressiveImage::Data& data, const Partition& partition)
{
    std::vector<std::vector<float>> results;
    for (int i = 0; i < data.colour.count(); ++i) {
        stop_point();
        std::vector<float> samples = without_margins(data.wrap, channel_samples(data, data.colour.channel(i)));
        const std::vector<float> means = label_means(partition.labels, partition.count, samples.data());
        for (std::size_t k = 0; k < samples.size(); ++k)
            samples[k] = means[partition.labels[k]];
        results.push_back(with_margins(data.wrap, std::move(samples)));
    }
    return results;
}

}  // namespace

bool prepare_partition(ImageBuf& dst, const ProgressiveImage& src, ROI& roi, const std::string& output)
{
    if (output == "mean")
        return prepare(dst, src, roi, ResultType::as_source);
    if (output == "labels")
        return prepare_single(dst, src, roi, "label", OIIO::TypeDesc::UINT32);
    return prepare_single(dst, src, roi, "boundary", OIIO::TypeDesc::UNKNOWN);
}

bool write_partition(ImageBuf& dst, const ProgressiveImage::Data& data, ROI roi, const ParallelFor& parallel,
                     const Partition& partition, const std::string& output)
{
    if (output == "labels") {
        const OIIO::ImageSpec& spec = data.picture;
        const std::size_t width = std::size_t(spec.width);
        const std::size_t first = std::size_t(roi.ybegin - spec.y) * width + std::size_t(roi.xbegin - spec.x);
        dst.specmod().attribute(kLabelCount, int(partition.count));
        return write_labels(dst, roi, partition.labels.data() + first, width, partition.count);
    }
    if (output == "mean")
        write_channels(dst, data, roi, parallel, part_means(data, partition), Specials::replaced);
    else
        write_boundaries(dst, data, roi, parallel, partition);
    return true;
}

}  // namespace PIMG_ABI
}  // namespace pimg
