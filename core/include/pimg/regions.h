// SPDX-License-Identifier: BSD-3-Clause
// Segmentation (paper, section 4.2). Neighbouring pieces are merged, those with the cheapest border first, until one
// region is left. The merges form a tree, and any number of regions is a cut through this tree. So the picture is
// analysed once, and every number of regions takes one pass.
#pragma once

#include <vector>

#include <pimg/channels.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What the cost of a border depends on. For regions of n1 and n2 pixels whose mean colours have the distance D, with a
/// common border of l pixel sides along which the gradient has the mean strength E, the cost is
///     w (floor + D^2 + boundary E) (sqrt(min(n1, n2)) / l)^(1/8),    w = n1 n2 / (n1 + n2).
/// w D^2 is what merging adds to the sum of squared deviations inside the regions (Ward 1963). The gradient keeps regions
/// apart that only differ near their border. The last factor makes long borders cheaper, so that regions grow compact.
/// docs/internals.md says how the defaults were found.
struct RegionOptions {
    float boundary = 8.0f;   ///< weight of the gradient E along the border, 0 or more
    float floor = 1.0f;      ///< added to squared distances, so that differences far below it do not count; above 0
    float smoothing = 1.0f;  ///< standard deviation in pixels of the Gaussian filter before the gradient; 0: none
    Progress progress;
    /// The pieces to start from: one number per pixel, such as DualPieces::labels() returns. Their 4-connected parts are
    /// merged. If null, every pixel is a piece.
    const std::vector<Index>* pieces = nullptr;
    /// Whether left and right, top and bottom meet: regions then continue across the seam.
    bool wrap_x = false, wrap_y = false;
};

struct [[deprecated("use a ChannelsView and RegionOptions::pieces")]] RegionInput
{
    int width = 0, height = 0;
    std::vector<const float*> channels;
    const std::vector<Index>* pieces = nullptr;
};

/// The merges of a picture's pieces. All regions are 4-connected, and a region is a union of regions of any larger number
/// of regions.
class PIMG_EXPORT RegionTree {
public:
    /// Merges the pieces of `picture`, which has 1 to 64 channels of finite samples and at most 2^30 pixels. How different
    /// two pixels look is measured by the Euclidean distance of their samples. The defaults are meant for CIELAB, where
    /// one unit is about the smallest difference one can see. Fails on pictures outside these limits, when `pieces` are
    /// not one number per pixel, and when `progress` asked to stop; `tree` is then unchanged.
    static Status build(const ChannelsView& picture, const RegionOptions& options, RegionTree& tree);

    template<class Input, class = decltype(Input::pieces)>
    [[deprecated("use a ChannelsView and RegionOptions::pieces")]] static Status build(const Input& input,
                                                                                       RegionOptions options,
                                                                                       RegionTree& tree)
    {
        options.pieces = input.pieces;
        return build(ChannelsView { input.width, input.height, input.channels }, options, tree);
    }

    /// The number of pieces at the start, which is the largest number of regions.
    Index leaves() const { return m_leaves; }

    /// The region of every pixel, row-major, in a cut of `regions` regions. They are numbered from 0 in the order of their
    /// first pixel. A number outside 1 .. leaves() counts as the nearer end of this range. Takes time proportional to the
    /// number of pixels.
    std::vector<Index> labels(Index regions) const;

    /// The number of regions when all merges that cost `threshold` or less have been made.
    Index regions_above(float threshold) const;

    /// The cost of every merge, in the order they were made. A merge that was cheaper than one before it has the cost of
    /// that one, so the costs never fall.
    const std::vector<float>& costs() const { return m_costs; }

    /// Bytes held.
    std::size_t memory() const;

private:
    friend class RegionMerger;
    struct Merge {
        Index kept, gone;  ///< leaves that stand for the two regions
    };
    Index m_leaves = 0;
    std::vector<Index> m_leaf_of;  ///< leaf of every pixel
    std::vector<Merge> m_merges;
    std::vector<float> m_costs;
};

}  // namespace PIMG_ABI
}  // namespace pimg
