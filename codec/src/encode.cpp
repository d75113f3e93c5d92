// SPDX-License-Identifier: BSD-3-Clause
// Writing a file: samples -> integers -> colour transform; hierarchy -> mesh layer; tiles; collapse sequence.
#include <algorithm>
#include <cmath>

#include <pimg/codec.h>
#include <pimg/detail/parallel.h>
#include <pimg/detail/rec709.h>
#include <pimg/simplify.h>

#include "container.h"
#include "guarded.h"
#include "mesh_layer/gouraud.h"
#include "mesh_layer/mesh_layer.h"
#include "raster/raster_tile.h"
#include "raster/samples.h"
#include "sequence/collapse_sequence.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

class Encoder {
public:
    Encoder(const PictureDesc& desc, const std::vector<ConstStridedChannel>& samples, const EncodeOptions& options)
        : m_desc(desc),
          m_samples(samples),
          m_options(options)
    {
    }
    Status run(Bytes& file, EncodeStats& stats);

private:
    bool progress(float done) const { return !m_options.progress || m_options.progress(done); }
    Transform choose_transform() const;
    Status build_hierarchy();
    std::uint32_t lattice_shift() const;
    Status make_mesh_layer(MeshLayerChunks& chunks);
    Bytes write_tile(std::uint32_t column, std::uint32_t row, const MeshLayerChunks& chunks,
                     const TriangleGrid& grid) const;
    void make_tiles(const MeshLayerChunks& chunks, std::vector<Bytes>& tiles) const;
    void write_front(const MeshLayerChunks& chunks, Bytes& file, EncodeStats& stats) const;

    const PictureDesc& m_desc;
    const std::vector<ConstStridedChannel>& m_samples;
    const EncodeOptions& m_options;
    Integers m_integers;
    Transform m_transform = Transform::none;
    Hierarchy m_own;
    const Hierarchy* m_hierarchy = nullptr;
};

/// The luma of the picture: a weighted sum of the first three channels, or else the first channel. The built-in guide
/// and the choice of diagonals use it.
std::vector<float> luma(const PictureDesc& desc, const Integers& integers)
{
    std::vector<float> z(integers.channels[0].begin(), integers.channels[0].end());
    const auto& c = desc.channels;
    const auto [r, g, b] = elementary::kRec709Weights;
    if (c.size() >= 3 && c[0].type == c[1].type && c[0].type == c[2].type)
        for (std::size_t i = 0; i < z.size(); ++i)
            z[i] = r * z[i] + g * float(integers.channels[1][i]) + b * float(integers.channels[2][i]);
    // The bulk of the values gets the range of an 8-bit picture; what lies far outside is cut off.
    std::vector<float> some;
    for (std::size_t i = 0; i < z.size(); i += 1 + z.size() / 4096)
        some.push_back(z[i]);
    std::sort(some.begin(), some.end());
    const bool bytes = c[0].type == SampleType::uint8;
    const float low = bytes ? 0.0f : some[some.size() / 100];
    const float range = bytes ? 255.0f : std::max(some[some.size() - 1 - some.size() / 100] - low, 1.0f);
    for (float& v : z)
        v = std::clamp((v - low) * (255.0f / range), -255.0f, 510.0f);
    return z;
}

