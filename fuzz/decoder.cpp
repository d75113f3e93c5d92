// SPDX-License-Identifier: BSD-3-Clause
// The decoder, by all its entry points, with the checksums off: an attacker writes right ones.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <pimg/codec.h>

namespace {

using namespace pimg;

/// Pictures up to this many bytes of samples are read whole, or the time goes into large flat ones.
constexpr std::uint64_t kWhole = 1 << 22;

/// Planes over one buffer, one sample apart: only that they are written to matters.
std::vector<StridedChannel> planes_over(std::vector<std::uint8_t>& buffer, const PictureDesc& desc, std::uint32_t width,
                                        std::uint32_t height)
{
    buffer.resize(std::size_t(width) * height * 4);
    return std::vector<StridedChannel>(desc.channels.size(),
                                       StridedChannel { buffer.data(), 4, std::ptrdiff_t(width) * 4 });
}

void read_whole(const Decoder& decoder)
{
    const PictureDesc& desc = decoder.desc();
    std::vector<std::uint8_t> pixels(desc.pixels() * desc.pixel_bytes());
    ReadInfo info;
    if (!decoder.read(interleaved(desc, static_cast<void*>(pixels.data())), &info) || !decoder.has_hierarchy())
        return;
    const std::vector<float> guide(std::size_t(std::max(2u, desc.data.width)) * std::max(2u, desc.data.height), 1.0f);
    Hierarchy hierarchy;
    std::vector<Bands> bands;
    decoder.read_hierarchy(interleaved(desc, static_cast<const void*>(pixels.data())), { guide.data() }, hierarchy,
                           bands);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    DecodeLimits limits;
    limits.check_crc = false;
    Decoder decoder;
    if (!decoder.open(memory_source(data, size), limits))
        return 0;
    const PictureDesc& desc = decoder.desc();
    std::vector<ChunkInfo> chunks;
    decoder.chunks(chunks);
    std::vector<std::uint8_t> buffer;
    const std::uint32_t width = std::min(desc.data.width, 64u), height = std::min(desc.data.height, 64u);
    decoder.read_preview(width, height, planes_over(buffer, desc, width, height));
    decoder.read_preview(1, 1, planes_over(buffer, desc, 1, 1), 0.1);
    decoder.read_tile(0, 0, planes_over(buffer, desc, decoder.tile(), decoder.tile()));
    decoder.read_tile((desc.data.width - 1) / decoder.tile(), (desc.data.height - 1) / decoder.tile(),
                      planes_over(buffer, desc, decoder.tile(), decoder.tile()));
    if (desc.pixels() * desc.pixel_bytes() <= kWhole)
        read_whole(decoder);
    return 0;
}
