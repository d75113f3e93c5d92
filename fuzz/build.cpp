// SPDX-License-Identifier: BSD-3-Clause
// Options of building, of any value, and samples of any value: a picture is built or there is one line that says why not.
// The first line are the options, as after --build; then come size, kind and samples.
#include <cstdint>
#include <string>
#include <vector>

#include <pimg/detail/format.h>
#include <pimg/filter_table.h>
#include <pimg/imagebufalgo.h>

#include "taken.h"

using namespace pimg;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Taken in(data, size);
    OptionTexts texts;
    BuildOptions options;
    std::string error;
    if (!split_options(in.text('\n'), texts, error, ':') || !set_options(options, texts, error)) {
        must_be_message(one_line(error));
        return 0;
    }
    const int width = 1 + in.number<std::uint8_t>() % 16, height = 1 + in.number<std::uint8_t>() % 16;
    const int kind = in.number<std::uint8_t>();
    OIIO::ImageBuf picture(OIIO::ImageSpec(width, height, 1 + kind % 4, OIIO::TypeDesc::FLOAT));
    std::vector<float> samples(picture.spec().image_pixels() * std::size_t(picture.nchannels()));
    for (float& sample : samples)
        sample = in.number<float>();
    picture.set_pixels(picture.roi(), OIIO::TypeDesc::FLOAT, samples.data());
    ProgressiveImage progressive;
    if (!progressive.build(picture, options, 1)) {
        must_be_message(progressive.error());
        return 0;
    }
    const OIIO::ImageBuf result = ImageBufAlgo::level_image(progressive, {}, {}, 1);
    must(!result.has_error() || !result.geterror().empty());
    return 0;
}
