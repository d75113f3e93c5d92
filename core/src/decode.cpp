// SPDX-License-Identifier: BSD-3-Clause
// Reading a file: walk the chunks, repeat the mesh layer, decode tiles over it.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <map>
#include <mutex>
#include <new>

#include <pimg/codec.h>

#include "codec_samples.h"
#include "collapse_sequence.h"
#include "container.h"
#include "gouraud.h"
#include "mesh_layer.h"
#include "raster_tile.h"

namespace pimg {

namespace {

class MemorySource : public Source {
public:
    MemorySource(const void* data, std::size_t size) : m_data(static_cast<const std::uint8_t*>(data)), m_size(size) {}
    std::uint64_t size() const override { return m_size; }
    bool read(std::uint64_t offset, std::size_t count, void* to) const override
    {
        if (offset > m_size || count > m_size - offset)
            return false;
        if (count > 0)
            std::memcpy(to, m_data + offset, count);
        return true;
    }

private:
    const std::uint8_t* m_data;
    std::size_t m_size;
};

/// A chunk and where it is; `offset` is that of its head.
struct Chunk {
    ChunkHead head;
    std::uint64_t offset = 0;
    std::uint64_t end() const { return offset + kChunkHead + head.length + kChunkTail; }
};

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

}  // namespace

std::shared_ptr<const Source> memory_source(const void* data, std::size_t size)
{
    return std::make_shared<MemorySource>(data, size);
}

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
    Status open();
    Status index() const;
    Status make_index() const;
    Status add_to_index(const Chunk& chunk, std::uint64_t& next_tile) const;
    Status read_layer(double share, MeshLayer& layer) const;
    Status shared_layer(std::shared_ptr<const LayerState>& state) const;
    Status tile(std::uint32_t column, std::uint32_t row, const std::vector<Plane>& planes) const;
    Status show(const SamplePoints& points, std::uint32_t column, std::uint32_t row, std::size_t c,
                std::vector<std::int32_t>& samples) const;
    Status read_group(ByteReader& in, const SamplePoints& points, std::uint32_t column, std::uint32_t row,
                      std::size_t first, TileGroup& group) const;
    void finish(std::vector<std::vector<std::int32_t>>& group, std::size_t first, std::uint32_t width,
                std::uint32_t height, bool exact, const std::vector<Plane>& planes) const;
    std::size_t group_size(std::size_t first) const
    {
        return std::min<std::size_t>(kTransformChannels, desc.channels.size() - first);
    }
};

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

namespace {

ByteReader body_of(const Bytes& chunk)
{
    return { chunk.data() + kChunkHead, chunk.size() - kChunkHead - kChunkTail };
}

}  // namespace

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
            // A prefix that ends behind the channels is a picture to describe, if not to show.
            if (!status.ok() || !channels)
                return status.ok() ? Status::failure("pimg: the file ends within its header") : status;
            break;
        }
        const bool is_head = chunk.head.is("HEAD"), is_channels = chunk.head.is("CHAN"), is_meta = chunk.head.is("META");
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
                status = is_head       ? read_head(body_of(bytes), limits, head, desc)
                         : is_channels ? read_channels(body_of(bytes), limits, head, desc)
                                       : read_attributes(body_of(bytes), limits, desc);
            if (!status)
                return status;
            channels |= is_channels;
            attributes |= is_meta;
        } else if (is_known(chunk.head) || chunk.head.flags & kCritical)
            break;
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
    const std::uint64_t most = std::min<std::uint64_t>(head.vertices, std::uint64_t(shape_width()) * std::uint64_t(shape_height()));
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

Status Decoder::File::shared_layer(std::shared_ptr<const LayerState>& state) const
{
    const std::lock_guard<std::mutex> lock(mutex);
    if (!layer && layer_status) {
        auto made = std::make_shared<LayerState>();
        layer_status = read_layer(1.0, made->layer);
        if (layer_status) {
            made->grid = TriangleGrid(made->layer.mesh, head.tile);
            layer = made;
        }
    }
    state = layer;
    return layer_status;
}

/// One channel of a tile as the mesh layer shows it.
Status Decoder::File::show(const SamplePoints& points, std::uint32_t column, std::uint32_t row, std::size_t c,
                           std::vector<std::int32_t>& samples) const
{
    std::shared_ptr<const LayerState> state;
    const Status status = shared_layer(state);
    if (status) {
        samples.resize(points.xs.size() * points.ys.size());
        fill(state->layer.mesh, state->grid.triangles(), state->grid.at(column, row), state->layer.values[c],
             mesh_shift(desc.channels[c].type), points, samples.data());
    }
    return status;
}

