// SPDX-License-Identifier: BSD-3-Clause
// Collapses the edges of one tile up to a cost limit, touching nothing outside the tile's zone. Compiled once
// per instruction set and chosen at run time; all give the same bits.
#pragma once

#include <cstddef>
#include <vector>

#include "simplify/collapse_record.h"
#include "simplify/working_mesh.h"

namespace pimg {
inline namespace PIMG_ABI {

/// What a tile's work leaves behind.
struct TileOutput {
    std::vector<CollapseRecord> records;
    std::vector<SplitPair> more;    ///< see CollapseSequence
    std::vector<Index> deferred;    ///< vertices whose neighbourhood reaches beyond the zone
    std::vector<Index> candidates;  ///< scratch
    std::size_t evaluations = 0, refused = 0;

    std::size_t bytes() const
    {
        return records.capacity() * sizeof(CollapseRecord) + more.capacity() * sizeof(SplitPair)
            + (deferred.capacity() + candidates.capacity()) * sizeof(Index);
    }
    void clear()
    {
        records.clear();
        more.clear();
        deferred.clear();
        evaluations = refused = 0;
    }
};

/// How far to go.
struct TileJob {
    Zone zone;
    float limit;  ///< cost up to which edges are collapsed
    float guard;  ///< least twice the area of a triangle over its longest edge squared
};

/// Visits the vertices of a tile whose key is at most the limit, approaching it in a few steps.
void collapse_tile(WorkingMesh& mesh, const Tile& tile, const TileJob& job, TileOutput& output);

/// The same for a list of vertices, in one step.
void collapse_listed(WorkingMesh& mesh, const std::vector<Index>& vertices, const TileJob& job, TileOutput& output);

/// Fills Node::sums of a tile's vertices, and their first keys.
void start_tile(WorkingMesh& mesh, const Tile& tile);

}  // namespace PIMG_ABI
}  // namespace pimg
