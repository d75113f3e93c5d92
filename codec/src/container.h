// SPDX-License-Identifier: BSD-3-Clause
// Signature, chunks and the header chunks of a file.
#pragma once

#include <cstdint>

#include <pimg/codec.h>

#include "entropy/bytes.h"
#include "raster/samples.h"

namespace pimg {
inline namespace PIMG_ABI {

constexpr std::uint8_t kSignature[8] = { 0x8a, 'P', 'I', 'M', 0x0d, 0x0a, 0x1a, 0x0a };
constexpr std::uint32_t kMajorVersion = 1, kMinorVersion = 0;
constexpr std::size_t kChunkHead = 16, kChunkTail = 4;

/// Chunk flags. A reader that does not know a critical chunk must refuse the file; an editor that does not know a chunk
/// may copy it only if it is marked safe.
enum ChunkFlags : std::uint16_t { kAncillary = 0, kCritical = 1, kSafeToCopy = 2 };

struct ChunkHead {
    char type[5] = {};
    std::uint16_t flags = 0, version = 0;
    std::uint64_t length = 0;
    bool is(const char* name) const;
};

/// type 4 | flags 2 | version 2 | length 8 | payload | crc 4, the crc over all before it.
void put_chunk(Bytes& file, const char* type, std::uint16_t flags, const Bytes& payload);

/// False when these 16 bytes cannot start a chunk.
bool parse_chunk_head(const std::uint8_t* bytes, ChunkHead& head);

/// The contents of the HEAD chunk, except the windows, which are in the description.
struct FileHead {
    std::uint16_t major = kMajorVersion, minor = kMinorVersion;
    std::uint8_t profile = 0, transform = 0;
    std::uint16_t tile = 256;
    std::uint32_t channels = 0;
    std::uint32_t vertices = 0;  ///< of the whole mesh layer
    std::uint64_t hash = 0;
};

Bytes write_head(const FileHead& head, const PictureDesc& desc);
Bytes write_channels(const PictureDesc& desc);
Bytes write_attributes(const PictureDesc& desc);

Status read_head(ByteReader in, const DecodeLimits& limits, FileHead& head, PictureDesc& desc);
Status read_channels(ByteReader in, const DecodeLimits& limits, const FileHead& head, PictureDesc& desc);
Status read_attributes(ByteReader in, const DecodeLimits& limits, PictureDesc& desc);

/// Checks a description, for the writer and for the reader.
Status check_desc(const PictureDesc& desc, const DecodeLimits& limits);

}  // namespace PIMG_ABI
}  // namespace pimg
