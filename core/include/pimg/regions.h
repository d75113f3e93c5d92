// SPDX-License-Identifier: BSD-3-Clause
// Segmentation (paper, section 4.2): adjacent pieces are merged greedily, cheapest border first, until one is left. The
// picture is analysed once; the merges form a tree, and every number of regions is a cut through it.
#pragma once

#include <vector>

#include <pimg/channels.h>
#include <pimg/types.h>

namespace pimg {

/// What makes a border cheap. With areas n1, n2, distance D of the means, mean strength E of the gradient along the
/// shared border and its length l, it costs
///     w (floor + D^2 + boundary E) (sqrt(min(n1, n2)) / l)^(1/8),    w = n1 n2 / (n1 + n2).
/// w D^2 is what merging adds to the variance inside the regions (Ward 1963). The gradient keeps apart what only
/// differs at the border; the last factor favours long borders, so regions grow compact. How the defaults were found:
/// docs/internals.md.
struct RegionOptions {
    float boundary = 8.0f;   ///< weight of the gradient along the border, in units of the channels, 0 ..
    float floor = 1.0f;      ///< squared distance below which all differences look alike, > 0
    float smoothing = 1.0f;  ///< standard deviation, in pixels, of the Gaussian under the gradient, 0 ..
    Progress progress;
    /// Pieces to start from, one number per pixel, such as DualPieces::labels(); their 4-connected parts
    /// are what is merged. Null: every pixel is a piece.
    const std::vector<Index>* pieces = nullptr;
};

struct [[deprecated("use a ChannelsView and RegionOptions::pieces")]] RegionInput
{
    int width = 0, height = 0;
    std::vector<const float*> channels;
    const std::vector<Index>* pieces = nullptr;
};

/// The merges of a picture's pieces. A coarser cut is a union of regions of every finer cut;
/// regions are 4-connected.
class RegionTree {
public:
    /// Merges the pieces of `picture`: one or more channels of finite samples, whose Euclidean distance is how different
    /// two pixels look. Meant for CIELAB, where one unit is about the smallest difference one can see.
    /// Fails on an empty picture, when `pieces` are not one number per pixel, and when `progress` asked to stop.
    static Status build(const ChannelsView& picture, const RegionOptions& options, RegionTree& tree);

    template<class Input, class = decltype(Input::pieces)>
    [[deprecated("use a ChannelsView and RegionOptions::pieces")]] static Status build(const Input& input,
                                                                                       RegionOptions options,
                                                                                       RegionTree& tree)
    {
        options.pieces = input.pieces;
        return build(ChannelsView { input.width, input.height, input.channels }, options, tree);
    }

    /// Pieces at the start: the largest number of regions there is.
    Index leaves() const { return m_leaves; }

    /// Region of every pixel when `regions` are left (1 .. leaves()), numbered from 0 in order of
    /// their first pixel, row-major. O(pixels).
    std::vector<Index> labels(Index regions) const;

    /// Number of regions left when every border costs more than `threshold`.
    Index regions_above(float threshold) const;

    /// Cost of the merges, cheapest first; made monotone.
    const std::vector<float>& costs() const { return m_costs; }

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

}  // namespace pimg
