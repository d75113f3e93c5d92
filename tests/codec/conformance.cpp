// SPDX-License-Identifier: BSD-3-Clause
// Writes the conformance files into a directory and, for each, what this library decodes from the whole file and from
// two prefixes: NAME.pimg, NAME.raw, NAME.cutN.raw. tests/codec/reader_test.py compares them with the independent
// reader.
#include <cstdio>
#include <fstream>
#include <string>

#include <pimg/codec.h>

#include "codec/codec_pictures.h"

namespace {

using namespace pimg;
using namespace pimg_test;

void save(const std::string& name, const std::vector<std::uint8_t>& bytes, std::size_t size)
{
    std::ofstream(name, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(size));
}

bool decode(const std::vector<std::uint8_t>& file, std::size_t size, std::vector<std::uint8_t>& pixels)
{
    Decoder decoder;
    if (!decoder.open(memory_source(file.data(), size)))
        return false;
    pixels.resize(decoder.desc().pixel_bytes() * decoder.desc().pixels());
    return bool(decoder.read(interleaved(decoder.desc(), (void*)pixels.data())));
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: codec_conformance DIRECTORY\n");
        return 2;
    }
    std::vector<Picture> pictures = conformance_pictures();
    using T = SampleType;
    pictures.push_back(make_picture(90, 70, { T::half, T::half, T::half }));
    pictures.push_back(make_picture(64, 64, { T::uint16 }));
    Picture flat = make_picture(80, 60, { T::uint8, T::uint8, T::uint8, T::uint8 });
    for (std::uint8_t& b : flat.pixels)
        b = 7;
    pictures.push_back(flat);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        EncodeOptions options;
        options.profile = i % 2 == 0 ? Profile::full : Profile::compact;
        options.effort = 2;
        options.vertices = 0.1f;
        options.tile = 32;
        std::vector<std::uint8_t> file, pixels;
        const std::string name = std::string(argv[1]) + "/" + std::to_string(i);
        if (!encode(pictures[i].desc, pictures[i].planes(), options, file) || !decode(file, file.size(), pixels)
            || pixels != pictures[i].pixels)
            return 1;
        save(name + ".pimg", file, file.size());
        save(name + ".raw", pixels, pixels.size());
        for (int percent : { 30, 60 }) {
            const std::size_t cut = file.size() * std::size_t(percent) / 100;
            if (decode(file, cut, pixels))
                save(name + ".cut" + std::to_string(cut) + ".raw", pixels, pixels.size());
        }
    }
    return 0;
}
