// SPDX-License-Identifier: BSD-3-Clause
// The reader of .pimg files as OpenImageIO calls it: a file in memory behind an IOProxy, and the text `?key=value&...` that
// asks for a filter. The input is that text without its question mark, a zero byte, and the file.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>

#include "pimg_pvt.h"
#include "taken.h"

namespace {

/// Pictures up to this many samples are read, each with its filter, or the time goes into large ones.
constexpr std::uint64_t kSamples = 1 << 13;

void read_levels(OIIO::ImageInput& input)
{
    OIIO::ImageSpec spec;
    for (int level = 0; input.seek_subimage(0, level) && level < 4; ++level) {
        spec = input.spec();
        if (spec.image_pixels() * std::uint64_t(spec.nchannels) > kSamples)
            return;
        std::vector<float> pixels(std::size_t(spec.image_pixels()) * std::size_t(spec.nchannels));
        if (!input.read_image(0, level, 0, spec.nchannels, OIIO::TypeFloat, pixels.data()))
            must(!input.geterror().empty());
    }
    OIIO::ImageBuf thumbnail;
    if (!input.get_thumbnail(thumbnail, 0))
        input.geterror();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Taken in(data, size);
    const std::string query = in.text('\0');
    if (query.find('/') != query.npos)  // an option may name a picture: none outside the scratch folder
        return 0;
    OIIO::attribute("threads", 1);
    OIIO::attribute("limits:imagesize_MB", 16);
    OIIO::Filesystem::IOMemReader proxy(const_cast<std::uint8_t*>(in.here()), in.left());
    const std::unique_ptr<OIIO::ImageInput> input = pimg::io::make_input();
    OIIO::ImageSpec config, spec;
    OIIO::Filesystem::IOProxy* pointer = &proxy;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &pointer);
    if (input->open("fuzzed.pimg?" + query, spec, config))
        read_levels(*input);
    else
        must_be_message(input->geterror());
    input->close();
    return 0;
}
