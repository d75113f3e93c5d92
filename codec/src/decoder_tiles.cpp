// SPDX-License-Identifier: BSD-3-Clause
// Tiles: the mesh layer as it is shown, and the exact samples.
#include "decoder_file.h"

#include <algorithm>

#include "raster/raster_tile.h"
#include "raster/samples.h"

namespace pimg {
inline namespace PIMG_ABI {

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

/// Reads the exact samples of the channels of a tile that are coded together, from number `first` on.
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
        TileChannelReader reader;
        TileChannel channel;
        channel.width = int(points.xs.size());
        channel.height = int(points.ys.size());
        if (!reader.open(in, channel.pixels()))
            return bad();
        if (reader.uses_gouraud()) {
            const Status status = show(points, column, row, first + k, group.mesh[k]);
            if (!status)
                return status;
            channel.gouraud = group.mesh[k].data();
        }
        group.values[k].resize(channel.pixels());
        group.sizes[k].resize(channel.pixels());
        channel.values = group.values[k].data();
        channel.sizes = group.sizes[k].data();
        channel.guide = k > 0 ? group.sizes[k - 1].data() : first > 0 ? group.before.data() : nullptr;
        if (!reader.read(channel))
            return bad();
    }
    group.before.swap(group.sizes[count - 1]);
    return {};
}

/// Undoes the colour transform of the channels from number `first` on, and hands out their samples.
void Decoder::File::finish(std::vector<std::vector<std::int32_t>>& group, std::size_t first, std::uint32_t width,
                           std::uint32_t height, bool exact, const std::vector<StridedChannel>& channels) const
{
    if (first == 0)
        inverse(Transform(head.transform), group);
    for (std::size_t k = 0; k < group.size(); ++k)
        if (channels[first + k].data)
            scatter(desc.channels[first + k].type, group[k], width, height, !exact, channels[first + k], 0, 0);
}

Status Decoder::File::tile(std::uint32_t column, std::uint32_t row, const std::vector<StridedChannel>& channels) const
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
            return Status::failure("pimg: the file became shorter while it was read");
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
        finish(group.values, first, width, height, exact, channels);
    }
    return exact && !in.finished() ? Status::failure("pimg: tile " + std::to_string(number) + " is damaged") : Status();
}

}  // namespace PIMG_ABI
}  // namespace pimg
