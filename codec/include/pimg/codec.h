// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes .pimg files, which hold a picture without loss. docs/format.md is the normative description of the
// format, in the same words and order as this code. The codec depends on no image library. It never throws, prints or
// exits: every fault comes back as a Status, also for files made to do harm.
//
// A file has one of two profiles:
//     compact   the mesh layer (the coarsest splits, which show a picture from the first kilobyte on), and raster tiles,
//               which make it exact
//     full      the same, and the collapse sequence of the whole hierarchy, so that filters need not build it
//
// The beginning of a file, once it contains the header chunks and the base mesh, decodes to a coarser picture
// (Decoder::read).
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
inline namespace PIMG_ABI {

/// The type of a channel's samples. All of them come back with the same bits, NaN payloads, -0 and subnormal numbers
/// included. uint8, uint16 and uint32 are unsigned whole numbers; half and float32 are IEEE 754 numbers of 16 and 32 bits.
enum class SampleType : std::uint8_t { uint8 = 0, uint16 = 1, uint32 = 2, half = 3, float32 = 4 };

/// The number of bytes of one sample: 1, 2 or 4.
PIMG_EXPORT std::size_t size_of(SampleType type);

/// A rectangle of pixels. x and y, its upper left pixel, are -2^30 .. 2^30; width and height are 1 .. 2^20.
struct Window {
    std::int32_t x = 0, y = 0;
    std::uint32_t width = 0, height = 0;
};

/// Name and type of one channel.
struct ChannelDesc {
    std::string name;  ///< at most 255 bytes
    SampleType type = SampleType::uint8;
};

/// One entry of metadata. The codec stores it without interpreting it. The order of entries is kept, and names need not
/// be unique; there are at most 65536.
struct Attribute {
    std::string name;  ///< at most 65535 bytes
    std::string type;  ///< tells the host how to read `value`, for example "float[16]"; at most 255 bytes
    std::vector<std::uint8_t> value;  ///< at most 2^31 - 1 bytes
};

/// Everything about a picture except its samples.
struct PIMG_EXPORT PictureDesc {
    Window data;                        ///< data window: where the samples are
    Window display;                     ///< display window: the whole frame; it need not contain or even touch `data`
    std::vector<ChannelDesc> channels;  ///< 1 .. 1024
    std::vector<Attribute> attributes;

    /// The number of pixels of the data window.
    std::size_t pixels() const { return std::size_t(data.width) * data.height; }
    /// The number of bytes of one pixel whose channels are packed in order, and the offset of channel c in it.
    std::size_t pixel_bytes() const;
    std::size_t offset_of(std::size_t c) const;
};

/// Where the samples of one channel lie in the caller's memory. Sample (x, y), counted from the upper left pixel of the
/// data window, is at data + x * x_stride + y * y_stride. Strides are in bytes. Samples are in the machine's byte order
/// and need not be aligned.
struct ConstStridedChannel {
    const void* data = nullptr;
    std::ptrdiff_t x_stride = 0, y_stride = 0;
};
/// The same for memory that is written to.
struct StridedChannel {
    void* data = nullptr;  ///< nullptr: this channel is not wanted
    std::ptrdiff_t x_stride = 0, y_stride = 0;
};
using ConstPlane [[deprecated("use ConstStridedChannel")]] = ConstStridedChannel;
using Plane [[deprecated("use StridedChannel")]] = StridedChannel;

/// The channels of a buffer that holds the pixels of the data window row by row, without gaps, pixel_bytes() each.
PIMG_EXPORT std::vector<ConstStridedChannel> interleaved(const PictureDesc& desc, const void* pixels);
PIMG_EXPORT std::vector<StridedChannel> interleaved(const PictureDesc& desc, void* pixels);

// ---- write ----------------------------------------------------------------------------------------------------------

/// What a file contains; see the top of this header.
enum class Profile : std::uint8_t { compact = 0, full = 1 };

/// The default share of the pixels that become vertices of the mesh layer. With it, a first picture takes the first few
/// percent of the file (docs/format.md).
constexpr float kMeshLayerShare = 0.015f;

/// How a file is written.
struct EncodeOptions {
    Profile profile = Profile::compact;
    float vertices = kMeshLayerShare;  ///< share of the pixels that become vertices of the mesh layer, 0 .. 0.3
    int effort =
        1;  ///< 0: quick, one predictor for all tiles; 1: normal; 2: tries all predictors, for the smallest file
    std::uint32_t tile = 256;  ///< side of the raster tiles in pixels, 16 .. 1024
    /// Profile::full: positions of vertices are rounded to multiples of 2^lattice_shift / 64 pixel, which makes the file
    /// smaller. 0 keeps them as they are. -1 chooses 2 for a picture of a single 8-bit channel, and 0 for others.
    int lattice_shift = -1;
    bool hash = true;  ///< store a hash of the samples, by which a reader checks them
    /// A hierarchy of this picture: of the same width and height, built from any guide. If null, encode() builds one
    /// from the luma of the samples.
    const Hierarchy* hierarchy = nullptr;
    ParallelFor parallel;  ///< the bytes of the file do not depend on it
    Progress progress;
};

/// Figures of one file: the bytes of its parts, and the number of vertices of its mesh layer.
struct EncodeStats {
    std::uint64_t mesh_bytes = 0, raster_bytes = 0, hierarchy_bytes = 0;
    std::uint32_t mesh_vertices = 0;
};

/// Writes a picture into `file`. `samples` has one entry per channel of `desc`, none of them null. The same picture and
/// options always give the same bytes. Fails on descriptions and options outside the ranges above, on a hierarchy of
/// another picture, when memory runs out, and when options.progress asked to stop; `file` is then unchanged. `stats` may
/// be null.
PIMG_EXPORT Status encode(const PictureDesc& desc, const std::vector<ConstStridedChannel>& samples,
                          const EncodeOptions& options, std::vector<std::uint8_t>& file, EncodeStats* stats = nullptr);

// ---- read -----------------------------------------------------------------------------------------------------------

/// The largest picture that is read. Limits are checked before memory is allocated for it; opening a file beyond them
/// fails.
struct DecodeLimits {
    std::uint32_t side = 1u << 20;      ///< width and height of the data window
    std::uint64_t pixels = 1ull << 31;  ///< of the data window
    std::uint32_t channels = 1024;
    std::uint64_t sample_bytes = 32ull << 30;     ///< of all samples
    std::uint64_t attribute_bytes = 64ull << 20;  ///< of all attributes, unpacked
    bool check_crc = true;  ///< false skips the checksums, so that fuzzers reach the code behind them
};

/// Random access to the bytes of a file. If a Decoder is used from several threads, so is read().
class PIMG_EXPORT Source {
public:
    virtual ~Source() = default;
    virtual std::uint64_t size() const = 0;
    /// The length of the file in bytes is size(). read() copies the bytes [offset, offset + count) to `to`; it returns
    /// false when it cannot.
    virtual bool read(std::uint64_t offset, std::size_t count, void* to) const = 0;
};

/// A source of `size` bytes of memory. The caller keeps the memory alive as long as the source.
PIMG_EXPORT std::shared_ptr<const Source> memory_source(const void* data, std::size_t size);

/// Whether the first bytes of a file are those of a .pimg file. `size` is how many there are; 8 are enough.
PIMG_EXPORT bool is_pimg(const void* data, std::size_t size);

/// One chunk of a file.
struct ChunkInfo {
    char type[5];                  ///< four letters and a 0
    std::uint64_t offset, length;  ///< in bytes: where the chunk begins in the file, and its length field
};

/// What Decoder::read() found.
struct ReadInfo {
    bool exact = false;          ///< all tiles were there, so the samples are those that were written
    bool hash_checked = false;   ///< the samples were compared with the stored hash, and agree
    std::uint32_t tiles = 0;     ///< raster tiles found; the others show the mesh layer
    std::uint32_t vertices = 0;  ///< vertices of the mesh layer found
    std::uint64_t bytes = 0;     ///< length of the file up to the last whole chunk
};

/// Reads one file. After open(), all methods are const and may be called from several threads at once. All but open() and
/// is_open() need an open file.
class PIMG_EXPORT Decoder {
public:
    Decoder();
    ~Decoder();
    Decoder(Decoder&&) noexcept;
    Decoder& operator=(Decoder&&) noexcept;

    /// Reads the header chunks, which are a few hundred bytes and the attributes, and nothing else. On failure the decoder
    /// is as if newly made.
    Status open(std::shared_ptr<const Source> source, const DecodeLimits& limits = {});
    bool is_open() const { return m_file != nullptr; }

    const PictureDesc& desc() const;
    Profile profile() const;
    std::uint32_t tile() const;         ///< side of the raster tiles
    std::uint32_t vertices() const;     ///< vertices of the whole mesh layer
    std::uint64_t sample_hash() const;  ///< XXH64 hash of the samples (docs/format.md); 0 if the file has none

    /// Lists all chunks of the file, in order, by reading their headers.
    Status chunks(std::vector<ChunkInfo>& list) const;

    /// Reads the whole picture as exactly as the file allows. `samples` has one entry per channel and receives the data
    /// window; a channel whose `data` is null is skipped. Where a raster tile is missing because the file ends early, the
    /// samples are those of the mesh layer, as far as that is there. Fails on any damage, such as a chunk that does not
    /// match its checksum, but not because the file ends early. `info` may be null.
    Status read(const std::vector<StridedChannel>& samples, ReadInfo* info = nullptr,
                const ParallelFor& parallel = {}) const;

    /// Reads the raster tile whose upper left pixel is (tile() * column, tile() * row) of the data window. Tiles at the
    /// right and lower edges are cut off there. `samples` point at the memory for the tile's first pixel. The samples are
    /// those that read() gives. Fails when there is no such tile, and on damage.
    Status read_tile(std::uint32_t column, std::uint32_t row, const std::vector<StridedChannel>& samples) const;

    /// Reads a preview, such as a thumbnail, of width x height pixels, each 1 or more. It is the picture as the first
    /// vertices of the mesh layer show it: a share of them above 0 and at most 1. The data window is sampled at the pixel
    /// centres of a raster of that size. Of the file, only the chunks of the mesh layer are read.
    Status read_preview(std::uint32_t width, std::uint32_t height, const std::vector<StridedChannel>& samples,
                        double share = 1.0) const;

    /// Whether the file contains the whole hierarchy (profile full, and not cut off).
    bool has_hierarchy() const;

    /// Reads the hierarchy and, in the same pass, computes the bands of any channels on it. `samples` are those that
    /// read() gave, one entry per channel of the file. `channels` may be others, usually made from the samples; each
    /// holds one finite value per mesh pixel (to_mesh_pixels()). The result differs from the hierarchy that was written
    /// in two things: inside a batch, which is a few percent of the vertices of its level, the splits may be in another
    /// order; and every split has the cost of its batch. Fails when has_hierarchy() is false, and on damage.
    Status read_hierarchy(const std::vector<ConstStridedChannel>& samples, const std::vector<const float*>& channels,
                          Hierarchy& hierarchy, std::vector<Bands>& bands) const;

private:
    struct File;
    std::unique_ptr<File> m_file;
};

}  // namespace PIMG_ABI
}  // namespace pimg
