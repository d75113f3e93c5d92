// SPDX-License-Identifier: BSD-3-Clause
// One Decoder read by several threads at once: the same samples, and, built with ThreadSanitizer, no data race.
#include <cstdio>
#include <thread>

#include <pimg/codec.h>
#include <pimg/simplify.h>

#include "codec/codec_pictures.h"

namespace {

using namespace pimg;
using namespace pimg_test;

constexpr std::uint32_t kTile = 64;

/// Tiles from number `first` on and round to it, a thumbnail, the whole picture and its hierarchy; false if one is
/// wrong.
bool read_all(const Decoder& decoder, const Picture& original, std::uint32_t first)
{
    const PictureDesc& desc = decoder.desc();
    const std::uint32_t width = desc.data.width, columns = (width + kTile - 1) / kTile,
                        rows = (desc.data.height + kTile - 1) / kTile;
    std::vector<std::uint8_t> pixels(original.pixels.size()), whole(pixels.size()), small(desc.pixel_bytes() * 16 * 16);
    for (std::uint32_t i = 0; i < columns * rows; ++i) {
        const std::uint32_t tile = (i + first) % (columns * rows), x = tile % columns, y = tile / columns;
        std::vector<StridedChannel> planes = interleaved(desc, static_cast<void*>(pixels.data()));
        for (StridedChannel& plane : planes)
            plane.data = static_cast<std::uint8_t*>(plane.data) + std::ptrdiff_t(kTile * x) * plane.x_stride
                + std::ptrdiff_t(kTile * y) * plane.y_stride;
        if (!decoder.read_tile(x, y, planes))
            return false;
    }
    std::vector<ChunkInfo> chunks;
    Hierarchy hierarchy;
    std::vector<Bands> bands;
    const std::vector<float> flat(desc.pixels(), 1.0f);
    PictureDesc thumbnail = desc;
    thumbnail.data.width = thumbnail.data.height = 16;
    return decoder.read_preview(16, 16, interleaved(thumbnail, static_cast<void*>(small.data())))
        && decoder.chunks(chunks) && decoder.read(interleaved(desc, static_cast<void*>(whole.data())))
        && decoder.read_hierarchy(interleaved(desc, static_cast<const void*>(whole.data())), { flat.data() }, hierarchy,
                                  bands)
        && pixels == original.pixels && whole == original.pixels;
}

}  // namespace

int main()
{
    const Picture picture = make_picture(150, 130, { SampleType::uint8, SampleType::uint8, SampleType::uint8 });
    EncodeOptions options;
    options.profile = Profile::full;
    options.tile = kTile;
    std::vector<std::uint8_t> file;
    Decoder decoder;
    if (!encode(picture.desc, picture.planes(), options, file)
        || !decoder.open(memory_source(file.data(), file.size())))
        return 1;
    constexpr std::uint32_t kThreads = 4;
    bool right[kThreads] = {};
    std::vector<std::thread> threads;
    for (std::uint32_t t = 0; t < kThreads; ++t)
        threads.emplace_back([&, t] { right[t] = read_all(decoder, picture, 2 * t); });
    for (std::thread& thread : threads)
        thread.join();
    for (std::uint32_t t = 0; t < kThreads; ++t)
        if (!right[t]) {
            std::fprintf(stderr, "thread %u read something else\n", t);
            return 1;
        }
    return 0;
}
