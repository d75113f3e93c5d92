// SPDX-License-Identifier: BSD-3-Clause
// The mesh layer of a file: base mesh, then batches of vertex splits, coarse to fine. A batch goes through the vertices
// in order of their numbers and says of each whether it is split; all references are relative to the ring of the
// vertex, so that no file can name a vertex that is not there.
#pragma once

#include <cstdint>
#include <vector>

#include <pimg/bands.h>
#include <pimg/hierarchy.h>
#include <pimg/types.h>

#include "entropy/binary_coder.h"
#include "mesh_layer/gouraud.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Values of the mesh layer stay within +-2^17.
constexpr std::int32_t kMeshValueLow = -(1 << 17), kMeshValueHigh = (1 << 17) - 1;

/// Every batch splits at least one of this many vertices. This limits the time that reading batches can take.
constexpr Index kSparsestBatch = 256;

/// Constants of one mesh layer.
struct MeshLayerHead {
    std::uint32_t lattice_shift = 4;          ///< positions are multiples of 2^shift lattice units, 0 .. 6
    std::vector<std::uint32_t> value_shifts;  ///< details are multiples of 2^shift, 0 .. 17, per channel
};

/// Adaptive models; they live as long as the layer is read or written.
struct MeshModels {
    explicit MeshModels(std::size_t channels) : detail(channels * 8) { }
    AdaptiveBit flag[64];
    NumberModel vr[17], vl[17];
    NumberModel edge[2][64], middle[2][64];
    std::vector<NumberModel> detail;  ///< [channel][t or u][how large the channel before]
};

/// One vertex split as it is stored.
struct LayerSplit {
    Index s = 0;
    int vr = 0, vl = 0;  ///< places in the ring of s, which starts at its smallest number
    Point t, u;
};

/// Ring of s, starting at the neighbour with the smallest number.
struct CanonicalRing {
    int degree;
    Index vertex[kMaxDegree];
    Point point[kMaxDegree];
    CanonicalRing(const Mesh& mesh, Index s);
    bool has_ghost() const;
    /// Largest distance, along x or y, from `p`.
    std::uint32_t radius(Point p) const;
};

/// Whether splitting s so leaves only positive triangles and the picture's sides as they are.
bool is_split_ok(const Mesh& mesh, const CanonicalRing& ring, const LayerSplit& split);

/// Splits the vertex, and notes the batch for the vertices of the split and those around it. False if the mesh forbids it.
bool apply_split(Mesh& mesh, const CanonicalRing& ring, const LayerSplit& split, std::uint32_t batch,
                 std::vector<std::uint32_t>& touched);

/// Prediction of one channel at a point of the star of s: weights in 1/65536.
struct IntegerStencil {
    Index a, b;
    std::int64_t wa, wb;
    std::int32_t predict(const std::vector<std::int32_t>& z, Index s) const;
};
IntegerStencil integer_stencil(Point p, Point s, const CanonicalRing& ring, int start);

/// Reads the mesh layer chunk by chunk. After every chunk layer() is a picture.
class MeshLayerReader {
public:
    MeshLayerReader(Point extent, std::size_t channels, std::uint64_t max_vertices)
        : m_extent(extent),
          m_max_vertices(max_vertices),
          m_models(channels)
    {
        m_layer.values.resize(channels);
    }
    Status read_base(const std::uint8_t* data, std::size_t size);
    Status read_batches(const std::uint8_t* data, std::size_t size);
    const MeshLayer& layer() const { return m_layer; }
    MeshLayer take() { return std::move(m_layer); }

private:
    bool read_split(BinaryReader& in, Index s);

    Point m_extent;
    std::uint64_t m_max_vertices;
    MeshLayerHead m_head;
    MeshModels m_models;
    MeshLayer m_layer;
    std::vector<std::uint32_t> m_touched;
    std::uint32_t m_batch = 0;
};

/// Reading and writing share the order of fields: `io.number(model, v)` returns v after writing it, or reads it.
template<class Io>
bool code_geometry(Io& io, MeshModels& models, const MeshLayerHead& head, const Mesh& mesh, const CanonicalRing& ring,
                   LayerSplit& split);
template<class Io>
void code_values(Io& io, MeshModels& models, const MeshLayerHead& head, MeshLayer& layer, const CanonicalRing& ring,
                 const LayerSplit& split, const float* targets);
/// Model of the flag that says whether v is split.
AdaptiveBit& flag_model(MeshModels& models, const MeshLayerHead& head, const CanonicalRing& ring, Point p,
                        bool touched);

/// Chunks of a mesh layer: the first is the base, the others hold batches.
struct MeshLayerChunks {
    Bytes base;
    std::vector<Bytes> batches;
    MeshLayer layer;  ///< as a reader will have it
};

/// The first splits of a hierarchy, up to `vertices` vertices, with the bands of each channel in mesh values.
Status write_mesh_layer(const Hierarchy& hierarchy, const std::vector<Bands>& bands, double vertices,
                        MeshLayerChunks& chunks);

}  // namespace PIMG_ABI
}  // namespace pimg
