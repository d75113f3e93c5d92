// SPDX-License-Identifier: BSD-3-Clause
//     channels --simplify--> hierarchy --smooth--> features, base
//                                |                    |
//                                +---- dual pieces ---+--merge--> cuts of the tree --> borders
#include "drawing/study.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <pimg/detail/parallel.h>
#include <pimg/detail/stop.h>
#include <pimg/dual_pieces.h>
#include <pimg/regions.h>
#include <pimg/simplify.h>
#include <pimg/smoothing.h>

#include "drawing/at_once.h"
#include "drawing/raster_ops.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Strengths of smoothing, in 8-bit steps: the first removes texture and noise, the second all but the important features.
/// Chosen by eye; more makes outlines fewer and smoother.
constexpr float kTexture = 6.0f, kUnimportant = 20.0f;

/// Largest grid that is studied, in cells; finer drawings take what is seen on this one. A sheet of A5 and a pen of 0.4 mm
/// have 0.8e6.
constexpr float kMostCells = 2e6f;

/// Cost up to which collapses are left to bisection (SimplifyOptions): two steps from what the neighbours say.
constexpr float kBisected = 32.0f;

constexpr float kCellsPerPiece = 12.0f;  ///< of the pieces that are merged, on average; less: exacter borders, slower
constexpr float kLabPerStep = 0.39f;     ///< the costs of merging are meant for CIELAB
constexpr int kReach = 2;                ///< cells to either side of a border that know it

/// Square roots of costs at which the tree of segments is cut. Between two, borders count as the lower one.
constexpr std::array<float, 7> kCuts { 12.0f, 24.0f, 48.0f, 96.0f, 192.0f, 384.0f, 768.0f };

ChannelsView view_of(const std::vector<Raster>& rasters)
{
    ChannelsView view { rasters[0].width, rasters[0].height, {} };
    for (const Raster& raster : rasters)
        view.channels.push_back(raster.samples.data());
    return view;
}

Raster mean_of(const std::vector<Raster>& channels)
{
    Raster mean = make_raster(channels[0].width, channels[0].height);
    for (const Raster& channel : channels)
        for (std::size_t i = 0; i < mean.samples.size(); ++i)
            mean.samples[i] += channel.samples[i] / float(channels.size());
    return mean;
}

Hierarchy hierarchy_of(const Raster& mean, const ParallelFor& parallel)
{
    SimplifyOptions options;
    options.parallel = parallel;
    options.bisection = kBisected;
    Hierarchy hierarchy;
    std::vector<Bands> bands;
    // A grid of 2 x 2 to 2e6 cells with one channel is inside all limits, so that nothing can fail.
    simplify({ mean.width, mean.height, { { mean.samples.data(), 1.0f } } }, options, hierarchy, bands);
    return hierarchy;
}

std::vector<Raster> rasters_of(Channels channels, int width, int height)
{
    std::vector<Raster> rasters;
    for (std::vector<float>& channel : channels)
        rasters.push_back({ width, height, std::move(channel) });
    return rasters;
}

/// Gives the cells next to a border of a cut the number `value`.
void mark_borders(const std::vector<Index>& labels, float value, Raster& borders)
{
    const int w = borders.width, h = borders.height;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const std::size_t at = std::size_t(y) * std::size_t(w) + std::size_t(x);
            for (const std::size_t next : { x + 1 < w ? at + 1 : at, y + 1 < h ? at + std::size_t(w) : at })
                if (labels[at] != labels[next])
                    borders.samples[at] = borders.samples[next] = value;
        }
}

/// The largest sample within kReach cells, along one axis: `step` samples from one to the next, `count` in a row.
void spread_along(const std::vector<float>& from, std::vector<float>& to, std::size_t first, std::size_t step,
                  int count)
{
    for (int k = 0; k < count; ++k) {
        float most = 0.0f;
        for (int n = std::max(0, k - kReach); n <= std::min(count - 1, k + kReach); ++n)
            most = std::max(most, from[first + std::size_t(n) * step]);
        to[first + std::size_t(k) * step] = most;
    }
}

void spread(Raster& raster, const ParallelFor& parallel)
{
    const std::size_t w = std::size_t(raster.width);
    std::vector<float> across(raster.samples.size());
    for_rows(parallel, 0, raster.height,
             [&](int y) { spread_along(raster.samples, across, std::size_t(y) * w, 1, raster.width); });
    for_rows(parallel, 0, raster.width,
             [&](int x) { spread_along(across, raster.samples, std::size_t(x), w, raster.height); });
}

/// The number of the piece of every cell.
std::vector<Index> pieces_of(const Hierarchy& hierarchy)
{
    DualPieces pieces;
    if (!DualPieces::from_hierarchy(hierarchy, pieces))
        return {};
    const float count = float(hierarchy.mesh_pixels()) / kCellsPerPiece;
    return pieces.labels(hierarchy.level_of_vertices(double(count)));
}

Raster borders_of(const std::vector<Index>& pieces, const std::vector<Raster>& features)
{
    Raster borders = make_raster(features[0].width, features[0].height);
    std::vector<Raster> scaled = features;
    for (Raster& channel : scaled)
        for (float& sample : channel.samples)
            sample *= kLabPerStep;
    RegionTree tree;
    RegionOptions options;
    options.pieces = &pieces;
    options.floor = 1e-6f;  // borders in flat places are of no importance, however large the segments
    if (!RegionTree::build(view_of(scaled), options, tree))
        return borders;
    for (const float cut : kCuts) {
        stop_point();
        const float root = cut * kLabPerStep;
        const Index regions = tree.regions_above(root * root);
        if (regions < 2)
            break;
        mark_borders(tree.labels(regions), cut, borders);
    }
    return borders;
}

}  // namespace

Study make_study(std::vector<Raster> channels, const ParallelFor& parallel)
{
    const int width = channels[0].width, height = channels[0].height;
    const float scale = std::min(1.0f, std::sqrt(kMostCells / (float(width) * float(height))));
    const int w = std::max(2, int(float(width) * scale)), h = std::max(2, int(float(height) * scale));
    const auto resize = [&](Raster& r, int to_width, int to_height) {
        if (r.width != to_width || r.height != to_height)
            r = resampled(r.samples.data(), r.width, r.height, to_width, to_height, parallel);
    };
    Study study;
    study.mean = mean_of(channels);
    for (Raster& channel : channels)
        resize(channel, w, h);
    const Hierarchy hierarchy = hierarchy_of(mean_of(channels), parallel);
    Channels samples;
    for (Raster& channel : channels)
        samples.push_back(std::move(channel.samples));
    // What is done one step after the other is done beside other work.
    SmoothingSource source;
    std::vector<Index> pieces;
    at_once(
        parallel, [&] { source = analyse_for_smoothing(hierarchy, std::move(samples)); },
        [&] { pieces = pieces_of(hierarchy); });
    Channels features, base;
    smooth(hierarchy, source, { kTexture, parallel }, features);
    study.features = rasters_of(std::move(features), w, h);
    at_once(
        parallel, [&] { study.borders = borders_of(pieces, study.features); },
        [&] {
            smooth(hierarchy, source, { kUnimportant, {} }, base);
        });
    study.base = rasters_of(std::move(base), w, h);
    spread(study.borders, parallel);
    for (std::vector<Raster>* rasters : { &study.features, &study.base })
        for (Raster& raster : *rasters)
            resize(raster, width, height);
    resize(study.borders, width, height);
    return study;
}

}  // namespace PIMG_ABI
}  // namespace pimg
