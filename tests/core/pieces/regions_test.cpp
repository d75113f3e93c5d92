// SPDX-License-Identifier: BSD-3-Clause
// Properties of the merge tree: the count asked for, connected, nested, deterministic, and sensible.
#include <pimg/regions.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <pimg/dual_pieces.h>
#include <pimg/simplify.h>

#include "core/pictures.h"

namespace pimg {
namespace {

using test::Picture;

RegionTree tree_of(const Picture& p, const std::vector<Index>* pieces = nullptr)
{
    RegionTree tree;
    RegionOptions options;
    options.pieces = pieces;
    const Status s = RegionTree::build({ p.width, p.height, { p.samples.data() } }, options, tree);
    EXPECT_TRUE(s.ok()) << p.name << ": " << s.error();
    return tree;
}

std::vector<Index> dual_pieces_of(const Picture& p, double fraction)
{
    Hierarchy hierarchy;
    std::vector<Bands> bands;
    DualPieces pieces;
    EXPECT_TRUE(simplify({ p.width, p.height, { { p.samples.data() } } }, {}, hierarchy, bands).ok());
    EXPECT_TRUE(DualPieces::from_hierarchy(hierarchy, pieces).ok());
    return pieces.labels(hierarchy.level_of_vertices(fraction * double(p.samples.size())));
}

Index count(const std::vector<Index>& labels)
{
    return *std::max_element(labels.begin(), labels.end()) + 1;
}

void expect_connected(const Picture& p, const std::vector<Index>& labels, Index regions)
{
    std::vector<Index> parts = labels;
    EXPECT_EQ(connected_parts(parts, p.width, p.height), regions) << p.name;
    EXPECT_EQ(parts, labels) << p.name << ": not numbered in order of their first pixel";
}

TEST(RegionTree, GivesEveryCountConnectedAndNested)
{
    const Picture p = test::scene(23, 19);
    const RegionTree tree = tree_of(p);
    ASSERT_EQ(tree.leaves(), 23u * 19u);
    std::vector<Index> fine = tree.labels(tree.leaves());
    for (Index regions = tree.leaves(); regions >= 1; --regions) {
        const std::vector<Index> labels = tree.labels(regions);
        ASSERT_EQ(count(labels), regions);
        expect_connected(p, labels, regions);
        // One region of the finer cut has joined another, the rest are the same.
        std::vector<Index> coarse_of(count(fine), kGhost);
        for (std::size_t i = 0; i < labels.size(); ++i) {
            Index& coarse = coarse_of[fine[i]];
            ASSERT_TRUE(coarse == kGhost || coarse == labels[i]) << regions;
            coarse = labels[i];
        }
        fine = labels;
    }
}

TEST(RegionTree, TakesAwkwardPictures)
{
    for (const Picture& p : test::awkward_pictures()) {
        const RegionTree tree = tree_of(p);
        for (Index wanted : { 1u, 2u, 5u, 100000000u }) {
            const Index regions = std::min(wanted, Index(p.samples.size()));
            const std::vector<Index> labels = tree.labels(wanted);
            EXPECT_EQ(count(labels), regions) << p.name;
            expect_connected(p, labels, regions);
        }
    }
}

TEST(RegionTree, StartsFromTheConnectedPartsOfPieces)
{
    const Picture p = test::scene(96, 64);
    const std::vector<Index> pieces = dual_pieces_of(p, 0.2);
    const RegionTree tree = tree_of(p, &pieces);
    EXPECT_GE(tree.leaves(), count(pieces));
    EXPECT_LT(tree.leaves(), Index(p.samples.size()) / 2);
    const std::vector<Index> leaves = tree.labels(tree.leaves());
    std::vector<Index> piece_of(tree.leaves(), kGhost);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        Index& piece = piece_of[leaves[i]];
        ASSERT_TRUE(piece == kGhost || piece == pieces[i]);
        piece = pieces[i];
    }
    expect_connected(p, tree.labels(40), 40);
}

TEST(RegionTree, FindsFlatRegionsExactly)
{
    // Four quadrants and a disc, barely different, no noise.
    const auto region = [](int x, int y) {
        return std::hypot(double(x - 30), double(y - 25)) < 12 ? 4 : (x < 32) + 2 * (y < 27);
    };
    const Picture p = test::make("quadrants", 64, 48, [&](int x, int y) { return 50 + 3 * region(x, y); });
    const std::vector<Index> labels = tree_of(p).labels(5);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x + 1 < 64; ++x)
            EXPECT_EQ(labels[std::size_t(y * 64 + x)] == labels[std::size_t(y * 64 + x + 1)],
                      region(x, y) == region(x + 1, y))
                << x << " " << y;
}

TEST(RegionTree, ThresholdCutsAtTheCost)
{
    const Picture p = test::scene(40, 30);
    const RegionTree tree = tree_of(p);
    EXPECT_TRUE(std::is_sorted(tree.costs().begin(), tree.costs().end()));
    EXPECT_EQ(tree.regions_above(-1.0f), tree.leaves());
    EXPECT_EQ(tree.regions_above(tree.costs().back()), 1u);
    const float middle = tree.costs()[tree.costs().size() - 10];
    const Index regions = tree.regions_above(middle);
    EXPECT_LE(regions, 10u);
    EXPECT_GT(tree.costs()[tree.leaves() - regions], middle);
}

TEST(RegionTree, SeesEveryChannel)
{
    // The two halves differ in the second channel only.
    const Picture flat = test::make("flat", 20, 20, [](int, int) { return 50; });
    const Picture halves = test::make("halves", 20, 20, [](int x, int) { return x < 7 ? 10 : 20; });
    RegionTree tree;
    const ChannelsView picture { 20, 20, { flat.samples.data(), halves.samples.data() } };
    ASSERT_TRUE(RegionTree::build(picture, {}, tree).ok());
    const std::vector<Index> labels = tree.labels(2);
    for (std::size_t i = 0; i < labels.size(); ++i)
        EXPECT_EQ(labels[i], i % 20 < 7 ? 0u : 1u);
}

TEST(RegionTree, RefusesWhatIsNoPicture)
{
    const float sample = 0.0f;
    const std::vector<Index> pieces(3);
    RegionTree tree;
    EXPECT_FALSE(RegionTree::build({ 0, 4, { &sample } }, {}, tree).ok());
    EXPECT_FALSE(RegionTree::build({ 1, 1, {} }, {}, tree).ok());
    RegionOptions wrong_pieces;
    wrong_pieces.pieces = &pieces;
    EXPECT_FALSE(RegionTree::build({ 1, 1, { &sample } }, wrong_pieces, tree).ok());
    RegionOptions stop;
    stop.progress = [](float) {
        return false;
    };
    const Picture p = test::scene(300, 300);
    EXPECT_FALSE(RegionTree::build({ 300, 300, { p.samples.data() } }, stop, tree).ok());
}

}  // namespace
}  // namespace pimg
