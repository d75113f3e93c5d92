// SPDX-License-Identifier: BSD-3-Clause
// A simpler initial mesh (paper, section 6): pixels chosen by halftoning a control map, triangulated after
// Delaunay. Simplification can start from it instead of from one vertex per pixel; what it cannot
// represent is the residual of Bands.
//
//     guide --control_map--> map --to_density--> probabilities --halftone--> pixels --triangulate--> InitialMesh
#pragma once

#include <vector>

#include <pimg/guide.h>
#include <pimg/types.h>

namespace pimg {

/// What the density of vertices follows, summed over the guide's channels by weight.
enum class Control {
    gradient,   ///< squared differences to the four neighbours: the paper's squared gradient magnitude
    curvature,  ///< squared second derivatives
};

struct SamplingOptions {
    double density = 1.0 / 3;  ///< largest fraction of the pixels kept, 0..1; less is kept where the map is 0
    Control control = Control::gradient;
    const float* map = nullptr;  ///< own control map: a value >= 0 per pixel, row-major; used instead of `control`
    ParallelFor parallel;        ///< threads to use; the result does not depend on them
    Progress progress;
};

/// A triangulation of chosen pixels. Vertices are numbered by increasing pixel; half-edge e = 3 t + k of triangle t
/// starts at corners[e] and leads to the triangle's next corner; twins[e] is the same edge from the
/// other side, kGhost on the border.
struct InitialMesh {
    int width = 0, height = 0;  ///< of the mesh's grid, 2 or more
    std::vector<Index> pixels;  ///< row-major pixel of each vertex, increasing; the four corners are always there
    std::vector<Index> corners, twins;

    Index vertices() const { return Index(pixels.size()); }
    std::size_t triangles() const { return corners.size() / 3; }
    /// Position of a vertex in pixels.
    Point pixel(Index v) const
    {
        return { std::int32_t(pixels[v] % Index(width)), std::int32_t(pixels[v] / Index(width)) };
    }
};

/// Control map of a guide: the root of what `control` names, per pixel. Only ratios matter. The root because an error
/// of interpolation grows with the first power of a difference: docs/adaptive.md compares the exponents.
std::vector<float> control_map(const Guide& guide, Control control, const ParallelFor& parallel = {});

/// Turns a control map into the probability 0..1 of each pixel to be kept: a small even share, and proportional to the
/// map where that stays below 1, so scaled that their mean is `density`. Values that are no number, or negative, count
/// as 0.
void to_density(std::vector<float>& map, double density, const ParallelFor& parallel = {});

/// Serpentine error diffusion (Floyd and Steinberg) of such probabilities. Corners are always chosen, and pixels of the
/// sides with the root of their probability, which makes neighbours on a side as close as those around it. Returns
/// pixels, increasing.
std::vector<Index> halftone(const std::vector<float>& probability, int width, int height);

/// Delaunay triangulation of chosen pixels of the guide (increasing, with the four corners), exact for any choice.
/// Where four or more lie on one circle, the diagonal across which the guide jumps less is taken. Edges are flipped
/// away from vertices of more than kMaxDegree neighbours; where that is impossible the pixels around such a vertex are
/// added.
InitialMesh triangulate(std::vector<Index> pixels, const Guide& guide);

/// All of it, for a guide of at least 2 x 2 pixels. Fails on sizes and densities out of range, or when `progress`
/// asked to stop.
Status sample(const Guide& guide, const SamplingOptions& options, InitialMesh& mesh);

}  // namespace pimg
