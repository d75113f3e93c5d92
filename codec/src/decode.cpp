// SPDX-License-Identifier: BSD-3-Clause
// Reading a file: walk the chunks, repeat the mesh layer, decode tiles over it.
#include <algorithm>
#include <atomic>
#include <cstring>

#include <pimg/codec.h>
#include <pimg/detail/parallel.h>

#include "decoder_file.h"
#include "guarded.h"
#include "raster/samples.h"
#include "sequence/collapse_sequence.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

class MemorySource : public Source {
public:
    MemorySource(const void* data, std::size_t size) : m_data(static_cast<const std::uint8_t*>(data)), m_size(size) { }
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

}  // namespace

std::shared_ptr<const Source> memory_source(const void* data, std::size_t size)
{
    return std::make_shared<MemorySource>(data, size);
}

Decoder::Decoder() = default;
Decoder::~Decoder() = default;
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;

namespace {

std::vector<StridedChannel> shifted(const std::vector<StridedChannel>& channels, std::uint32_t x, std::uint32_t y)
{
    std::vector<StridedChannel> moved = channels;
    for (StridedChannel& p : moved)
        if (p.data)
            p.data =
                static_cast<std::uint8_t*>(p.data) + std::ptrdiff_t(x) * p.x_stride + std::ptrdiff_t(y) * p.y_stride;
    return moved;
}

const char* const kChannelCount = "pimg: expected one entry of samples per channel";

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

const PictureDesc& Decoder::desc() const
{
    return m_file->desc;
}
Profile Decoder::profile() const
{
    return Profile(m_file->head.profile);
}
std::uint32_t Decoder::tile() const
{
    return m_file->head.tile;
}
std::uint32_t Decoder::vertices() const
{
    return m_file->head.vertices;
}
std::uint64_t Decoder::sample_hash() const
{
    return m_file->head.hash;
}

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

Status Decoder::read(const std::vector<StridedChannel>& samples, ReadInfo* info, const ParallelFor& parallel) const
{
    return guarded([&]() -> Status {
        const File& f = *m_file;
        if (samples.size() != f.desc.channels.size())
            return Status::failure(kChannelCount);
        Status status = f.index();
        for (const Chunk& chunk : f.collapses)
            if (status)
                status = f.verify(chunk);
        if (!status)
            return status;
        std::mutex mutex;
        std::atomic<bool> failed { false };
        run(parallel, std::size_t(f.columns()) * f.rows(), [&](std::size_t i) {
            if (failed)
                return;
            const std::uint32_t column = std::uint32_t(i % f.columns()), row = std::uint32_t(i / f.columns());
            const Status one =
                guarded([&] { return f.tile(column, row, shifted(samples, column * f.head.tile, row * f.head.tile)); });
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
        const bool all =
            std::all_of(samples.begin(), samples.end(), [](const StridedChannel& p) { return p.data != nullptr; });
        if (found.exact && all && f.head.hash != 0 && f.limits.check_crc) {
            std::vector<ConstStridedChannel> written;
            written.reserve(samples.size());
            for (const StridedChannel& p : samples)
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

Status Decoder::read_tile(std::uint32_t column, std::uint32_t row, const std::vector<StridedChannel>& samples) const
{
    return guarded([&]() -> Status {
        if (samples.size() != m_file->desc.channels.size())
            return Status::failure(kChannelCount);
        if (column >= m_file->columns() || row >= m_file->rows())
            return Status::failure("pimg: there is no such tile");
        const Status status = m_file->index();
        return status ? m_file->tile(column, row, samples) : status;
    });
}

Status Decoder::read_preview(std::uint32_t width, std::uint32_t height, const std::vector<StridedChannel>& samples,
                             double share) const
{
    return guarded([&]() -> Status {
        const File& f = *m_file;
        if (samples.size() != f.desc.channels.size() || width < 1 || height < 1)
            return Status::failure("pimg: expected one entry of samples per channel, and a preview of 1 x 1 or more");
        Status status = f.index();
        MeshLayer layer;
        if (status)
            status = f.read_layer(share, layer);
        if (!status)
            return status;
        const std::vector<Triangle> triangles = ordered_triangles(layer.mesh);
        status = f.check_effort(layer.mesh, triangles, width, height);
        if (!status)
            return status;
        std::vector<Index> numbers(triangles.size());
        for (Index i = 0; i < Index(numbers.size()); ++i)
            numbers[i] = i;
        const SamplePoints points = SamplePoints::spread(f.desc.data.width, f.desc.data.height, width, height);
        for (std::size_t first = 0; first < f.desc.channels.size();) {
            std::vector<std::vector<std::int32_t>> group(f.group_size(first));
            const std::size_t next = first + group.size();
            const bool wanted =
                std::any_of(samples.begin() + std::ptrdiff_t(first), samples.begin() + std::ptrdiff_t(next),
                            [](const StridedChannel& channel) { return channel.data != nullptr; });
            for (std::size_t k = 0; wanted && k < group.size(); ++k) {
                group[k].resize(std::size_t(width) * height);
                fill(layer.mesh, triangles, { numbers.data(), numbers.data() + numbers.size() },
                     layer.values[first + k], mesh_shift(f.desc.channels[first + k].type), points, group[k].data());
            }
            if (wanted)
                f.finish(group, first, width, height, false, samples);
            first = next;
        }
        return {};
    });
}

bool Decoder::has_hierarchy() const
{
    return m_file->index() && m_file->done && !m_file->collapses.empty();
}

Status Decoder::read_hierarchy(const std::vector<ConstStridedChannel>& samples,
                               const std::vector<const float*>& channels, Hierarchy& hierarchy,
                               std::vector<Bands>& bands) const
{
    return guarded([&]() -> Status {
        const File& f = *m_file;
        if (samples.size() != f.desc.channels.size())
            return Status::failure(kChannelCount);
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

}  // namespace PIMG_ABI
}  // namespace pimg
