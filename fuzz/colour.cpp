// SPDX-License-Identifier: BSD-3-Clause
// What a picture says of its colours: the name of a space, a list of numbers as options give colours, and an ICC profile.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <pimg/colour.h>
#include <pimg/detail/format.h>

#include "ops/painting/painting.h"
#include "taken.h"

using namespace pimg;

namespace {

/// Samples of a picture decode to finite light, and a picture that is declared linear is understood again.
void use(const Colour& colour, const OIIO::ImageSpec& spec)
{
    float rgb[] = { 0.0f, 0.5f, 1.0f, 1.0f, 1.0f, 1.0f };
    colour.decode(rgb, 2);
    for (const float sample : rgb)
        must(std::isfinite(sample));
    colour.to_rec709(rgb, 2);
    colour.from_rec709(rgb, 2);
    must(!std::isnan(colour.luminance(rgb)));
    must(!colour.description().empty());
    OIIO::ImageSpec linear = spec;
    linear.set_format(OIIO::TypeDesc::FLOAT);
    colour.declare_linear(linear);
    Colour again;
    std::string error;
    must(Colour::resolve(linear, "", again, error) && !again.encoded());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Taken in(data, size);
    const std::string space = in.text('\n'), list = in.text('\n');
    std::vector<float> values;
    for (int channels = 1; channels <= 3; ++channels)
        if (parse_colour(list, channels, values)) {
            must(int(values.size()) >= channels);
            for (const float value : values)
                must(std::isfinite(value));
        }
    OIIO::ImageSpec spec(4, 4, 3, size % 2 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::HALF);
    if (in.left() > 0)
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, int(in.left())), in.here());
    for (const std::string& name : { std::string(), space }) {
        Colour colour;
        std::string error;
        if (Colour::resolve(spec, name, colour, error))
            use(colour, spec);
        else
            must_be_message(one_line(error));
    }
    return 0;
}
