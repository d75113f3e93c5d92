// SPDX-License-Identifier: BSD-3-Clause
// Collapses the edges of one tile up to a cost limit, touching nothing outside the tile's zone.
#pragma once

#include <vector>

#include "collapse_record.h"
#include "working_mesh.h"

namespace pimg {

/// What one tile's work leaves behind.
struct TileOutput {
    std::vector<CollapseRecord> records;
    std::vector<Index> deferred;  ///< vertices whose neighbourhood reaches beyond the zone
    std::size_t evaluations = 0, refused = 0;

    void clear()
    {
        records.clear();
        deferred.clear();
        evaluations = refused = 0;
    }
};

class TileWorker {
public:
    TileWorker(WorkingMesh& mesh, Zone zone, float guard, TileOutput& output)
        : m_mesh(mesh), m_zone(zone), m_guard(guard), m_out(output)
    {
    }

    /// Visits the vertices whose key is at most `limit`, of a tile or of a list.
    void run(const Tile& tile, float limit);
    void run(const std::vector<Index>& vertices, float limit);

private:
    /// The star s will have: ring of t from vr to vl, then that of u back to vr.
    struct Star {
        int degree, vl;  ///< place of vl; vr is at 0
        alignas(64) float x[kLanes], y[kLanes], z[kLanes], real[kLanes];  ///< relative to t, pixels
        Index ring[kLanes];
        Point points[kLanes];
    };
    struct Placement {
        float x, y, z;
    };

    void visit(Index v, float limit);
    bool load_fan(Index v);
    int cheapest() const;
    bool load_star(Index t, int j, bool& deferred);
    bool find_placement(int j, float limit, float& cost, Placement& place) const;
    bool keeps_shape(float x, float y) const;
    void collapse(Index t, int j, const Placement& place, float cost);
    void record(Index t, Index u, const Node& s, const Point& s_point, float order);
    void update_sums(Index t, int j, const Placement& place);
    void update_rings(Index t, Index u);

    WorkingMesh& m_mesh;
    Zone m_zone;
    float m_guard;
    TileOutput& m_out;
    EdgeFan m_fan;
    Star m_star;
    std::vector<Index> m_candidates;
};

}  // namespace pimg
