// SPDX-License-Identifier: BSD-3-Clause
#include "session/input.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/parts.h>

#include "session/colour.h"
#include "session/pimg_file.h"
#include "session/streams.h"

namespace pimgtool {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using pimg::format;
namespace Strutil = OIIO::Strutil;

using Progress = std::function<void(float)>;

/// A reader for the file; for .pimg files the one that is linked in. `filename` is the name that the user gave: its
/// extension decides if the first bytes do not tell the format. Null, with a line in `error`, if there is no reader.
std::unique_ptr<OIIO::ImageInput> open_input(const std::string& filename, const std::string& path,
                                             const ImageSpec& config, std::string& error)
{
    ImageSpec spec;
    std::unique_ptr<OIIO::ImageInput> input = pimg_input(path);
    if (input || (is_stream(filename) && (input = OIIO::ImageInput::create(filename)))) {
        if (input->open(path, spec, config))
            return input;
        error = pimg::first_line(input->geterror());
        if (!is_stream(filename))
            return nullptr;
    }
    OIIO::geterror();
    input = OIIO::ImageInput::open(path, &config);
    if (!input && error.empty())
        error = pimg::first_line(OIIO::geterror());
    OIIO::geterror();
    return input;
}

/// Whether a large picture has its first row. A .pimg file of a few bytes may claim a picture of many gigabytes: what cannot
/// be read is refused before there is memory for all of it.
bool has_first_row(OIIO::ImageInput& input, const ImageSpec& stored)
{
    constexpr OIIO::imagesize_t kLarge = 1 << 26;
    if (std::string(input.format_name()) != "pimg" || stored.image_bytes(true) < kLarge)
        return true;
    std::vector<unsigned char> row(stored.scanline_bytes(true));
    return input.read_scanline(stored.y, stored.z, OIIO::TypeDesc::UNKNOWN, row.data());
}

/// Reads one part into memory of our own, in the file's type.
bool read_part(OIIO::ImageInput& input, InputPart& part, const Progress& progress, std::string& error)
{
    const auto show = [](void* data, float done) {
        (*static_cast<const Progress*>(data))(done);
        return false;
    };
    input.seek_subimage(part.number, 0);
    part.stored = input.spec();
    if (!has_first_row(input, part.stored)) {
        error = input.geterror();
        return false;
    }
    ImageSpec spec = part.stored;
    spec.channelformats.clear();
    spec.tile_width = spec.tile_height = spec.tile_depth = 0;
    part.pixels = std::make_shared<ImageBuf>(spec);
    bool done = false;
    if (spec.deep) {
        OIIO::DeepData deep;
        done = input.read_native_deep_image(part.number, 0, deep);
        part.pixels->reset(part.stored);
        if (done)
            *part.pixels->deepdata() = deep;
    } else
        done = input.read_image(part.number, 0, 0, spec.nchannels, spec.format, part.pixels->localpixels(),
                                OIIO::AutoStride, OIIO::AutoStride, OIIO::AutoStride, show,
                                const_cast<Progress*>(&progress));
    if (!done)
        error = input.geterror();
    return done;
}

std::vector<ImageSpec> specs_of(OIIO::ImageInput& input)
{
    std::vector<ImageSpec> specs;
    for (int i = 0; input.seek_subimage(i, 0); ++i)
        specs.push_back(input.spec());
    input.geterror();  // only says that there are no more parts
    return specs;
}

/// The orientation of a Radiance file, from the line that gives the order of its pixels; 0 if there is none.
/// OpenImageIO confuses "+X +Y" with "-X -Y".
int radiance_orientation(const std::string& path)
{
    constexpr std::size_t kLongestHeader = 1 << 16;
    std::string text(kLongestHeader, '\0');
    text.resize(OIIO::Filesystem::read_bytes(path, text.data(), text.size()));
    const std::size_t line = text.find("\n\n");
    if (line == std::string::npos)
        return 0;
    static constexpr const char* kOrders[] = { "-Y+X", "-Y-X", "+Y-X", "+Y+X", "+X-Y", "-X-Y", "-X+Y", "+X+Y" };
    for (int i = 0; i < 8; ++i) {
        const std::string order = kOrders[i];
        const std::size_t second = text.find(order.substr(2), line + 2);
        if (text.compare(line + 2, 2, order, 0, 2) == 0 && second != std::string::npos
            && second < text.find('\n', line + 2))
            return i + 1;
    }
    return 0;
}

std::string names_of(const std::vector<ImageSpec>& specs)
{
    std::vector<std::string> names(specs.size());
    for (std::size_t i = 0; i < specs.size(); ++i)
        names[i] = part_name(specs[i], int(i));
    return Strutil::join(names, ", ");
}

/// The part asked for, or the first that holds a picture. -1, with a line in `error`, if there is no such part.
int find_part(const std::vector<ImageSpec>& specs, const std::string& wanted, std::string& error)
{
    const auto index = [&](auto found) {
        return found == specs.end() ? -1 : int(found - specs.begin());
    };
    if (wanted.empty() || wanted == "all") {
        const auto holds = [](const ImageSpec& spec) {
            return pimg::holds_picture(spec, "");
        };
        return std::max(0, index(std::find_if(specs.begin(), specs.end(), holds)));
    }
    int found = index(std::find_if(specs.begin(), specs.end(), [&](const ImageSpec& spec) {
        return Strutil::iequals(spec.get_string_attribute("oiio:subimagename"), wanted);
    }));
    if (found < 0 && Strutil::string_is_int(wanted))
        found = Strutil::stoi(wanted);
    if (found >= 0 && found < int(specs.size()))
        return found;
    error = format("no part \"{}\": expected 0 to {} or a name, found {}", wanted, specs.size() - 1, names_of(specs));
    return -1;
}

/// Formats whose parts belong together. Those of others are frames of animations or sizes of icons.
bool has_parts_of_a_picture(const OIIO::ImageInput& input)
{
    const std::string name = input.format_name();
    return name == "openexr" || name == "tiff";
}

std::string not_used(const std::vector<ImageSpec>& specs, int used)
{
    return format("of {} parts only {} is used: --part chooses, among {}", specs.size(),
                  part_name(specs[std::size_t(used)], used), names_of(specs));
}

/// Sets the colour space that the file rules of the configuration say.
void declare_ruled_space(const std::string& filename, InputPart& part)
{
    const std::string space = part.stored.get_string_attribute("oiio:ColorSpace");
    const std::string ruled = space_of_file(filename, part.stored);
    if (ruled == space)
        return;
    declare_space(part.pixels->specmod(), ruled);
    declare_space(part.stored, ruled);
}

}  // namespace

