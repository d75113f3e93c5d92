// SPDX-License-Identifier: BSD-3-Clause
// A .pimg file being read: what its chunks are and where, and from them the mesh layer and the tiles.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include <pimg/codec.h>

#include "container.h"
#include "mesh_layer/gouraud.h"
#include "mesh_layer/mesh_layer.h"

namespace pimg {
inline namespace PIMG_ABI {

/// A chunk and where it is; `offset` is that of its head.
struct Chunk {
    ChunkHead head;
    std::uint64_t offset = 0;
    std::uint64_t end() const { return offset + kChunkHead + head.length + kChunkTail; }
};

/// The payload within the bytes of a chunk.
inline ByteReader body_of(const Bytes& chunk)
{
    return { chunk.data() + kChunkHead, chunk.size() - kChunkHead - kChunkTail };
}

/// Channels of a tile that are decoded together.
struct TileGroup {
    std::vector<std::vector<std::int32_t>> values, mesh;
    std::vector<std::vector<std::uint16_t>> sizes;
    std::vector<std::uint16_t> before;  ///< sizes of the channel before the first
};

/// The mesh layer as far as the file has it.
struct LayerState {
    MeshLayer layer;
    TriangleGrid grid;
};

struct Decoder::File {
    std::shared_ptr<const Source> source;
    std::uint64_t size = 0;
    DecodeLimits limits;
    FileHead head;
    PictureDesc desc;
    std::uint64_t body = 0;  ///< offset of the first chunk after the header chunks

    /// Everything found by the walk over the chunks, made by whoever needs it first.
    mutable std::mutex mutex;
    mutable bool indexed = false;
    mutable Status index_status;
    mutable Chunk base;
    mutable std::vector<Chunk> batches, collapses, all;
    mutable std::vector<std::uint64_t> tile_offsets;  ///< of the chunk heads, 0: not there
    mutable std::uint32_t tiles_found = 0;
    mutable std::uint64_t whole_bytes = 0;
    mutable bool done = false;
    mutable Status layer_status;
    mutable std::shared_ptr<const LayerState> layer;

    std::uint32_t columns() const { return (desc.data.width + head.tile - 1) / head.tile; }
    std::uint32_t rows() const { return (desc.data.height + head.tile - 1) / head.tile; }
    int shape_width() const { return std::max(2, int(desc.data.width)); }
    int shape_height() const { return std::max(2, int(desc.data.height)); }
    Point extent() const { return { (shape_width() - 1) * kSubpixels, (shape_height() - 1) * kSubpixels }; }

    bool chunk_at(std::uint64_t offset, Chunk& chunk, Status& status) const;
    Status payload(const Chunk& chunk, Bytes& bytes) const;
    Status verify(const Chunk& chunk) const;
    Status open();
    Status index() const;
    Status make_index() const;
    Status add_to_index(const Chunk& chunk, std::uint64_t& next_tile) const;
    Status read_layer(double share, MeshLayer& layer) const;
    Status check_effort(const Mesh& mesh, const std::vector<Triangle>& triangles, std::uint32_t width,
                        std::uint32_t height) const;
    Status shared_layer(std::shared_ptr<const LayerState>& state) const;
    Status tile(std::uint32_t column, std::uint32_t row, const std::vector<StridedChannel>& channels) const;
    Status show(const SamplePoints& points, std::uint32_t column, std::uint32_t row, std::size_t c,
                std::vector<std::int32_t>& samples) const;
    Status read_group(ByteReader& in, const SamplePoints& points, std::uint32_t column, std::uint32_t row,
                      std::size_t first, TileGroup& group) const;
    void finish(std::vector<std::vector<std::int32_t>>& group, std::size_t first, std::uint32_t width,
                std::uint32_t height, bool exact, const std::vector<StridedChannel>& channels) const;
    std::size_t group_size(std::size_t first) const
    {
        return std::min<std::size_t>(kTransformChannels, desc.channels.size() - first);
    }
};

}  // namespace PIMG_ABI
}  // namespace pimg
