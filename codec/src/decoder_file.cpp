// SPDX-License-Identifier: BSD-3-Clause
// The walk over the chunks, and the mesh layer.
#include "decoder_file.h"

#include <algorithm>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

Status damaged(const Chunk& chunk)
{
    return Status::failure(std::string("pimg: chunk ") + chunk.head.type + " at byte " + std::to_string(chunk.offset)
                           + " is damaged");
}

/// Whether `name` is a chunk this reader knows.
bool is_known(const ChunkHead& head)
{
    for (const char* name : { "HEAD", "CHAN", "META", "MESH", "BATC", "RAST", "COLL", "DONE" })
        if (head.is(name))
            return true;
    return false;
}

}  // namespace

/// The chunk at `offset`; false at the end of what the file has, or with a status when it cannot be a chunk.
bool Decoder::File::chunk_at(std::uint64_t offset, Chunk& chunk, Status& status) const
{
    std::uint8_t bytes[kChunkHead];
    if (offset > size || size - offset < kChunkHead + kChunkTail || !source->read(offset, sizeof bytes, bytes))
        return false;
    chunk.offset = offset;
    if (!parse_chunk_head(bytes, chunk.head)) {
        status = Status::failure("pimg: no chunk at byte " + std::to_string(offset));
        return false;
    }
    return chunk.head.length <= size - offset - kChunkHead - kChunkTail;
}

Status Decoder::File::payload(const Chunk& chunk, Bytes& bytes) const
{
    bytes.resize(std::size_t(chunk.head.length) + kChunkHead + kChunkTail);
    if (!source->read(chunk.offset, bytes.size(), bytes.data()))
        return Status::failure("pimg: the file could not be read");
    const std::size_t end = bytes.size() - kChunkTail;
    if (limits.check_crc && crc32(0, bytes.data(), end) != load_u32(bytes.data() + end))
        return damaged(chunk);
    return {};
}

/// Checks the crc of a chunk whose payload is not wanted.
Status Decoder::File::verify(const Chunk& chunk) const
{
    if (!limits.check_crc)
        return {};
    constexpr std::uint64_t kAtOnce = 1 << 16;
    const std::uint64_t end = chunk.end() - kChunkTail;
    Bytes part(std::size_t(std::min(kAtOnce, end - chunk.offset)));
    std::uint32_t crc = 0;
    for (std::uint64_t at = chunk.offset; at < end;) {
        const std::size_t count = std::size_t(std::min<std::uint64_t>(part.size(), end - at));
        if (!source->read(at, count, part.data()))
            return Status::failure("pimg: the file could not be read");
        crc = crc32(crc, part.data(), count);
        at += count;
    }
    std::uint8_t stored[kChunkTail];
    if (!source->read(end, sizeof stored, stored))
        return Status::failure("pimg: the file could not be read");
    return crc == load_u32(stored) ? Status() : damaged(chunk);
}

Status Decoder::File::open()
{
    std::uint8_t signature[sizeof kSignature];
    size = source->size();
    if (size < sizeof signature || !source->read(0, sizeof signature, signature)
        || !is_pimg(signature, sizeof signature))
        return Status::failure("not a pimg file");
    bool channels = false, attributes = false;
    std::uint64_t offset = sizeof signature;
    for (;;) {
        Chunk chunk;
        Status status;
        if (!chunk_at(offset, chunk, status)) {
            // A file that ends after the channels has no picture to show, but one that can be described.
            if (!status.ok() || !channels)
                return status.ok() ? Status::failure("pimg: the file ends within its header") : status;
            break;
        }
        const bool is_head = chunk.head.is("HEAD"), is_channels = chunk.head.is("CHAN"),
                   is_meta = chunk.head.is("META");
        const bool first = offset == sizeof signature;
        if (is_head != first || (is_channels && channels) || (is_meta && (attributes || !channels)))
            return Status::failure("pimg: header chunks are out of order");
        if (is_head || is_channels || is_meta) {
            const std::uint64_t most = is_head ? 4096 : is_channels ? 1024 * 258 : limits.attribute_bytes + 4096;
            if (chunk.head.length > most)
                return Status::failure("pimg: a header chunk is over the limit");
            Bytes bytes;
            status = payload(chunk, bytes);
            if (status)
                status = is_head  ? read_head(body_of(bytes), limits, head, desc)
                    : is_channels ? read_channels(body_of(bytes), limits, head, desc)
                                  : read_attributes(body_of(bytes), limits, desc);
            if (!status)
                return status;
            channels |= is_channels;
            attributes |= is_meta;
        } else if (is_known(chunk.head) || chunk.head.flags & kCritical)
            break;
        else if (chunk.head.length <= limits.attribute_bytes && !(status = verify(chunk)).ok())
            return status;  // it may be the chunk of attributes with a damaged name
        offset = chunk.end();
    }
    if (!channels)
        return Status::failure("pimg: the channels are missing");
    body = offset;
    return {};
}

