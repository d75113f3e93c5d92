// SPDX-License-Identifier: BSD-3-Clause
// What segmentation keeps of a progressive image: the merges of its pieces.
#include <algorithm>

#include <pimg/detail/stop.h>
#include <pimg/dual_pieces.h>
#include <pimg/regions.h>

#include "source/lab.h"
#include "source/progressive_image_data.h"
#include "source/wrap/wrapped_pieces.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Share of the picture's vertices at the level whose dual pieces are merged. Finer ones take longer and do not
/// give better regions.
constexpr double kPieceFraction = 0.125;

/// Largest variance of CIELAB within such a piece. A piece may vary more, since a guide does not show every difference
/// in colour; then its pixels are taken one by one.
constexpr double kMostVariance = 25.0;

/// Pieces needed for each region. If there are fewer, pixels are merged instead of pieces.
constexpr std::size_t kPiecesPerRegion = 4;

std::vector<bool> is_mixed(const std::vector<Index>& labels, Index count, const Channels& lab)
{
    struct Sums {
        double area = 0, squares = 0, first[3] = { 0, 0, 0 };
    };
    std::vector<Sums> sums(count);
    for (std::size_t p = 0; p < labels.size(); ++p) {
        Sums& s = sums[labels[p]];
        s.area += 1.0;
        for (std::size_t c = 0; c < lab.size(); ++c) {
            s.first[c] += double(lab[c][p]);
            s.squares += double(lab[c][p]) * double(lab[c][p]);
        }
    }
    std::vector<bool> mixed(count);
    for (Index v = 0; v < count; ++v) {
        const Sums& s = sums[v];
        double mean = 0;
        for (const double first : s.first)
            mean += first * first / s.area;
        mixed[v] = s.squares - mean > kMostVariance * s.area;
    }
    return mixed;
}

/// Labels dual pieces of one colour, and each pixel of the other pieces.
bool uniform_pieces(const Hierarchy& hierarchy, const Wrap& wrap, const Channels& lab, std::vector<Index>& labels,
                    std::string& error)
{
    DualPieces pieces;
    if (const Status status = DualPieces::from_hierarchy(hierarchy, pieces); !status) {
        error = status.error();
        return false;
    }
    const Level level = hierarchy.level_of_vertices(kPieceFraction * double(hierarchy.mesh_pixels()));
    Index count = pieces.count(level);
    labels = wrapped_pieces(wrap, pieces.labels(level), count);
    const std::vector<bool> mixed = is_mixed(labels, count, lab);
    for (std::size_t p = 0; p < labels.size(); ++p)
        if (mixed[labels[p]])
            labels[p] = count + Index(p);
    return true;
}

}  // namespace

std::shared_ptr<const RegionTree> ProgressiveImage::Data::region_tree(std::size_t regions, const ParallelFor& parallel,
                                                                      std::string& error)
{
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    const std::size_t pixels = picture.image_pixels();
    if (m_regions != nullptr && (m_regions->leaves() >= kPiecesPerRegion * regions || m_regions->leaves() == pixels))
        return m_regions;
    Channels lab = lab_channels(source, colour, parallel);
    ChannelsView seen { picture.width, picture.height, {} };
    for (std::vector<float>& channel : lab) {
        channel = without_margins(wrap, std::move(channel));
        seen.channels.push_back(channel.data());
    }
    RegionOptions region_options;
    region_options.wrap_x = wrap.x;
    region_options.wrap_y = wrap.y;
    std::vector<Index> labels;
    auto tree = std::make_shared<RegionTree>();
    Status status;
    if (kPiecesPerRegion * regions < pixels && uniform_pieces(hierarchy, wrap, lab, labels, error)) {
        region_options.pieces = &labels;
        status = RegionTree::build(seen, region_options, *tree);
    }
    if (status && tree->leaves() < kPiecesPerRegion * regions) {
        region_options.pieces = nullptr;
        status = RegionTree::build(seen, region_options, *tree);
    }
    if (!status) {
        error = status.error();
        return nullptr;
    }
    return m_regions = std::move(tree);
}

}  // namespace PIMG_ABI
}  // namespace pimg
