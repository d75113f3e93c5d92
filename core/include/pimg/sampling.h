// SPDX-License-Identifier: BSD-3-Clause
// A simpler initial mesh (paper, section 6): pixels chosen by halftoning a control map, triangulated after
// Delaunay. Simplification can start from it instead of from one vertex per pixel; what it cannot
// represent is the residual of Bands.
//
//     samples --control_map--> map --halftone--> pixels --triangulate--> InitialMesh --simplify--> Hierarchy
#pragma once

#include <vector>

#include <pimg/mesh.h>
#include <pimg/types.h>

namespace pimg {

/// What the density of vertices follows.
enum class Control {
    gradient,   ///< squared gradient magnitude, summed over channels: the paper's
    curvature,  ///< squared second derivatives, summed over channels
};

struct SamplingOptions {
    double density = 1.0 / 3;    ///< fraction of the pixels kept, 0..1
    Control control = Control::gradient;
    const float* map = nullptr;  ///< own control map: a value >= 0 per pixel, row-major; used instead of `control`
    ParallelFor parallel;        ///< threads to use; the result does not depend on them
    Progress progress;
};

/// A triangulation of chosen pixels. Vertices are numbered by increasing pixel; half-edge e = 3 t + k of triangle t
/// starts at corners[e] and leads to the triangle's next corner; twins[e] is the same edge from the
/// other side, kGhost on the border.
struct InitialMesh {
    int width = 0, height = 0;    ///< of the mesh's grid, 2 or more
    std::vector<Index> pixels;    ///< row-major pixel of each vertex, increasing; the four corners are always there
    std::vector<Index> corners, twins;

    Index vertices() const { return Index(pixels.size()); }
    std::size_t triangles() const { return corners.size() / 3; }
    Point point(Index v) const
    {
        const Index w = Index(width);
        return { std::int32_t(pixels[v] % w) * kSubpixels, std::int32_t(pixels[v] / w) * kSubpixels };
    }
};

/// Control map of one or more channels (row-major, width x height): a value >= 0 per pixel. Only ratios matter.
std::vector<float> control_map(const std::vector<const float*>& channels, int width, int height, Control control,
                               const ParallelFor& parallel = {});

/// Probability 0..1 of each pixel to be kept: proportional to the map where that stays below 1, with a small even share,
/// so scaled that their mean is `density`.
void to_density(std::vector<float>& map, int width, int height, double density, const ParallelFor& parallel = {});

/// Serpentine error diffusion of such probabilities. Corners are always chosen, and sides are chosen
/// from as densely as their surroundings are. Returns pixels, increasing.
std::vector<Index> halftone(const std::vector<float>& probability, int width, int height);

/// Delaunay triangulation of the chosen pixels (increasing, with the four corners), exact for any choice. Where four or more
/// lie on one circle, the diagonal across which `samples` (one per pixel) jump less is taken. Edges are
/// flipped away from vertices of more than kMaxDegree neighbours; fails when that is impossible.
Status triangulate(std::vector<Index> pixels, int width, int height, const float* samples, InitialMesh& mesh);

/// All of it. The channels hold one finite value per mesh pixel; the first decides diagonals.
/// Fails on sizes and densities out of range, or when `progress` asked to stop.
Status sample(const std::vector<const float*>& channels, int width, int height, const SamplingOptions& options,
              InitialMesh& mesh);

}  // namespace pimg
