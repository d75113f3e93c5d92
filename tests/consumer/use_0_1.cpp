// SPDX-License-Identifier: BSD-3-Clause
// Written when the codec and painting were part of pimg::core: still built with that library alone, by the names of then.
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <pimg/bands.h>
#include <pimg/brush.h>
#include <pimg/codec.h>
#include <pimg/direction.h>
#include <pimg/dual_pieces.h>
#include <pimg/guide.h>
#include <pimg/hierarchy.h>
#include <pimg/ink.h>
#include <pimg/mesh.h>
#include <pimg/mosaic.h>
#include <pimg/paint.h>
#include <pimg/rasterize.h>
#include <pimg/regions.h>
#include <pimg/sampling.h>
#include <pimg/simplify.h>
#include <pimg/smoothing.h>
#include <pimg/stroke_file.h>
#include <pimg/strokes.h>
#include <pimg/types.h>
#include <pimg/version.h>

namespace {

bool codec_gives_back(std::vector<std::uint8_t> pixels, std::uint32_t width, std::uint32_t height)
{
    pimg::PictureDesc desc;
    desc.data = desc.display = { 0, 0, width, height };
    desc.channels = { { "Y", pimg::SampleType::uint8 } };
    std::vector<std::uint8_t> file, result(pixels.size());
    const std::vector<pimg::ConstPlane> from = pimg::interleaved(desc, static_cast<const void*>(pixels.data()));
    if (!pimg::encode(desc, from, {}, file) || !pimg::is_pimg(file.data(), file.size()))
        return false;
    pimg::Decoder decoder;
    const std::vector<pimg::Plane> to = pimg::interleaved(desc, static_cast<void*>(result.data()));
    return decoder.open(pimg::memory_source(file.data(), file.size())) && decoder.read(to) && result == pixels;
}

}  // namespace

int main()
{
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < 20 * 10; ++i)
        pixels.push_back(std::uint8_t(i % 20 * 12));
    const std::string drawing = pimg::strokes_to_svg({}, {}, 1.0f, "");
    if (!codec_gives_back(pixels, 20, 10) || drawing.find("<svg") == std::string::npos)
        return 1;
    std::puts(PIMG_VERSION_STRING);
    return 0;
}