/// The transform that leaves the smallest residuals on a few strips of the picture.
Transform Encoder::choose_transform() const
{
    Transform best = Transform::none;
    if (!allows(m_desc, Transform::ycocg))
        return best;
    std::uint64_t least = ~0ull;
    for (Transform t : { Transform::none, Transform::ycocg, Transform::green }) {
        std::uint64_t bits = 0;
        const std::uint32_t height = std::min<std::uint32_t>(m_integers.height, 24);
        const std::uint32_t strips = std::min<std::uint32_t>(8, m_integers.height / height);
        for (std::uint32_t s = 0; s < strips; ++s) {
            const std::size_t first =
                std::size_t(std::uint64_t(m_integers.height - height) * s / std::max(1u, strips - 1))
                * m_integers.width;
            const std::size_t count = std::size_t(height) * m_integers.width;
            std::vector<std::vector<std::int32_t>> strip;
            for (std::size_t c = 0; c < 3; ++c)
                strip.emplace_back(m_integers.channels[c].begin() + std::ptrdiff_t(first),
                                   m_integers.channels[c].begin() + std::ptrdiff_t(first + count));
            forward(t, strip);
            std::vector<std::uint16_t> sizes(count), before(count);
            for (std::size_t c = 0; c < 3; ++c) {
                const TileChannel channel { int(m_integers.width),           int(height), strip[c].data(), nullptr,
                                            c > 0 ? before.data() : nullptr, sizes.data() };
                bits += estimate_tile_channel(channel, {});
                sizes.swap(before);
            }
        }
        if (bits < least) {
            least = bits;
            best = t;
        }
    }
    return best;
}

Status Encoder::build_hierarchy()
{
    m_hierarchy = m_options.hierarchy;
    if (m_hierarchy) {
        const bool fits = m_hierarchy->width == int(m_desc.data.width) && m_hierarchy->height == int(m_desc.data.height)
            && !m_hierarchy->empty();
        return fits ? Status() : Status::failure("pimg: the hierarchy is empty or for a picture of another size");
    }
    const std::vector<float> guide = luma(m_desc, m_integers);
    SimplifyOptions options;
    options.parallel = m_options.parallel;
    options.base_faces = Index(std::clamp<std::size_t>(m_desc.pixels() / 512, 2, 128));
    if (m_options.progress)
        options.progress = [&](float done) {
            return m_options.progress(0.5f * done);
        };
    std::vector<Bands> bands;
    const Status status = simplify({ int(m_desc.data.width), int(m_desc.data.height), { { guide.data(), 1.0f } } },
                                   options, m_own, bands);
    m_hierarchy = &m_own;
    return status;
}

/// Positions are stored exactly, except for a picture of a single 8-bit channel, where they would take more bytes than
/// the samples: there they are rounded to 1/16 pixel.
std::uint32_t Encoder::lattice_shift() const
{
    if (m_options.lattice_shift >= 0)
        return std::uint32_t(std::min(m_options.lattice_shift, 6));
    return m_desc.channels.size() == 1 && m_desc.channels[0].type == SampleType::uint8 ? 2 : 0;
}

Status Encoder::make_mesh_layer(MeshLayerChunks& chunks)
{
    const double vertices = double(m_options.vertices) * double(m_hierarchy->mesh_pixels());
    const Level count = m_hierarchy->level_of_vertices(vertices);
    std::vector<Bands> all;
    constexpr std::size_t kAtOnce = 4;  // channels analysed together, such as RGBA; each more takes more memory
    for (std::size_t first = 0; first < m_desc.channels.size(); first += kAtOnce) {
        std::vector<std::vector<float>> values;
        std::vector<const float*> pointers;
        for (std::size_t c = first; c < std::min(first + kAtOnce, m_desc.channels.size()); ++c) {
            const int shift = mesh_shift(m_desc.channels[c].type);
            std::vector<float> z;
            z.reserve(m_integers.channels[c].size());
            for (std::int32_t v : m_integers.channels[c])
                z.push_back(float(v >> shift));
            values.push_back(to_mesh_pixels(*m_hierarchy, z.data()));
        }
        pointers.reserve(values.size());
        for (const auto& v : values)
            pointers.push_back(v.data());
        std::vector<Bands> bands;
        const Status status = analyse(*m_hierarchy, pointers, bands);
        if (!status)
            return status;
        for (Bands& b : bands) {
            b.details.resize(count);
            b.details.shrink_to_fit();
            all.push_back(std::move(b));
        }
    }
    // Readers refuse meshes whose triangles are thinner than pictures make them. With fewer vertices the mesh is
    // coarser and has none of these.
    for (double most = vertices;; most /= 4.0) {
        chunks = {};
        const Status status = write_mesh_layer(*m_hierarchy, all, most, chunks);
        const Mesh& mesh = chunks.layer.mesh;
        if (!status || most < 4.0
            || crossed_rows(mesh, mesh.triangles(), m_desc.data.height, m_desc.data.height)
                <= most_crossed_rows(m_desc.pixels(), mesh.triangle_count()))
            return status;
    }
}

