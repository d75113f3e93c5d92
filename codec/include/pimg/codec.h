// SPDX-License-Identifier: BSD-3-Clause
// The .pimg file: bytes <-> picture, exactly. docs/format.md is the normative description, in the same words
// and order as this code. Knows nothing of other image libraries; never throws, prints or exits: every fault comes back
// as a Status, also for hostile bytes.
//
//     compact   mesh layer (the coarsest splits, a picture from the first kilobyte on) + raster tiles (exact)
//     full      the same + the collapse sequence of the whole hierarchy, so that filters start without building
//
// Any prefix of a file that holds its header chunks decodes to a coarser picture (Decoder::read).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <pimg/bands.h>
#include <pimg/hierarchy.h>
#include <pimg/types.h>

namespace pimg {

/// Type of a channel's samples. All come back bit by bit, NaN payloads, -0 and subnormals included.
enum class SampleType : std::uint8_t { uint8 = 0, uint16 = 1, uint32 = 2, half = 3, float32 = 4 };

/// Bytes of one sample: 1, 2 or 4.
std::size_t size_of(SampleType type);

/// A rectangle of pixels; x, y in [-2^30, 2^30], sides 1 .. 2^20.
struct Window {
    std::int32_t x = 0, y = 0;
    std::uint32_t width = 0, height = 0;
};

struct ChannelDesc {
    std::string name;  ///< at most 255 bytes
    SampleType type = SampleType::uint8;
};

/// Metadata the codec carries but never looks into. Order is kept; names need not be unique.
struct Attribute {
    std::string name;                 ///< at most 65535 bytes
    std::string type;                 ///< whatever tells the host how to read `value`, e.g. "float[16]"; at most 255
    std::vector<std::uint8_t> value;  ///< at most 2^31 - 1 bytes
};

/// Everything about a picture but its samples.
struct PictureDesc {
    Window data;                        ///< where the samples are
    Window display;                     ///< the whole frame; may be larger or smaller, or far away
    std::vector<ChannelDesc> channels;  ///< 1 .. 1024
    std::vector<Attribute> attributes;

    std::size_t pixels() const { return std::size_t(data.width) * data.height; }
    /// Bytes of one pixel with its channels packed in order, and where channel c lies in it.
    std::size_t pixel_bytes() const;
    std::size_t offset_of(std::size_t c) const;
};

/// Where the samples of one channel lie in the caller's memory: sample (x, y) is at data + x * x_stride + y * y_stride
/// bytes, in the machine's byte order; no alignment is needed.
struct ConstStridedChannel {
    const void* data = nullptr;
    std::ptrdiff_t x_stride = 0, y_stride = 0;
};
struct StridedChannel {
    void* data = nullptr;  ///< nullptr: this channel is not wanted
    std::ptrdiff_t x_stride = 0, y_stride = 0;
};
using ConstPlane [[deprecated("use ConstStridedChannel")]] = ConstStridedChannel;
using Plane [[deprecated("use StridedChannel")]] = StridedChannel;

/// The channels in a buffer of packed pixels in row order (pixel_bytes() each).
std::vector<ConstStridedChannel> interleaved(const PictureDesc& desc, const void* pixels);
std::vector<StridedChannel> interleaved(const PictureDesc& desc, void* pixels);

// ---- write ----------------------------------------------------------------------------------------------------------

enum class Profile : std::uint8_t { compact = 0, full = 1 };

/// Share of the pixels that become vertices of the mesh layer unless something else is asked for: a first picture in the
/// first few percent of the file (docs/format.md).
constexpr float kMeshLayerShare = 0.015f;

struct EncodeOptions {
    Profile profile = Profile::compact;
    float vertices = kMeshLayerShare;  ///< share of the pixels that become vertices of the mesh layer, 0 .. 0.3
    int effort = 1;                    ///< 0 quick (one predictor for all tiles), 1 normal, 2 tries everything
    std::uint32_t tile = 256;          ///< side of the raster tiles, 16 .. 1024
    /// Positions of a stored hierarchy are moved onto multiples of 2^shift / 64 pixels; 0 keeps them as they are. -1:
    /// 0, but 2 for a single 8-bit channel.
    int lattice_shift = -1;
    bool hash = true;  ///< store the hash of the samples
    /// A hierarchy of this picture, of the same width and height and built with any guide. With nullptr, encode()
    /// builds one on luma.
    const Hierarchy* hierarchy = nullptr;
    ParallelFor parallel;  ///< the bytes do not depend on it
    Progress progress;
};

/// What writing returns besides the file.
struct EncodeStats {
    std::uint64_t mesh_bytes = 0, raster_bytes = 0, hierarchy_bytes = 0;
    std::uint32_t mesh_vertices = 0;
};

/// Writes a picture: one entry of `samples` per channel of `desc`. The same picture and options give the same bytes.
Status encode(const PictureDesc& desc, const std::vector<ConstStridedChannel>& samples, const EncodeOptions& options,
              std::vector<std::uint8_t>& file, EncodeStats* stats = nullptr);

// ---- read -----------------------------------------------------------------------------------------------------------

/// Largest values a file may ask for. They are checked before anything is allocated; a file beyond them is an error.
struct DecodeLimits {
    std::uint32_t side = 1u << 20;
    std::uint64_t pixels = 1ull << 31;
    std::uint32_t channels = 1024;
    std::uint64_t sample_bytes = 32ull << 30;     ///< of the whole picture
    std::uint64_t attribute_bytes = 64ull << 20;  ///< of all attributes, unpacked
    bool check_crc = true;                        ///< false only to let fuzzers past the checksums
};

/// Random access to the bytes of a file. read() is called from several threads at once if the Decoder is.
class Source {
public:
    virtual ~Source() = default;
    virtual std::uint64_t size() const = 0;
    /// Copies bytes [offset, offset + count); false when they cannot be had.
    virtual bool read(std::uint64_t offset, std::size_t count, void* to) const = 0;
};

/// A source over `size` bytes of memory, which the caller keeps alive as long as the source.
std::shared_ptr<const Source> memory_source(const void* data, std::size_t size);

/// Whether these first bytes (8 are enough) are those of a .pimg file.
bool is_pimg(const void* data, std::size_t size);

struct ChunkInfo {
    char type[5];  ///< four letters and a 0
    std::uint64_t offset, length;
};

/// What a read found.
struct ReadInfo {
    bool exact = false;          ///< all tiles were there: the samples are those written
    bool hash_checked = false;   ///< ... and their hash was compared
    std::uint32_t tiles = 0;     ///< raster tiles found, the others show the mesh layer
    std::uint32_t vertices = 0;  ///< vertices of the mesh layer found
    std::uint64_t bytes = 0;     ///< length of the file up to the last whole chunk
};

/// Reads one file. After open() all methods are const and may be called from several threads at once.
class Decoder {
public:
    Decoder();
    ~Decoder();
    Decoder(Decoder&&) noexcept;
    Decoder& operator=(Decoder&&) noexcept;

