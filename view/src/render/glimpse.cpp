// SPDX-License-Identifier: BSD-3-Clause
#include "render/glimpse.h"

#include <algorithm>
#include <cmath>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <pimg/codec.h>

#include "pimg_pvt.h"
#include "session/input.h"
#include "session/pimg_file.h"

namespace pimgview {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;

/// Whether a reduced picture comes much sooner than the whole, and needs nothing else that reading does.
bool is_worthwhile(const ImageSpec& spec, const GlimpseSize& size)
{
    return double(spec.width) * spec.height > std::max(size.from, size.pixels) && !spec.deep && spec.depth <= 1
        && spec.get_int_attribute("Orientation", 1) <= 1 && spec.get_int_attribute(pimg::io::kUnassociatedAlpha) == 0
        && spec.channelformats.empty();
}

int factor_of(const ImageSpec& spec, double pixels)
{
    return std::max(1, int(std::ceil(std::sqrt(double(spec.width) * spec.height / pixels))));
}

/// A header for the picture reduced `factor` times, whose display window is its data window.
ImageSpec reduced_spec(ImageSpec spec, int factor)
{
    spec.width = spec.full_width = (spec.width + factor - 1) / factor;
    spec.height = spec.full_height = (spec.height + factor - 1) / factor;
    spec.x = spec.y = spec.full_x = spec.full_y = 0;
    spec.tile_width = spec.tile_height = spec.tile_depth = 0;
    return spec;
}

void take_mesh_layer(const std::string& filename, const GlimpseSize& size, Glimpse& result)
{
    OIIO::Filesystem::IOFile proxy(filename, OIIO::Filesystem::IOProxy::Read);
    pimg::Decoder decoder;
    if (!proxy.opened() || !pimg::io::open_decoder(&proxy, decoder))
        return;
    const ImageSpec stored = pimg::io::to_spec(decoder.desc());
    const int factor = factor_of(stored, size.pixels);
    if (!is_worthwhile(stored, size))
        return;
    const auto reduced = std::make_shared<ImageBuf>(reduced_spec(stored, factor));
    const ImageSpec& spec = reduced->spec();
    const auto pixel = std::ptrdiff_t(spec.pixel_bytes());
    std::vector<pimg::StridedChannel> channels;
    for (int c = 0; c < spec.nchannels; ++c)
        channels.push_back({ static_cast<char*>(reduced->localpixels()) + std::size_t(c) * spec.format.size(), pixel,
                             pixel * spec.width });
    constexpr double kVertices = 1e4;  // decoded in less than 0.1 s, and half as sharp as all of them in a window
    const double share = std::min(1.0, kVertices / std::max(1.0, double(decoder.vertices())));
    if (!decoder.read_preview(std::uint32_t(spec.width), std::uint32_t(spec.height), channels, share))
        return;
    result.pixels = reduced;
    result.stored = stored;
    result.factor = factor;
}

/// The largest level that is small enough, if it is one of the picture's in halves.
void take_level(OIIO::ImageInput& input, int part, const GlimpseSize& size, Glimpse& result)
{
    const ImageSpec stored = input.spec(part, 0);
    int level = 0;
    ImageSpec spec = stored;
    while (double(spec.width) * spec.height > size.pixels && spec.width > 1 && spec.height > 1)
        spec = input.spec(part, ++level);
    const int factor = 1 << level;
    if (level == 0 || spec.undefined() || !is_worthwhile(stored, size) || stored.width / factor != spec.width
        || stored.height / factor != spec.height)
        return;
    const auto reduced = std::make_shared<ImageBuf>(reduced_spec(stored, factor));
    // The level may be a row and a column smaller, which those before then stand for.
    const int width = reduced->spec().width, height = reduced->spec().height;
    std::vector<char> samples(spec.image_bytes());
    if (!input.read_image(part, level, 0, spec.nchannels, spec.format, samples.data()))
        return;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t from = std::size_t(std::min(y, spec.height - 1)) * std::size_t(spec.width)
                + std::size_t(std::min(x, spec.width - 1));
            std::copy_n(&samples[from * spec.pixel_bytes()], spec.pixel_bytes(),
                        static_cast<char*>(reduced->pixeladdr(x, y)));
        }
    result.pixels = reduced;
    result.stored = stored;
    result.factor = factor;
}

}  // namespace

Glimpse glimpse(const std::string& filename, const std::string& part, const GlimpseSize& size)
{
    Glimpse result;
    const std::string file = pimg::io::file_of(filename);
    std::unique_ptr<OIIO::ImageInput> input = pimgtool::pimg_input(file);
    const bool is_pimg = input != nullptr;
    ImageSpec spec;
    if (!is_pimg)
        input = OIIO::ImageInput::open(file);
    else if (!input->open(filename, spec))
        input = nullptr;
    int wanted = -1;
    for (int i = 0; input && input->seek_subimage(i, 0); ++i) {
        const ImageSpec header = input->spec();
        result.parts.push_back(pimgtool::part_name(header, i));
        if (part.empty() || result.parts.back() == part || std::to_string(i) == part) {
            wanted = i;
            result.bytes = std::max(result.bytes, double(header.image_bytes()));
        }
    }
    const bool single = result.parts.size() == 1 || (!part.empty() && wanted >= 0);
    if (single && is_pimg && file == filename)
        take_mesh_layer(file, size, result);
    else if (single && !is_pimg)
        take_level(*input, std::max(wanted, 0), size, result);
    OIIO::geterror();
    return result;
}

}  // namespace pimgview
