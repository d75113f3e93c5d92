// SPDX-License-Identifier: BSD-3-Clause
#include "session/part.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <pimg/colour.h>
#include <pimg/detail/format.h>
#include <pimg/display.h>
#include <pimg/labels.h>

#include "session/colour.h"
#include "session/pimg_file.h"

namespace pimgtool {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::ROI;
using OIIO::TypeDesc;
using pimg::format;

constexpr int kProbeSide = 64;  ///< pixels; enough for every number of an 8-bit format

/// Finds the type that `out` stores when it is asked for `type`, by writing a small picture: OpenImageIO has no
/// function that tells it.
bool stored_type(ImageOutput& out, const std::string& filename, int channels, TypeDesc& type, std::string& error)
{
    const ImageSpec spec(16, 16, channels, type);
    if (!out.open(filename, spec)) {
        error = out.geterror();
        return false;
    }
    type = out.spec().format;
    const std::vector<float> black(std::size_t(spec.image_pixels()) * std::size_t(channels), 0.0f);
    out.write_image(OIIO::TypeFloat, black.data());
    out.close();
    out.geterror();  // only the type matters here
    std::remove(filename.c_str());
    return true;
}

/// The part of a picture that a format without display window or negative coordinates can hold, as oiiotool does.
ROI writable_window(const ImageBuf& pixels, const ImageOutput& out)
{
    ROI window = pixels.roi();
    if (!out.supports("displaywindow"))
        window = pixels.roi_full();
    window.chbegin = 0;
    window.chend = pixels.nchannels();
    if (!out.supports("negativeorigin")) {
        window.xbegin = std::max(window.xbegin, 0);
        window.ybegin = std::max(window.ybegin, 0);
    }
    return window;
}

/// Whether an ICC profile is one of pictures with so many channels of colour. Others are left behind where pixels become
/// RGB or numbers: those of a CMYK photograph, or an RGB profile beside labels, which libpng refuses.
bool is_profile_for(const OIIO::ParamValue& profile, int channels)
{
    constexpr std::size_t kSpaceAt = 16;  // of the header: the signature of the data's colour space
    if (std::size_t(profile.datasize()) < kSpaceAt + 4)
        return false;
    const std::string space(static_cast<const char*>(profile.data()) + kSpaceAt, 4);
    return space == (channels < 3 ? "GRAY" : "RGB ");
}

/// The header of the file: the metadata of the pixels, stored as the types wanted.
ImageSpec file_spec(const ImageBuf& pixels, const PixelTypes& types, const ImageOutput& out)
{
    ImageSpec spec = pixels.spec();
    if (spec.get_int_attribute("oiio:BitsPerSample") != int(types.all.size()) * 8)
        spec.erase_attribute("oiio:BitsPerSample");
    // One level of no MIP-map. OpenEXR is told so for panoramas: OpenImageIO would wait for more and not close the file.
    if (spec.get_string_attribute("textureformat") != "LatLong Environment")
        spec.erase_attribute("textureformat");
    else
        spec.attribute("openexr:levelmode", 0);
    const OIIO::ParamValue* profile = spec.find_attribute("ICCProfile");
    if (profile != nullptr && !is_profile_for(*profile, spec.nchannels))
        spec.erase_attribute("ICCProfile.*");  // and what it says of itself
    spec.tile_width = spec.tile_height = spec.tile_depth = 0;
    // Level 6, OpenImageIO's default, makes files 2 to 3 % smaller but takes three times as long, which was a sixth of
    // the time of the whole command.
    if (std::string(out.format_name()) == "png" && spec.find_attribute("png:compressionLevel") == nullptr)
        spec.attribute("png:compressionLevel", 4);
    spec.set_format(types.all);
    if (int(types.per_channel.size()) == spec.nchannels && out.supports("channelformats"))
        spec.channelformats = types.per_channel;
    return spec;
}

/// The first of the types for labels that the format stores as such and that holds them; else the one that holds most.
/// OpenEXR has integers, but most readers turn pixels into floats that end at one; so there it is float.
bool find_label_type(ImageOutput& out, const std::string& scratch, pimg::Index count, TypeDesc& type,
                     std::string& error)
{
    double most = 0.0;
    for (const TypeDesc wanted : { TypeDesc::UINT32, TypeDesc::UINT16, TypeDesc::FLOAT, TypeDesc::UINT8 }) {
        if (std::string(out.format_name()) == "openexr" && wanted != TypeDesc::FLOAT)
            continue;
        TypeDesc stored = wanted;
        if (!stored_type(out, scratch, 1, stored, error))
            return false;
        if (stored == wanted && pimg::largest_label(stored) > most) {
            most = pimg::largest_label(stored);
            type = stored;
            if (most >= double(count) - 1.0)
                return true;
        }
    }
    return most > 0.0;
}

/// Labels as pixels of another type, not scaled. `type` may be UNKNOWN: then it becomes what the format holds them in.
bool convert_labels(const ImageBuf& labels, ImageOutput& out, const std::string& scratch, TypeDesc& type,
                    ImageBuf& result, std::string& error)
{
    const auto count = pimg::Index(labels.spec().get_int_attribute(pimg::kLabelCount));
    if (type == TypeDesc::UNKNOWN && !find_label_type(out, scratch, count, type, error))
        return false;
    ImageSpec spec = labels.spec();
    spec.set_format(type);
    result.reset(spec);
    if (pimg::write_labels(result, result.roi(), static_cast<const pimg::Index*>(labels.localpixels()),
                           std::size_t(spec.width), count))
        return true;
    error = result.geterror();
    return false;
}

/// For a format without names of channels: the picture with its alpha instead of `source`. `warning` tells what is left
/// out.
bool keep_picture(const ImageBuf*& source, ImageBuf& kept, const ImageOutput& out, const std::string& layer,
                  const OutputReport& report)
{
    pimg::Colour colour;
    if (!pimg::Colour::resolve(source->spec(), "", layer, colour, report.error))
        return false;
    std::vector<int> order(std::size_t(colour.count() == 2 ? 1 : colour.count()));
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = colour.channel(int(i));
    if (colour.alpha() >= 0 && out.supports("alpha"))
        order.push_back(colour.alpha());
    std::vector<std::string> names, left_out;
    for (std::size_t i = 0; i < order.size(); ++i)
        names.emplace_back(order[i] == colour.alpha() ? "A" : colour.count() < 3 ? "Y" : std::string(1, "RGB"[i]));
    bool in_order = int(order.size()) == source->nchannels();
    for (int c = 0; c < source->nchannels(); ++c) {
        in_order = in_order && order[std::size_t(c)] == c;
        if (std::count(order.begin(), order.end(), c) == 0)
            left_out.push_back(source->spec().channel_name(c));
    }
    if (in_order && source->spec().z_channel < 0)
        return true;
    kept = OIIO::ImageBufAlgo::channels(*source, int(order.size()), order, {}, names);
    kept.specmod().alpha_channel = names.back() == "A" ? int(names.size()) - 1 : -1;
    kept.specmod().z_channel = -1;
    source = &kept;
    if (!left_out.empty())
        add_warning(report.warning,
                    format("written without {}, which {} does not hold", OIIO::Strutil::join(left_out, ", "),
                           out.format_name()));
    return true;
}

bool refuse_labels(const ImageOutput& out, const std::string& why, const OutputReport& report)
{
    report.error =
        format("{} is no format for labels ({}): expected one that keeps numbers, such as .exr, .tif, .png or "
               ".pimg",
               out.format_name(), why);
    return false;
}

/// The samples of a small picture after it was written and read again. Empty if that is not possible.
std::vector<unsigned char> read_back(ImageOutput& out, const std::string& scratch, const ImageBuf& probe)
{
    std::vector<unsigned char> back;
    const ImageSpec& spec = probe.spec();
    const bool written = out.open(scratch, spec) && probe.write(&out) && out.close();
    out.geterror();
    if (const std::unique_ptr<OIIO::ImageInput> in = written ? OIIO::ImageInput::open(scratch) : nullptr) {
        back.resize(spec.image_bytes());
        if (!in->read_image(0, 0, 0, spec.nchannels, spec.format, back.data()))
            back.clear();
        in->geterror();
    }
    OIIO::geterror();
    std::remove(scratch.c_str());
    return back;
}

ImageSpec probe_spec(const ImageSpec& header)
{
    ImageSpec spec = header;
    spec.x = spec.y = spec.full_x = spec.full_y = 0;
    spec.width = spec.full_width = spec.height = spec.full_height = kProbeSide;
    return spec;
}

/// Whether the format keeps numbers up to `count` - 1 as they are: found by writing some, since some formats are lossy
/// always, some with some codecs, and some have fewer colours than numbers.
bool keeps_labels(ImageOutput& out, const std::string& scratch, const ImageSpec& header, pimg::Index count)
{
    ImageBuf probe(probe_spec(header));
    std::vector<pimg::Index> labels(probe.spec().image_pixels());
    for (std::size_t i = 0; i < labels.size(); ++i)
        labels[i] = pimg::Index((i * 2654435761u >> 7) % count);
    pimg::write_labels(probe, probe.roi(), labels.data(), kProbeSide, count);
    const std::vector<unsigned char> back = read_back(out, scratch, probe);
    return !back.empty() && std::memcmp(back.data(), probe.localpixels(), back.size()) == 0;
}

/// Whether the format keeps sign and fractions: found in the same way.
bool keeps_gains(ImageOutput& out, const std::string& scratch, const ImageSpec& header)
{
    constexpr float kGain = -1.375f, kClose = 0.01f;
    ImageSpec spec = probe_spec(header);
    spec.channelformats.clear();
    if (!spec.format.is_floating_point())
        return false;
    spec.set_format(OIIO::TypeFloat);
    ImageBuf probe(spec);
    OIIO::ImageBufAlgo::fill(probe, std::vector<float>(std::size_t(spec.nchannels), kGain));
    const std::vector<unsigned char> back = read_back(out, scratch, probe);
    std::vector<float> samples(back.size() / sizeof(float));
    if (!back.empty())
        std::memcpy(samples.data(), back.data(), back.size());
    return !samples.empty()
        && std::all_of(samples.begin(), samples.end(), [](float sample) { return std::fabs(sample - kGain) < kClose; });
}

/// Chooses a lossless codec for labels: a lossy one would turn them into other numbers.
bool avoid_lossy_codec(const OutputPicture& picture, ImageOutput& out, const std::string& scratch, ImageSpec& spec,
                       const OutputReport& report)
{
    const auto count = pimg::Index(std::max(1, picture.pixels.spec().get_int_attribute(pimg::kLabelCount)));
    if (std::string(out.format_name()) == "pimg" || keeps_labels(out, scratch, spec, count))
        return true;
    const std::string compression = spec.get_string_attribute("compression");
    spec.attribute("compression", "zip");
    if (!compression.empty() && keeps_labels(out, scratch, spec, count)) {
        add_warning(report.warning, format("compression {} would change labels: zip instead", compression));
        return true;
    }
    return refuse_labels(out, "it changes numbers", report);
}

/// Whether files of the format say that colours are not multiplied by alpha. In others they are, always.
bool knows_unassociated(const ImageOutput& out)
{
    const std::string name = out.format_name();
    for (const char* known : { "png", "tiff", "targa", "pimg", "webp", "null" })
        if (name == known)
            return true;
    return false;
}

/// Whether samples are those of sRGB, whatever the space is called.
bool is_srgb(const pimg::Colour& colour)
{
    constexpr float kSame = 1e-3f;  // a quarter of an 8-bit step
    const float encoded[3] = { 0.2f, 0.5f, 0.8f };
    float rgb[3] = { encoded[0], encoded[1], encoded[2] };
    colour.decode(rgb, 1);
    colour.to_rec709(rgb, 1);
    bool same = true;
    for (std::size_t c = 0; c < 3; ++c)
        same = same && std::fabs(rgb[c] - float(pimg::srgb_decoded(double(encoded[c])))) < kSame;
    return same;
}

/// Files of floats are taken as linear light, so one of encoded samples must say that they are not. OpenEXR has an
/// attribute for the name of the space, by the Color Interop Forum; TIFF has ICC profiles, and .pimg has all metadata. Otherwise, a warning.
bool declare_encoding(const OutputPicture& picture, ImageOutput& out, const std::string& scratch, Part& part,
                      const OutputReport& report)
{
    if (picture.labels || part.is_encoded || part.source->deep())
        return true;
    ImageSpec meaning = part.source->spec();
    meaning.format = part.source->nativespec().format;
    const pimg::Colour colour = meaning_of(meaning);
    const std::string format_name = out.format_name();
    if (!colour.encoded() || format_name == "pimg" || format_name == "null"
        || (format_name == "tiff" && part.spec.find_attribute("ICCProfile") != nullptr))
        return true;
    TypeDesc type = part.spec.format;
    if (!stored_type(out, scratch, part.spec.nchannels, type, report.error))
        return false;
    if (!type.is_floating_point())
        return true;
    const std::string space = is_srgb(colour) ? "srgb_rec709_scene" : colour.config_name();
    if (format_name == "openexr" && !space.empty())
        part.spec.attribute("colorInteropID", space);
    else if (!meaning.format.is_floating_point())  // who made floats of them has thought of it
        add_warning(report.warning,
                    format("the samples are encoded, but {} files of {} are taken as linear light: --tocolorspace "
                           "linear converts them",
                           format_name, type));
    return true;
}

}  // namespace

