// SPDX-License-Identifier: BSD-3-Clause
// Damaged files: every truncation of small ones, every single bit flipped, random damage with the checksums off.
// Each must end in an error or a picture, and a hierarchy that is read must be a whole one of that picture; a whole file
// must give both. Meant to be run with AddressSanitizer and UndefinedBehaviorSanitizer, and within a time limit.
// Usage: codec_damage [rounds of random damage, default 2000 [files of which every bit is flipped, default 1
//                     [settings each of the six pictures is written with, default 1, at most 4]]]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <pimg/codec.h>
#include <pimg/sampling.h>
#include <pimg/simplify.h>

#include "codec/codec_pictures.h"

namespace {

using namespace pimg;
using namespace pimg_test;

struct Outcome {
    long pictures = 0, errors = 0, hierarchies = 0;
    long silent = 0;  ///< wrong samples, or a hierarchy that is none of the picture, without an error
};

/// Whether a hierarchy and the bands of a constant channel on it are whole: every split has its stencil and its detail,
/// the mesh can be refined to the finest level, and synthesis gives the constant back.
bool is_whole(const Hierarchy& h, const std::vector<Bands>& bands, const PictureDesc& desc, float constant)
{
    Mesh mesh;
    if (h.width != int(desc.data.width) || h.height != int(desc.data.height) || bands.size() != 1
        || h.stencils.size() != h.splits.size() || bands[0].details.size() != h.splits.size()
        || bands[0].base.size() != h.base_points.size() || !refine(h, h.levels(), mesh))
        return false;
    std::vector<float> samples(h.mesh_pixels());
    synthesise(h, bands[0], samples.data());
    return std::all_of(samples.begin(), samples.end(), [=](float v) { return std::fabs(v - constant) < 1e-4f; });
}

/// Reads all there is to read; `original` are the right pixels.
void try_file(const std::uint8_t* data, std::size_t size, bool check_crc, const Picture& original, Outcome& outcome)
{
    // A copy of exactly this size, so that the sanitizer sees the first byte too many.
    const std::vector<std::uint8_t> exact(data, data + size);
    DecodeLimits limits;
    limits.pixels = 1 << 16;
    limits.channels = 64;
    limits.check_crc = check_crc;
    Decoder decoder;
    if (!decoder.open(memory_source(exact.data(), size), limits)) {
        ++outcome.errors;
        return;
    }
    std::vector<std::uint8_t> pixels(decoder.desc().pixel_bytes() * decoder.desc().pixels());
    const std::vector<StridedChannel> planes = interleaved(decoder.desc(), (void*)pixels.data());
    ReadInfo info;
    const Status status = decoder.read(planes, &info);
    if (status && decoder.has_hierarchy()) {
        Hierarchy h;
        std::vector<Bands> bands;
        const std::size_t n =
            std::size_t(std::max(2u, decoder.desc().data.width)) * std::max(2u, decoder.desc().data.height);
        const std::vector<float> guide(n, 1.0f);
        const Status read =
            decoder.read_hierarchy(interleaved(decoder.desc(), (const void*)pixels.data()), { guide.data() }, h, bands);
        outcome.hierarchies += read.ok();
        outcome.silent += read.ok() && !is_whole(h, bands, decoder.desc(), 1.0f);
    }
    ++(status ? outcome.pictures : outcome.errors);
    // A whole file whose samples are wrong without a word is the one thing that must not be.
    if (status && info.exact && check_crc && pixels != original.pixels)
        ++outcome.silent;
}

/// Built from a third of the pixels.
Hierarchy hierarchy_of_chosen(const Picture& picture)
{
    std::vector<float> samples;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 3)
        samples.push_back(picture.pixels[i]);
    const Guide guide { int(picture.desc.data.width), int(picture.desc.data.height), { { samples.data(), 1.0f } } };
    Hierarchy hierarchy;
    std::vector<Bands> bands;
    SimplifyOptions options;
    if (!sample(guide, {}, options.start) || !simplify(guide, options, hierarchy, bands))
        std::abort();
    return hierarchy;
}

}  // namespace

int main(int argc, char** argv)
{
    const long rounds = argc > 1 ? std::atol(argv[1]) : 2000;
    const std::size_t flips = argc > 2 ? std::size_t(std::atol(argv[2])) : 1;
    const std::size_t settings = argc > 3 ? std::min(std::size_t(std::atol(argv[3])), std::size_t(4)) : 1;
    long hierarchies = 0;
    std::vector<std::vector<std::uint8_t>> files;
    std::vector<Picture> pictures = conformance_pictures();
    pictures.push_back(pictures[2]);  // once more, with a hierarchy of chosen pixels
    const Hierarchy chosen = hierarchy_of_chosen(pictures[2]);
    const std::size_t kinds = pictures.size();
    for (std::size_t i = kinds; i < settings * kinds; ++i)
        pictures.push_back(pictures[i - kinds]);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const std::size_t setting = i / kinds;
        EncodeOptions options;
        options.profile = (i % kinds + setting) % 2 == 0 ? Profile::full : Profile::compact;
        if (i % kinds == 5 && setting % 2 == 0) {
            options.profile = Profile::full;
            options.hierarchy = &chosen;
        }
        hierarchies += options.profile == Profile::full;
        options.vertices = 0.1f;
        options.tile = setting < 2 ? 32 : 16;
        files.emplace_back();
        if (const Status status = encode(pictures[i].desc, pictures[i].planes(), options, files.back()); !status) {
            std::fprintf(stderr, "%s\n", status.error().c_str());
            return 1;
        }
    }
    Outcome whole, cut, flipped, random;
    for (std::size_t i = 0; i < files.size(); ++i)
        try_file(files[i].data(), files[i].size(), true, pictures[i], whole);
    for (std::size_t i = 0; i < files.size(); ++i)
        for (std::size_t n = 0; n <= files[i].size(); ++n)
            try_file(files[i].data(), n, true, pictures[i], cut);
    for (std::size_t n = 0; n < std::min(flips, files.size()); ++n) {
        const std::size_t i = (n + 4) % files.size();
        for (std::size_t bit = 0; bit < files[i].size() * 8; ++bit) {
            std::vector<std::uint8_t> file = files[i];
            file[bit / 8] = std::uint8_t(file[bit / 8] ^ (1u << (bit % 8)));
            try_file(file.data(), file.size(), true, pictures[i], flipped);
        }
    }
    std::uint32_t seed = 12345;
    for (long round = 0; round < rounds; ++round) {
        const std::size_t i = noise(seed) % files.size();
        std::vector<std::uint8_t> file = files[i];
        for (std::uint32_t k = 1 + noise(seed) % 4; k > 0; --k)
            file[noise(seed) % file.size()] = std::uint8_t(noise(seed) & 1 ? noise(seed) : 1u << (noise(seed) % 8));
        try_file(file.data(), file.size(), false, pictures[i], random);
    }
    for (const auto& [name, o] : { std::pair<const char*, Outcome>("whole", whole),
                                   { "truncated", cut },
                                   { "one bit flipped", flipped },
                                   { "random, checksums off", random } })
        std::printf("%-24s %6ld pictures %6ld errors %6ld hierarchies %ld silent\n", name, o.pictures, o.errors,
                    o.hierarchies, o.silent);
    return whole.errors + whole.silent + cut.silent + flipped.silent > 0 || whole.hierarchies != hierarchies;
}