    /// Reads the header chunks (a few hundred bytes + attributes), nothing else. On failure the decoder is as new.
    Status open(std::shared_ptr<const Source> source, const DecodeLimits& limits = {});
    bool is_open() const { return m_file != nullptr; }

    const PictureDesc& desc() const;
    Profile profile() const;
    std::uint32_t tile() const;         ///< side of the raster tiles
    std::uint32_t vertices() const;     ///< of the whole mesh layer
    std::uint64_t sample_hash() const;  ///< XXH64 of the samples (docs/format.md), 0 when not stored

    /// Every chunk present, by a walk over the chunk headers.
    Status chunks(std::vector<ChunkInfo>& list) const;

    /// Reads the whole picture as exactly as the file's bytes allow. Where a raster tile is missing, the samples are
    /// those of the mesh layer, as far as that is there. Damage anywhere (a chunk that fails its checksum) is an error; an early end of the file is not.
    /// One entry of `samples` per channel, over the data window.
    Status read(const std::vector<StridedChannel>& samples, ReadInfo* info = nullptr,
                const ParallelFor& parallel = {}) const;

    /// The tile whose upper left pixel is (tile() * column, tile() * row) of the data window, cut at its right and
    /// lower edges; `samples` point at the tile's first pixel. As exact or coarse as read() would give.
    Status read_tile(std::uint32_t column, std::uint32_t row, const std::vector<StridedChannel>& samples) const;

    /// Reads a preview, for thumbnails: the picture as the first `share` (0 .. 1] of the mesh layer's vertices show it,
    /// sampled at the pixel centres of a width x height raster over the data window. Reads the mesh chunks only.
    Status read_preview(std::uint32_t width, std::uint32_t height, const std::vector<StridedChannel>& samples,
                        double share = 1.0) const;

    /// Whether the whole hierarchy is in the file.
    bool has_hierarchy() const;

    /// The hierarchy (`full` profile) and, from the same pass, the bands of any channels on it. `samples` are those
    /// read() gave; each of `channels` holds one finite value per mesh pixel (to_mesh_pixels()), usually made from
    /// them. Equal to the hierarchy that was written but for the order of the splits inside a batch (a few percent of
    /// the vertices of that level), and costs, which are those of the batch.
    Status read_hierarchy(const std::vector<ConstStridedChannel>& samples, const std::vector<const float*>& channels,
                          Hierarchy& hierarchy, std::vector<Bands>& bands) const;

private:
    struct File;
    std::unique_ptr<File> m_file;
};

}  // namespace pimg