/// Channels first ... of a tile, exactly.
Status Decoder::File::read_group(ByteReader& in, const SamplePoints& points, std::uint32_t column, std::uint32_t row,
                                 std::size_t first, TileGroup& group) const
{
    const auto bad = [&] {
        return Status::failure("pimg: tile " + std::to_string(row * columns() + column) + " is damaged");
    };
    const std::size_t count = group.values.size();
    group.mesh.resize(count);
    group.sizes.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        TilePlaneReader reader;
        TilePlane plane;
        plane.width = int(points.xs.size());
        plane.height = int(points.ys.size());
        if (!reader.open(in, plane.pixels()))
            return bad();
        if (reader.uses_gouraud()) {
            const Status status = show(points, column, row, first + k, group.mesh[k]);
            if (!status)
                return status;
            plane.gouraud = group.mesh[k].data();
        }
        group.values[k].resize(plane.pixels());
        group.sizes[k].resize(plane.pixels());
        plane.values = group.values[k].data();
        plane.sizes = group.sizes[k].data();
        plane.guide = k > 0 ? group.sizes[k - 1].data() : first > 0 ? group.before.data() : nullptr;
        if (!reader.read(plane))
            return bad();
    }
    group.before.swap(group.sizes[count - 1]);
    return {};
}

/// Undoes the colour transform of channels first ... and hands out their samples.
void Decoder::File::finish(std::vector<std::vector<std::int32_t>>& group, std::size_t first, std::uint32_t width,
                           std::uint32_t height, bool exact, const std::vector<Plane>& planes) const
{
    if (first == 0)
        inverse(Transform(head.transform), group);
    for (std::size_t k = 0; k < group.size(); ++k)
        if (planes[first + k].data)
            scatter(desc.channels[first + k].type, group[k], width, height, !exact, planes[first + k], 0, 0);
}

Status Decoder::File::tile(std::uint32_t column, std::uint32_t row, const std::vector<Plane>& planes) const
{
    const std::uint32_t x = column * head.tile, y = row * head.tile;
    const std::uint32_t width = std::min<std::uint32_t>(head.tile, desc.data.width - x);
    const std::uint32_t height = std::min<std::uint32_t>(head.tile, desc.data.height - y);
    const std::size_t number = std::size_t(row) * columns() + column;
    const SamplePoints points = SamplePoints::rectangle(x, y, width, height);
    Bytes bytes;
    ByteReader in(nullptr, 0);
    const bool exact = number < tile_offsets.size();
    Status status;
    if (exact) {
        Chunk chunk;
        if (!chunk_at(tile_offsets[number], chunk, status))
            return Status::failure("pimg: the file shrank");
        status = payload(chunk, bytes);
        if (!status)
            return status;
        in = body_of(bytes);
        in.u32();
    }
    TileGroup group;
    for (std::size_t first = 0; first < desc.channels.size(); first += group.values.size()) {
        group.values.resize(group_size(first));
        if (exact)
            status = read_group(in, points, column, row, first, group);
        for (std::size_t k = 0; !exact && status && k < group.values.size(); ++k)
            status = show(points, column, row, first + k, group.values[k]);
        if (!status)
            return status;
        finish(group.values, first, width, height, exact, planes);
    }
    return exact && !in.finished() ? Status::failure("pimg: tile " + std::to_string(number) + " is damaged") : Status();
}

// --------------------------------------------------------------------------------------------------------------- Decoder

Decoder::Decoder() = default;
Decoder::~Decoder() = default;
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;

namespace {

/// Nothing thrown leaves the library; memory is what can run out.
template<class Body>
Status guarded(Body&& body)
{
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return Status::failure("pimg: out of memory");
    } catch (const std::length_error&) {
        return Status::failure("pimg: out of memory");
    }
}

std::vector<Plane> shifted(const std::vector<Plane>& planes, std::uint32_t x, std::uint32_t y)
{
    std::vector<Plane> moved = planes;
    for (Plane& p : moved)
        if (p.data)
            p.data = static_cast<std::uint8_t*>(p.data) + std::ptrdiff_t(x) * p.x_stride + std::ptrdiff_t(y) * p.y_stride;
    return moved;
}

const char* const kPlaneCount = "pimg: one plane per channel is needed";

}  // namespace

Status Decoder::open(std::shared_ptr<const Source> source, const DecodeLimits& limits)
{
    m_file.reset();
    return guarded([&] {
        auto file = std::make_unique<File>();
        file->source = std::move(source);
        file->limits = limits;
        const Status status = file->open();
        if (status)
            m_file = std::move(file);
        return status;
    });
}

const PictureDesc& Decoder::desc() const { return m_file->desc; }
Profile Decoder::profile() const { return Profile(m_file->head.profile); }
std::uint32_t Decoder::tile() const { return m_file->head.tile; }
std::uint64_t Decoder::sample_hash() const { return m_file->head.hash; }

Status Decoder::chunks(std::vector<ChunkInfo>& list) const
{
    return guarded([&] {
        const Status status = m_file->index();
        list.clear();
        for (const Chunk& chunk : m_file->all) {
            list.push_back({ {}, chunk.offset, chunk.head.length });
            std::memcpy(list.back().type, chunk.head.type, 5);
        }
        return status;
    });
}

