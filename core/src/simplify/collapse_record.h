// SPDX-License-Identifier: BSD-3-Clause
// The record of each collapse, and how the sequence of records becomes a hierarchy.
#pragma once

#include <vector>

#include <pimg/bands.h>
#include <pimg/hierarchy.h>
#include <pimg/sampling.h>
#include <pimg/simplify.h>

#include <pimg/detail/flat_array.h>

namespace pimg {
inline namespace PIMG_ABI {

/// One edge collapse; records are in the order in which collapses were done. Vertices are identified by names: the
/// number of the mesh pixel, or of the vertex of the initial mesh, that a vertex started as. s keeps the name of t.
struct CollapseRecord {
    Split split;  ///< s = name of t
    Index u;      ///< name of u
    Stencil stencil;
    float zt, zu;  ///< intensities before the collapse
    float order;   ///< cost, no lower than that of any collapse this one needs
};

/// Records in the order in which collapses were done. Their splits are kept apart from the rest: a hierarchy is filled from
/// one and then from the other, and the first is given back before the memory for the second is taken.
class CollapseRecords {
public:
    /// A record without its split.
    struct Rest {
        Index u;
        Stencil stencil;
        float zt, zu;
        float order;
    };

    std::size_t size() const { return m_splits.size(); }
    std::size_t bytes() const { return size() * (sizeof(Split) + sizeof(Rest)); }
    const FlatArray<Split>& splits() const { return m_splits; }
    const FlatArray<Rest>& rest() const { return m_rest; }  ///< empty after free_rest()

    void reserve(std::size_t n)
    {
        m_splits.reserve(n);
        m_rest.reserve(n);
    }
    /// Appends n records, to be set.
    void extend(std::size_t n)
    {
        m_splits.extend(n);
        m_rest.extend(n);
    }
    void set(std::size_t i, const CollapseRecord& r)
    {
        m_splits[i] = r.split;
        m_rest[i] = { r.u, r.stencil, r.zt, r.zu, r.order };
    }
    void push_back(const CollapseRecord& r)
    {
        extend(1);
        set(size() - 1, r);
    }
    void free_rest() { m_rest = {}; }

private:
    FlatArray<Split> m_splits;
    FlatArray<Rest> m_rest;
};

/// A vertex of the mesh that is left at the end.
struct BaseVertex {
    Index name;
    Point p;
    std::vector<float> z;  ///< of every guide channel
    Ring ring;             ///< by name
    int degree;
};

/// All that is known when nothing is left to collapse.
struct CollapseSequence {
    int channels = 1;
    CollapseRecords records;
    FlatArray<SplitPair> more;  ///< zt and zu of the channels after the first, channels - 1 a record
    std::vector<BaseVertex> base;
};

/// What the finest mesh was made from.
struct Finest {
    const Guide& guide;          ///< samples per mesh pixel
    const InitialMesh* initial;  ///< the mesh whose vertices the names are; null: names are mesh pixels
    const ParallelFor& parallel;
};

/// Sorts the collapses by order (any two that do not depend on each other commute), numbers the vertices by
/// the split that makes them, turns intensities into details, and keeps the coarsest level
/// of at least `base_faces` triangles as base mesh.
Status assemble(int width, int height, const Finest& finest, CollapseSequence&& sequence, Index base_faces,
                Hierarchy& hierarchy, std::vector<Bands>& bands);

}  // namespace PIMG_ABI
}  // namespace pimg