/// A predictor with the mesh layer must save one part in this many of a tile's bytes, since the reader has to show the
/// layer for it. Without the condition the tiles of four pictures take 0.7 % less at most. At effort 2, which asks for
/// the smallest file, almost any saving will do.
constexpr std::uint64_t kSavedPart = 25, kLittleSavedPart = 500;

/// The predictor with the smallest estimated size. One that needs the mesh layer must save enough, see kSavedPart.
TilePredictor choose_predictor(const TileChannel& channel, int effort)
{
    TilePredictor best;
    if (effort == 0)
        return best;
    std::uint64_t least = ~0ull;
    for (int gouraud = 0; gouraud <= (channel.gouraud ? 1 : 0); ++gouraud)
        for (Shape shape : { Shape::median, Shape::mean, Shape::left, Shape::none }) {
            if (effort < 2 && (shape == Shape::none || (gouraud && shape == Shape::left)))
                continue;
            const TilePredictor p { shape, gouraud != 0 };
            std::uint64_t bits = estimate_tile_channel(channel, p);
            if (gouraud)
                bits += bits / (effort < 2 ? kSavedPart : kLittleSavedPart);
            if (bits < least) {
                least = bits;
                best = p;
            }
        }
    return best;
}

Bytes Encoder::write_tile(std::uint32_t column, std::uint32_t row, const MeshLayerChunks& chunks,
                          const TriangleGrid& grid) const
{
    const std::uint32_t x = column * m_options.tile, y = row * m_options.tile;
    const std::uint32_t width = std::min(m_options.tile, m_integers.width - x);
    const std::uint32_t height = std::min(m_options.tile, m_integers.height - y);
    const std::size_t pixels = std::size_t(width) * height;
    Bytes out;
    put_u32(out, row * ((m_integers.width + m_options.tile - 1) / m_options.tile) + column);
    std::vector<std::int32_t> values(pixels), mesh(pixels);
    std::vector<std::uint16_t> sizes(pixels), before(pixels);
    const SamplePoints points = SamplePoints::rectangle(x, y, width, height);
    for (std::size_t c = 0; c < m_integers.channels.size(); ++c) {
        for (std::uint32_t i = 0; i < height; ++i) {
            const std::int32_t* from = m_integers.channels[c].data() + std::size_t(y + i) * m_integers.width + x;
            std::copy(from, from + width, values.begin() + std::ptrdiff_t(std::size_t(i) * width));
        }
        TileChannel channel { int(width),  int(height), values.data(), nullptr, c > 0 ? before.data() : nullptr,
                              sizes.data() };
        if (m_options.effort > 0) {
            fill(chunks.layer.mesh, grid.triangles(), grid.at(column, row), chunks.layer.values[c],
                 mesh_shift(m_desc.channels[c].type), points, mesh.data());
            channel.gouraud = mesh.data();
        }
        write_tile_channel(channel, choose_predictor(channel, m_options.effort), out);
        sizes.swap(before);
    }
    return out;
}

void Encoder::make_tiles(const MeshLayerChunks& chunks, std::vector<Bytes>& tiles) const
{
    const TriangleGrid grid(chunks.layer.mesh, m_options.tile);
    const std::uint32_t columns = (m_integers.width + m_options.tile - 1) / m_options.tile;
    const std::uint32_t rows = (m_integers.height + m_options.tile - 1) / m_options.tile;
    tiles.resize(std::size_t(columns) * rows);
    pimg::run(m_options.parallel, tiles.size(), [&](std::size_t i) {
        tiles[i] = write_tile(std::uint32_t(i % columns), std::uint32_t(i / columns), chunks, grid);
    });
}