void add_warning(std::string& warning, const std::string& more)
{
    warning += (warning.empty() ? "" : "; ") + more;
}

bool make_part(const OutputPicture& picture, const std::string& filename, ImageOutput& out, const std::string& scratch,
               Part& part, const OutputReport& report)
{
    part.source = &picture.pixels;
    const bool names_channels = out.supports("nchannels") || has_pimg_extension(filename);
    const bool deep = part.source->deep();
    if (!names_channels && !picture.labels && !deep
        && !keep_picture(part.source, part.kept, out, picture.layer, report))
        return false;
    TypeDesc type = picture.types.all;
    if (picture.encode_srgb && !stored_type(out, scratch, part.source->nchannels(), type, report.error))
        return false;
    const ROI window = writable_window(*part.source, out);
    if (window != part.source->roi() && !deep) {
        part.cropped = OIIO::ImageBufAlgo::crop(*part.source, window);
        part.source = &part.cropped;
    }
    PixelTypes types = picture.types;
    if (picture.labels) {
        std::string why;
        if (!convert_labels(*part.source, out, scratch, types.all, part.numbers, why))
            return refuse_labels(out, why, report);
        part.source = &part.numbers;
    }
    if (picture.is_straight && !picture.labels && !deep && !knows_unassociated(out)) {
        part.associated = OIIO::ImageBufAlgo::premult(*part.source);
        part.associated.specmod().erase_attribute(pimg::io::kUnassociatedAlpha);
        part.source = &part.associated;
    }
    part.is_encoded = picture.encode_srgb && !type.is_floating_point() && !deep;
    if (part.is_encoded) {
        const bool whole = part.source == &picture.pixels || names_channels;
        part.encoded = srgb_encoded(*part.source, 0, whole ? picture.layer : "");
        if (part.encoded.has_error()) {
            report.error = part.encoded.geterror();
            return false;
        }
        part.source = &part.encoded;
    }
    part.spec = file_spec(*part.source, types, out);
    if (picture.is_gain && !keeps_gains(out, scratch, part.spec)) {
        report.error = "a gain has a sign and fractions: expected .exr, .tif, .pfm or .pimg of half or float samples";
        return false;
    }
    if (!declare_encoding(picture, out, scratch, part, report))
        return false;
    if (has_pimg_extension(filename))
        pimg::io::add_hints(part.spec, picture.options);
    return !picture.labels || avoid_lossy_codec(picture, out, scratch, part.spec, report);
}

void share_attributes(const ImageSpec& first, ImageSpec& part)
{
    for (const char* name : { "chromaticities", "PixelAspectRatio", "smpte:TimeCode", "smpte:KeyCode" }) {
        part.erase_attribute(name);
        if (const OIIO::ParamValue* shared = first.find_attribute(name))
            part.attribute(name, shared->type(), shared->data());
    }
}

}  // namespace pimgtool