Status Decoder::read(const std::vector<Plane>& samples, ReadInfo* info, const ParallelFor& parallel) const
{
    return guarded([&]() -> Status {
        const File& f = *m_file;
        if (samples.size() != f.desc.channels.size())
            return Status::failure(kPlaneCount);
        Status status = f.index();
        if (!status)
            return status;
        std::mutex mutex;
        std::atomic<bool> failed { false };
        run(parallel, std::size_t(f.columns()) * f.rows(), [&](std::size_t i) {
            if (failed)
                return;
            const std::uint32_t column = std::uint32_t(i % f.columns()), row = std::uint32_t(i / f.columns());
            const Status one = guarded(
                [&] { return f.tile(column, row, shifted(samples, column * f.head.tile, row * f.head.tile)); });
            if (!one) {
                failed = true;
                const std::lock_guard<std::mutex> lock(mutex);
                status = one;
            }
        });
        if (!status)
            return status;
        ReadInfo found;
        found.tiles = f.tiles_found;
        found.exact = std::uint64_t(found.tiles) == std::uint64_t(f.columns()) * f.rows();
        found.bytes = f.whole_bytes;
        if (f.layer)
            found.vertices = f.layer->layer.mesh.size();
        const bool all = std::all_of(samples.begin(), samples.end(), [](const Plane& p) { return p.data != nullptr; });
        if (found.exact && all && f.head.hash != 0 && f.limits.check_crc) {
            std::vector<ConstPlane> written;
            for (const Plane& p : samples)
                written.push_back({ p.data, p.x_stride, p.y_stride });
            found.hash_checked = true;
            if (hash_samples(f.desc, written) != f.head.hash)
                return Status::failure("pimg: the samples are not those that were written (hash)");
        }
        if (info)
            *info = found;
        return {};
    });
}

Status Decoder::read_tile(std::uint32_t column, std::uint32_t row, const std::vector<Plane>& samples) const
{
    return guarded([&]() -> Status {
        if (samples.size() != m_file->desc.channels.size())
            return Status::failure(kPlaneCount);
        if (column >= m_file->columns() || row >= m_file->rows())
            return Status::failure("pimg: there is no such tile");
        const Status status = m_file->index();
        return status ? m_file->tile(column, row, samples) : status;
    });
}

Status Decoder::read_preview(std::uint32_t width, std::uint32_t height, const std::vector<Plane>& samples,
                             double share) const
{
    return guarded([&]() -> Status {
        const File& f = *m_file;
        if (samples.size() != f.desc.channels.size() || width < 1 || height < 1)
            return Status::failure(kPlaneCount);
        Status status = f.index();
        MeshLayer layer;
        if (status)
            status = f.read_layer(share, layer);
        if (!status)
            return status;
        const std::vector<Triangle> triangles = ordered_triangles(layer.mesh);
        std::vector<Index> numbers(triangles.size());
        for (Index i = 0; i < Index(numbers.size()); ++i)
            numbers[i] = i;
        const SamplePoints points = SamplePoints::spread(f.desc.data.width, f.desc.data.height, width, height);
        for (std::size_t first = 0; first < f.desc.channels.size();) {
            std::vector<std::vector<std::int32_t>> group(f.group_size(first));
            for (std::size_t k = 0; k < group.size(); ++k) {
                group[k].resize(std::size_t(width) * height);
                fill(layer.mesh, triangles, numbers, layer.values[first + k], mesh_shift(f.desc.channels[first + k].type),
                     points, group[k].data());
            }
            f.finish(group, first, width, height, false, samples);
            first += group.size();
        }
        return {};
    });
}

bool Decoder::has_hierarchy() const
{
    return m_file->index() && m_file->done && !m_file->collapses.empty();
}

Status Decoder::read_hierarchy(const std::vector<ConstPlane>& samples, const std::vector<const float*>& channels,
                               Hierarchy& hierarchy, std::vector<Bands>& bands) const
{
    return guarded([&]() -> Status {
        const File& f = *m_file;
        if (samples.size() != f.desc.channels.size())
            return Status::failure(kPlaneCount);
        Status status = f.index();
        if (status && (f.collapses.empty() || !f.done))
            status = Status::failure("pimg: there is no hierarchy in this file");
        if (!status)
            return status;
        std::vector<Bytes> bytes(f.collapses.size());
        std::vector<ByteSpan> spans;
        for (std::size_t i = 0; status && i < bytes.size(); ++i) {
            status = f.payload(f.collapses[i], bytes[i]);
            spans.push_back({ body_of(bytes[i]).here(), body_of(bytes[i]).left() });
        }
        if (!status)
            return status;
        return read_collapse_sequence(spans, int(f.desc.data.width), int(f.desc.data.height),
                                      diagonal_guide(f.desc, samples), channels, hierarchy, bands);
    });
}

}  // namespace pimg