/// Everything before the tiles: the header chunks and the mesh layer.
void Encoder::write_front(const MeshLayerChunks& chunks, Bytes& file, EncodeStats& stats) const
{
    FileHead head;
    head.profile = std::uint8_t(m_options.profile);
    head.transform = std::uint8_t(m_transform);
    head.tile = std::uint16_t(m_options.tile);
    head.channels = std::uint32_t(m_desc.channels.size());
    head.vertices = chunks.layer.mesh.size();
    head.hash = m_options.hash ? hash_samples(m_desc, m_samples) : 0;
    stats.mesh_vertices = head.vertices;
    put_bytes(file, kSignature, sizeof kSignature);
    put_chunk(file, "HEAD", kCritical, write_head(head, m_desc));
    put_chunk(file, "CHAN", kCritical, write_channels(m_desc));
    if (!m_desc.attributes.empty())
        put_chunk(file, "META", kSafeToCopy, write_attributes(m_desc));
    put_chunk(file, "MESH", kCritical, chunks.base);
    stats.mesh_bytes = chunks.base.size();
    for (const Bytes& batch : chunks.batches) {
        put_chunk(file, "BATC", kCritical, batch);
        stats.mesh_bytes += batch.size();
    }
}

Status Encoder::run(Bytes& file, EncodeStats& stats)
{
    const auto stopped = [] {
        return Status::failure("writing was stopped");
    };
    m_integers = gather(m_desc, m_samples, 0, 0, m_desc.data.width, m_desc.data.height);
    Status status = build_hierarchy();
    if (!status)
        return status;
    CollapseChunks collapses;
    if (m_options.profile == Profile::full)
        status = write_collapse_sequence(*m_hierarchy, m_desc, m_samples, lattice_shift(), collapses);
    if (!status)
        return status;
    m_transform = choose_transform();
    forward(m_transform, m_integers.channels);
    if (!progress(0.55f))
        return stopped();
    MeshLayerChunks chunks;
    status = make_mesh_layer(chunks);
    if (!status)
        return status;
    if (!progress(0.7f))
        return stopped();
    std::vector<Bytes> tiles;
    make_tiles(chunks, tiles);
    if (!progress(0.98f))
        return stopped();

    write_front(chunks, file, stats);
    for (Bytes& tile : tiles) {
        put_chunk(file, "RAST", kCritical, tile);
        stats.raster_bytes += tile.size();
        Bytes().swap(tile);
    }
    for (const Bytes& chunk : collapses.chunks) {
        put_chunk(file, "COLL", kAncillary, chunk);
        stats.hierarchy_bytes += chunk.size();
    }
    put_chunk(file, "DONE", kCritical, {});
    return progress(1.0f) ? Status() : stopped();
}

}  // namespace

Status encode(const PictureDesc& desc, const std::vector<ConstStridedChannel>& samples, const EncodeOptions& options,
              std::vector<std::uint8_t>& file, EncodeStats* stats)
{
    DecodeLimits none;
    none.sample_bytes = ~0ull;
    const Status status = check_desc(desc, none);
    if (!status)
        return status;
    if (samples.size() != desc.channels.size()
        || std::any_of(samples.begin(), samples.end(), [](const ConstStridedChannel& p) { return !p.data; }))
        return Status::failure("pimg: expected one entry of samples per channel, none of them null");
    if (options.tile < 16 || options.tile > 1024 || !(options.vertices >= 0.0f && options.vertices <= 0.3f))
        return Status::failure("pimg: expected a tile of 16 to 1024 and vertices of 0 to 0.3");
    for (const Attribute& a : desc.attributes)
        if (a.name.size() > 65535 || a.type.size() > 255 || a.value.size() > 0x7fffffffu)
            return Status::failure("pimg: an attribute is too large: expected a name of up to 65535 bytes, a type of "
                                   "up to 255, a value below 2^31");
    return guarded([&] {
        EncodeStats mine;
        Bytes bytes;
        const Status done = Encoder(desc, samples, options).run(bytes, mine);
        if (done) {
            file.swap(bytes);
            if (stats)
                *stats = mine;
        }
        return done;
    });
}

}  // namespace PIMG_ABI
}  // namespace pimg
