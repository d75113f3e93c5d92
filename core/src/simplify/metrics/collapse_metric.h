// SPDX-License-Identifier: BSD-3-Clause
// Error metrics other than volume optimisation, for comparison (paper, Fig. 2). What one decides is where the merged
// vertex goes and what that costs; topology, guard, queue and records are shared by all. Plain code: one exact queue,
// no tiles, one thread.
#pragma once

#include <memory>
#include <vector>

#include <pimg/ring.h>
#include <pimg/simplify.h>

#include "simplify/collapse_record.h"

namespace pimg {
inline namespace PIMG_ABI {

/// The mesh while it is being simplified; vertices are mesh pixels and keep their numbers.
struct PlainMesh {
    int width = 0, height = 0;
    std::vector<float> weights;         ///< of each channel in the cost
    std::vector<std::vector<float>> z;  ///< intensity: z[channel][vertex]
    std::vector<Point> points;
    std::vector<Ring> rings;
    std::vector<std::uint8_t> degrees;  ///< 0: merged into another

    /// One vertex per sample; each quad is cut along the diagonal with the smaller jump.
    explicit PlainMesh(const Guide& guide);

    bool on_vertical_side(Index v) const { return points[v].x == 0 || points[v].x == (width - 1) * kSubpixels; }
    bool on_horizontal_side(Index v) const { return points[v].y == 0 || points[v].y == (height - 1) * kSubpixels; }
};

class CollapseMetric {
public:
    static constexpr int kMaxCandidates = 5;  ///< positions of the merged vertex that a metric proposes

    virtual ~CollapseMetric() = default;

    /// Whether t and u may change places: then every edge is looked at from one end only.
    virtual bool is_symmetric() const = 0;

    /// Positions to try for the vertex that t and u become, best first. Sides of the picture and the
    /// shape of triangles are the caller's business. Returns their number.
    virtual int candidates(Index t, Index u, Point* positions) const = 0;

    /// What merging t and u at p costs: not negative.
    virtual double cost(Index t, Index u, Point p) = 0;

    /// Called just before t and u become t at p: sets the intensities of t.
    virtual void merge(Index t, Index u, Point p) = 0;
};

/// Garland & Heckbert 1997: squared distance to the planes of all triangles merged so far.
std::unique_ptr<CollapseMetric> quadric_metric(PlainMesh& mesh);

/// Largest deviation from any pixel, exactly; a vertex goes to where its neighbour is (half-edge collapse).
std::unique_ptr<CollapseMetric> exact_metric(PlainMesh& mesh);

/// Collapses, cheapest first, until nothing can be. False when `progress` asked to stop.
bool collapse_all(PlainMesh& mesh, CollapseMetric& metric, const Progress& progress, CollapseSequence& sequence,
                  SimplifyStats& stats);

}  // namespace PIMG_ABI
}  // namespace pimg
