// SPDX-License-Identifier: BSD-3-Clause
// Builds a hierarchy: full-edge collapses by memoryless volume optimisation (Lindstrom & Turk 1998,
// 1999; paper, section 3.2) from one vertex per pixel down to a base mesh.
#pragma once

#include <vector>

#include <pimg/bands.h>
#include <pimg/hierarchy.h>
#include <pimg/types.h>

namespace pimg {

/// Most channels that may decide the geometry together.
constexpr int kMaxGuideChannels = 16;

/// One of the channels that decide the geometry: finite samples, one per pixel, row-major. One unit is about one
/// step of an 8-bit picture: |samples| should be of the order of 255 so that noise and features are told apart
/// on the right scale.
struct GuideChannel {
    const float* samples = nullptr;
    float weight = 1.0f;  ///< of its volume error in the cost, > 0
};

/// What decides the geometry. With several channels each keeps its own volume, so its own intensity follows from the
/// position, and the one position they share minimises the weighted sum of their volume errors.
struct Guide {
    int width = 0, height = 0;
    std::vector<GuideChannel> channels;
};

/// What a collapse costs and where it puts the vertex. The last two are slower and worse; they are there for comparison
/// (paper, Fig. 2), use one thread, and do not preserve the volume.
enum class Metric {
    volume,   ///< memoryless volume optimisation (Lindstrom & Turk 1998, 1999)
    quadric,  ///< squared distance to all planes merged so far (Garland & Heckbert 1997)
    exact,    ///< largest deviation from any pixel, half-edge collapse
};

struct SimplifyOptions {
    Index base_faces = 128;  ///< triangles of the base mesh; 2 (the four corners) or more
    Metric metric = Metric::volume;
    ParallelFor parallel;    ///< threads to use; the result does not depend on them
    Progress progress;
};

/// What building returns besides the hierarchy.
struct SimplifyStats {
    std::size_t collapses = 0;
    std::size_t evaluations = 0;  ///< rings whose edge costs were computed
    std::size_t refused = 0;      ///< collapses the guard turned down
    std::size_t peak_bytes = 0;   ///< working memory of the engine at its largest
};

/// Simplifies the height field of `guide`. `bands` receives the guide channels' own bands, whose coarse values preserve
/// the volume under the surface at every level: the mean intensity of every M_i is the picture's.
/// Fails on an empty or oversized guide, or when `progress` asked to stop.
Status simplify(const Guide& guide, const SimplifyOptions& options, Hierarchy& hierarchy, std::vector<Bands>& bands,
                SimplifyStats* stats = nullptr);

}  // namespace pimg
