// SPDX-License-Identifier: BSD-3-Clause
// A simpler initial mesh (paper, section 6). Some of the pixels are chosen by halftoning a control map, and joined by a
// Delaunay triangulation. Simplification can start from this mesh instead of from one vertex per pixel. What the mesh
// cannot represent is kept in the residual of Bands, so the picture can still be restored exactly.
//
//     guide --control_map--> map --to_density--> probabilities --halftone--> pixels --triangulate--> InitialMesh
#pragma once

#include <vector>

#include <pimg/guide.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What the density of vertices follows: a weighted sum over the guide's channels of
enum class Control {
    gradient,   ///< squared differences to the four neighbours, for the paper's squared gradient magnitude
    curvature,  ///< squared second derivatives (the Hessian's)
};

struct SamplingOptions {
    double density = 1.0
        / 3;  ///< share of the pixels that become vertices, above 0, at most 1; fewer if the map is 0 in most places
    Control control = Control::gradient;
    const float* map = nullptr;  ///< your own control map instead of `control`: a value per pixel, row-major, 0 or more
    ParallelFor parallel;        ///< the result does not depend on it
    Progress progress;
};

/// A triangulation of chosen pixels, in half-edges. Vertices are numbered in the order of their pixels. Half-edge
/// e = 3 t + k, with k = 0, 1, 2, belongs to triangle t; it starts at vertex corners[e] and leads to the triangle's next
/// corner. twins[e] is the half-edge along the same edge in the neighbouring triangle, or kGhost on the border.
struct InitialMesh {
    int width = 0, height = 0;  ///< size of the mesh's grid in pixels, each 2 or more
    std::vector<Index>
        pixels;  ///< pixel (row-major) of each vertex, increasing; the four corners are always among them
    std::vector<Index> corners, twins;

    Index vertices() const { return Index(pixels.size()); }
    std::size_t triangles() const { return corners.size() / 3; }
    /// The position of a vertex, in pixels and not in lattice units.
    Point pixel(Index v) const
    {
        return { std::int32_t(pixels[v] % Index(width)), std::int32_t(pixels[v] / Index(width)) };
    }
};

/// The control map of a guide: for each pixel, row-major, the square root of what `control` names. Only ratios of its
/// values matter. The root is taken because the error of an interpolation grows with the first power of a difference;
/// docs/adaptive.md compares the exponents.
PIMG_EXPORT std::vector<float> control_map(const Guide& guide, Control control, const ParallelFor& parallel = {});

/// Replaces a control map by the probability, 0..1, that each pixel becomes a vertex. This is a small share that is the
/// same everywhere (a tenth of `density`) plus a share proportional to the map, cut at 1, and scaled so that the mean of
/// all is `density`. Values that are negative or not a number count as 0.
PIMG_EXPORT void to_density(std::vector<float>& map, double density, const ParallelFor& parallel = {});

/// Chooses pixels by such probabilities (row-major, width x height), with Floyd and Steinberg's error diffusion, whose
/// direction changes from row to row. The four corners are always chosen. Pixels on the picture's sides are chosen with
/// the square root of their probability, so that vertices along a side are as close to each other as those inside.
/// Returns the pixels, increasing.
PIMG_EXPORT std::vector<Index> halftone(const std::vector<float>& probability, int width, int height);

/// The Delaunay triangulation of chosen pixels of the guide: increasing, the four corners among them. It is computed in
/// exact arithmetic. Where four or more pixels lie on one circle, the diagonal along which the guide changes less is
/// taken. Vertices with more than kMaxDegree neighbours lose some by edge flips; where no flip is possible, further
/// pixels near such a vertex become vertices.
PIMG_EXPORT InitialMesh triangulate(std::vector<Index> pixels, const Guide& guide);

/// Does all of the above: chooses the pixels of a guide and triangulates them. Fails when the guide is smaller than
/// 2 x 2 pixels or has no channels, when the density is out of range, when more than 7e8 pixels would be chosen, and when
/// `progress` asked to stop.
PIMG_EXPORT Status sample(const Guide& guide, const SamplingOptions& options, InitialMesh& mesh);

}  // namespace PIMG_ABI
}  // namespace pimg
