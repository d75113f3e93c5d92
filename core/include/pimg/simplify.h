// SPDX-License-Identifier: BSD-3-Clause
// Builds a hierarchy: full-edge collapses by memoryless volume optimisation (Lindstrom & Turk 1998,
// 1999; paper, section 3.2) from one vertex per pixel, or a simpler initial mesh, down to a base mesh.
#pragma once

#include <vector>

#include <pimg/bands.h>
#include <pimg/guide.h>
#include <pimg/hierarchy.h>
#include <pimg/sampling.h>
#include <pimg/types.h>

namespace pimg {

/// What a collapse costs and where it puts the vertex. The last two are slower and worse; they are there for comparison
/// (paper, Fig. 2), use one thread, start from one vertex per pixel, and do not preserve the volume.
enum class Metric {
    volume,   ///< memoryless volume optimisation (Lindstrom & Turk 1998, 1999)
    quadric,  ///< squared distance to all planes merged so far (Garland & Heckbert 1997)
    exact,    ///< largest deviation from any pixel, half-edge collapse
};

struct SimplifyOptions {
    Index base_faces = 128;  ///< triangles of the base mesh; 2 (the four corners) or more
    ParallelFor parallel;    ///< threads to use; the result does not depend on them
    Progress progress;
    const InitialMesh* initial = nullptr;  ///< deprecated, use `start`; a mesh that is copied there if that is empty
    Metric metric = Metric::volume;
    InitialMesh start {};  ///< mesh to start from (sampling.h); empty: one vertex per pixel
};

/// What building returns besides the hierarchy.
struct SimplifyStats {
    std::size_t collapses = 0;
    std::size_t evaluations = 0;  ///< rings whose edge costs were computed
    std::size_t refused = 0;      ///< collapses the guard turned down
    std::size_t peak_bytes = 0;   ///< working memory of the engine at its largest
};

/// Simplifies the height field of `guide`. Options that hold a mesh are best moved in, since its memory is given back as
/// soon as it has been read. `bands` receives the guide channels' own bands, whose coarse values preserve
/// the volume under the surface at every level: the mean intensity of every M_i is the picture's.
/// Fails on an empty or oversized guide, on a mesh that is damaged or of another size, or when `progress` asked to stop.
Status simplify(const Guide& guide, SimplifyOptions options, Hierarchy& hierarchy, std::vector<Bands>& bands,
                SimplifyStats* stats = nullptr);

}  // namespace pimg
