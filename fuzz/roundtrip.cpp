// SPDX-License-Identifier: BSD-3-Clause
// Any small picture, written and read: the samples must come back bit by bit, NaN payloads included, and the hierarchy
// must be there when it was asked for.
#include <cstdint>
#include <vector>

#include <pimg/codec.h>

#include "taken.h"

using namespace pimg;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Taken in(data, size);
    PictureDesc desc;
    const std::uint32_t width = 1 + in.number<std::uint8_t>() % 24, height = 1 + in.number<std::uint8_t>() % 24;
    desc.data = { in.number<std::int16_t>(), in.number<std::int16_t>(), width, height };
    desc.display = { in.number<std::int16_t>(), in.number<std::int16_t>(), width, height };
    for (int c = 1 + in.number<std::uint8_t>() % 5; c > 0; --c)
        desc.channels.push_back({ in.text('\n').substr(0, 255), SampleType(in.number<std::uint8_t>() % 5) });
    EncodeOptions options;
    options.profile = Profile(in.number<std::uint8_t>() % 2);
    options.vertices = float(in.number<std::uint8_t>() % 31) / 100.0f;
    options.effort = in.number<std::uint8_t>() % 3;
    options.tile = 16;
    options.lattice_shift = in.number<std::uint8_t>() % 4 - 1;
    std::vector<std::uint8_t> pixels(desc.pixels() * desc.pixel_bytes());
    // What the input has no bytes for repeats it, so that short inputs are pictures, too.
    for (std::size_t i = 0; i < pixels.size() && in.left() > 0; ++i)
        pixels[i] = in.here()[i % in.left()];
    std::vector<std::uint8_t> file;
    must(bool(encode(desc, interleaved(desc, static_cast<const void*>(pixels.data())), options, file)));

    Decoder decoder;
    must(bool(decoder.open(memory_source(file.data(), file.size()))));
    std::vector<std::uint8_t> read(pixels.size());
    ReadInfo info;
    must(bool(decoder.read(interleaved(desc, static_cast<void*>(read.data())), &info)));
    must(info.exact && read == pixels);
    if (decoder.has_hierarchy()) {
        const std::vector<float> guide(std::size_t(width < 2 ? 2 : width) * (height < 2 ? 2 : height), 1.0f);
        Hierarchy hierarchy;
        std::vector<Bands> bands;
        must(bool(decoder.read_hierarchy(interleaved(desc, static_cast<const void*>(read.data())), { guide.data() },
                                         hierarchy, bands)));
    }
    return 0;
}