Status Decoder::File::index() const
{
    const std::lock_guard<std::mutex> lock(mutex);
    if (!indexed) {
        index_status = make_index();
        indexed = true;
    }
    return index_status;
}

Status Decoder::File::make_index() const
{
    std::uint64_t next_tile = 0;
    Status status;
    for (std::uint64_t offset = sizeof kSignature;;) {
        Chunk chunk;
        if (!chunk_at(offset, chunk, status))
            return status;
        if (offset >= body)
            status = add_to_index(chunk, next_tile);
        // The header has been checked, and tiles and the collapse sequence are checked when they are read. All other
        // chunks are checked here, those without a use, too: damage to a name turns a needed chunk into one of these.
        const bool read_elsewhere =
            offset < body ? is_known(chunk.head) : chunk.head.is("RAST") || chunk.head.is("COLL");
        if (status && !read_elsewhere)
            status = verify(chunk);
        if (!status)
            return status;
        all.push_back(chunk);
        offset = whole_bytes = chunk.end();
        if (done)
            return {};
    }
}

/// Puts a chunk where it belongs; the order is MESH, BATC ..., RAST ..., COLL ..., DONE with unknown ancillary ones
/// anywhere.
Status Decoder::File::add_to_index(const Chunk& chunk, std::uint64_t& next_tile) const
{
    const auto misplaced = [&] {
        return Status::failure(std::string("pimg: chunk ") + chunk.head.type + " at byte "
                               + std::to_string(chunk.offset) + " is out of order");
    };
    const std::uint64_t tiles = std::uint64_t(columns()) * rows();
    const bool has_base = base.offset != 0;
    if (chunk.head.is("MESH")) {
        if (has_base)
            return misplaced();
        base = chunk;
    } else if (chunk.head.is("BATC")) {
        if (!has_base || next_tile > 0 || !collapses.empty())
            return misplaced();
        batches.push_back(chunk);
    } else if (chunk.head.is("RAST")) {
        std::uint8_t number[4];
        if (!has_base || !collapses.empty() || chunk.head.length < 4
            || !source->read(chunk.offset + kChunkHead, 4, number))
            return misplaced();
        // Only as many places as the file has tiles for.
        if (load_u32(number) != next_tile || next_tile >= tiles)
            return misplaced();
        tile_offsets.push_back(chunk.offset);
        ++next_tile;
        tiles_found = std::uint32_t(next_tile);
    } else if (chunk.head.is("COLL")) {
        if (next_tile != tiles)
            return misplaced();
        collapses.push_back(chunk);
    } else if (chunk.head.is("DONE")) {
        if (next_tile != tiles)
            return Status::failure("pimg: tiles are missing");
        done = true;
    } else if (is_known(chunk.head))
        return misplaced();
    else if (chunk.head.flags & kCritical)
        return Status::failure(std::string("pimg: chunk ") + chunk.head.type + " needs a newer reader");
    return {};
}

Status Decoder::File::read_layer(double share, MeshLayer& layer_out) const
{
    if (base.offset == 0)
        return Status::failure("pimg: the file ends before its first picture");
    const std::uint64_t most =
        std::min<std::uint64_t>(head.vertices, std::uint64_t(shape_width()) * std::uint64_t(shape_height()));
    MeshLayerReader reader(extent(), desc.channels.size(), most);
    Bytes bytes;
    Status status = payload(base, bytes);
    if (status)
        status = reader.read_base(body_of(bytes).here(), body_of(bytes).left());
    for (const Chunk& batch : batches) {
        if (!status || double(reader.layer().mesh.size()) >= share * double(head.vertices))
            break;
        status = payload(batch, bytes);
        if (status)
            status = reader.read_batches(body_of(bytes).here(), body_of(bytes).left());
    }
    if (status)
        layer_out = reader.take();
    return status;
}

/// Whether the work of showing a mesh on width x height pixels is in proportion to these and to its triangles.
Status Decoder::File::check_effort(const Mesh& mesh, const std::vector<Triangle>& triangles, std::uint32_t width,
                                   std::uint32_t height) const
{
    const std::uint64_t most = most_crossed_rows(std::uint64_t(width) * height, triangles.size());
    return crossed_rows(mesh, triangles, height, desc.data.height) <= most
        ? Status()
        : Status::failure("pimg: the triangles of the mesh layer are too thin to be of a picture");
}

Status Decoder::File::shared_layer(std::shared_ptr<const LayerState>& state) const
{
    const std::lock_guard<std::mutex> lock(mutex);
    if (!layer && layer_status) {
        auto made = std::make_shared<LayerState>();
        layer_status = read_layer(1.0, made->layer);
        if (layer_status) {
            made->grid = TriangleGrid(made->layer.mesh, head.tile);
            layer_status = check_effort(made->layer.mesh, made->grid.triangles(), desc.data.width, desc.data.height);
        }
        if (layer_status)
            layer = made;
    }
    state = layer;
    return layer_status;
}

}  // namespace PIMG_ABI
}  // namespace pimg