// OpenImageIO's reorient() exchanges 5 and 7 before version 3.1.
bool turn_upright(ImageBuf& pixels)
{
    ImageBuf turned;
    const int orientation = pixels.orientation();
    bool done = false;
    if (orientation == 5 || orientation == 7) {
        pixels.set_orientation(1);
        done = OIIO::ImageBufAlgo::transpose(turned, pixels);
        if (orientation == 7) {
            const ImageBuf transposed = std::exchange(turned, ImageBuf());
            done = done && OIIO::ImageBufAlgo::rotate180(turned, transposed);
        }
    } else
        done = OIIO::ImageBufAlgo::reorient(turned, pixels);
    if (!done) {
        pimg::set_error(pixels, turned.geterror());
        return false;
    }
    turned.set_orientation(1);
    pixels = std::move(turned);
    return true;
}

std::string part_name(const ImageSpec& spec, int number)
{
    const std::string name = spec.get_string_attribute("oiio:subimagename");
    return name.empty() ? std::to_string(number) : name;
}

bool read_file(const std::string& filename, const InputOptions& settings, const Progress& progress, InputFile& file,
               std::string& error)
{
    file = {};
    file.path = filename;
    if (is_stream(filename)) {
        if (!standard_input(file.path, error))
            return false;
        file.path += filename.substr(std::min(filename.find('?'), filename.size()));
    }
    const std::unique_ptr<OIIO::ImageInput> input = open_input(filename, file.path, settings.config, error);
    if (!input && file.path != filename)
        error = Strutil::replace(error, file.path, filename, true);
    if (!input)
        return false;
    const std::vector<ImageSpec> specs = specs_of(*input);
    const int picture = find_part(specs, settings.part, error);
    if (picture < 0)
        return false;
    file.parts.resize(1);
    file.parts[0].number = picture;
    const bool all =
        settings.part == "all" || (settings.part.empty() && settings.keeps_parts && has_parts_of_a_picture(*input));
    for (int i = 0; i < int(specs.size()); ++i)
        if (all && i != picture) {
            file.parts.emplace_back();
            file.parts.back().number = i;
        }
    if (file.parts.size() < specs.size() && settings.part.empty())
        file.warning = not_used(specs, picture);
    const bool is_radiance = std::string(input->format_name()) == "hdr";
    for (InputPart& part : file.parts) {
        if (!read_part(*input, part, progress, error))
            return false;
        declare_ruled_space(filename, part);
        if (const int orientation = is_radiance ? radiance_orientation(file.path) : 0)
            part.pixels->set_orientation(orientation);
        part.turned = settings.upright && part.pixels->orientation() > 1 && !part.pixels->deep();
        if (part.turned && !turn_upright(*part.pixels)) {
            error = "cannot turn it upright: " + part.pixels->geterror();
            return false;
        }
    }
    return true;
}

bool add_reader_hint(ImageSpec& config, const std::string& name, const std::string& value, const std::string& type,
                     std::string& error)
{
    const OIIO::TypeDesc wanted = !type.empty() ? OIIO::TypeDesc(type)
        : Strutil::string_is_int(value)         ? OIIO::TypeInt
        : Strutil::string_is_float(value)       ? OIIO::TypeFloat
                                                : OIIO::TypeString;
    if (wanted == OIIO::TypeInt && Strutil::string_is_int(value))
        config.attribute(name, Strutil::stoi(value));
    else if (wanted == OIIO::TypeFloat && Strutil::string_is_float(value))
        config.attribute(name, Strutil::stof(value));
    else if (wanted == OIIO::TypeString)
        config.attribute(name, value);
    else
        error = format("\"{}\": expected a value of type int, float or string", value);
    return error.empty();
}

}  // namespace pimgtool
