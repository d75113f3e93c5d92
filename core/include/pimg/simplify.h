// SPDX-License-Identifier: BSD-3-Clause
// Builds the hierarchy of a picture (paper, section 3.2). It starts from a mesh with one vertex per pixel, or from a
// simpler initial mesh (sampling.h), and collapses edges until the base mesh is left. Where a collapse puts the vertex,
// and which comes first, is found by memoryless volume optimisation (Lindstrom & Turk 1998, 1999).
#pragma once

#include <vector>

#include <pimg/bands.h>
#include <pimg/guide.h>
#include <pimg/hierarchy.h>
#include <pimg/sampling.h>
#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

/// What a collapse costs, and where it puts the vertex. The last two are slower and give worse meshes; they are there for
/// comparison (paper, Fig. 2). They use one thread, can only start from one vertex per pixel, and do not preserve the
/// volume.
enum class Metric {
    volume,   ///< memoryless volume optimisation (Lindstrom & Turk 1998, 1999)
    quadric,  ///< squared distance to all planes merged so far (Garland & Heckbert 1997)
    exact,    ///< largest deviation at any pixel; the vertex stays at one end of the edge
};

struct SimplifyOptions {
    Index base_faces = 128;  ///< triangles of the base mesh, 2 or more; with 2, only the four corners are left
    ParallelFor parallel;    ///< the result does not depend on it
    Progress progress;
    const InitialMesh* initial = nullptr;  ///< deprecated, use `start`; copied to `start` if that is empty
    Metric metric = Metric::volume;
    InitialMesh start {};  ///< the mesh to start from (sampling.h); empty: one vertex per pixel
    /// Collapses that cost no more than this, in units of Hierarchy::costs, are chosen by longest-edge bisection instead of
    /// edge by edge, at most two thirds of all; 0: none. It takes a twentieth of the time, and coarser levels are as good.
    /// A pixel that is d units from the mean of two opposite neighbours costs 8 d^2; coarser vertices, by the square of
    /// their area, more. Has no effect with a mesh to start from, or another metric than volume.
    float bisection = 0.0f;
};

/// Figures of one simplification.
struct SimplifyStats {
    std::size_t collapses = 0;    ///< edges collapsed
    std::size_t evaluations = 0;  ///< how often the costs of all edges of a vertex were computed
    std::size_t refused = 0;      ///< collapses that were turned down because they would have made triangles too thin
    std::size_t peak_bytes = 0;   ///< largest working memory of the engine
};

/// Simplifies the height field of `guide`. `hierarchy` receives the geometry, and `bands` the bands of the guide's
/// channels. With Metric::volume, coarse values preserve the volume under the surface at every level: the mean of every
/// M_i is the picture's. `options` are taken by value: move them in if they hold a mesh, whose memory is then freed as
/// soon as it has been read.
/// Fails on a guide that is empty, larger than 2^20 pixels a side or 2^31 in all, or has too many channels, a channel
/// without samples or a weight that is not above 0; on a mesh to start from that is damaged or of another size; and when
/// `progress` asked to stop. `stats` may be null.
PIMG_EXPORT Status simplify(const Guide& guide, SimplifyOptions options, Hierarchy& hierarchy,
                            std::vector<Bands>& bands, SimplifyStats* stats = nullptr);

}  // namespace PIMG_ABI
}  // namespace pimg
