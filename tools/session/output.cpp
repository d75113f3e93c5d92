// SPDX-License-Identifier: BSD-3-Clause
#include "session/output.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>
#include <mutex>

#include <unistd.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <pimg/colour.h>
#include <pimg/detail/format.h>
#include <pimg/detail/safe_file.h>
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
namespace Filesystem = OIIO::Filesystem;
using pimg::format;

/// Names of the files being written, for the signal handler: interrupted work leaves nothing behind either. Frames
/// that are worked on together write one each.
constexpr int kUnfinished = 256;
char unfinished_files[kUnfinished][4096];
std::mutex unfinished_mutex;
int unfinished_count = 0;

void remove_unfinished(int signal)
{
    for (const char* name : unfinished_files)
        if (name[0] != '\0')
            unlink(name);
    _exit(128 + signal);
}

/// Signals that are ignored, as under nohup, stay so.
void on_interruption(void (*handler)(int))
{
    for (const int signal : { SIGINT, SIGTERM, SIGHUP })
        if (std::signal(signal, handler) == SIG_IGN)
            std::signal(signal, SIG_IGN);
}

/// A name beside that of a file to be written; what bears it is removed unless it was kept.
class TemporaryName {
public:
    explicit TemporaryName(const std::string& target) : m_name(pimg::SafeFile::temporary_name(target))
    {
        const std::lock_guard<std::mutex> lock(unfinished_mutex);
        for (auto& slot : unfinished_files)
            if (slot[0] == '\0' && m_name.size() < sizeof slot) {
                m_slot = slot;
                std::copy(m_name.begin(), m_name.end(), slot);
                break;
            }
        if (unfinished_count++ == 0)
            on_interruption(remove_unfinished);
    }
    ~TemporaryName()
    {
        const std::lock_guard<std::mutex> lock(unfinished_mutex);
        if (--unfinished_count == 0)
            on_interruption(SIG_DFL);
        if (m_slot != nullptr)
            std::fill(m_slot, m_slot + m_name.size(), '\0');
        std::remove(m_name.c_str());  // kept files have another name by now
    }
    TemporaryName(const TemporaryName&) = delete;
    TemporaryName& operator=(const TemporaryName&) = delete;

    const std::string& name() const { return m_name; }

private:
    std::string m_name;
    char* m_slot = nullptr;
};

/// What `out` stores when asked for `type`: found by writing a small picture, since OpenImageIO offers
/// no question for it and the answer decides what the real one holds.
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

/// The header of the file: the metadata of the pixels, stored as the types wanted.
ImageSpec file_spec(const ImageBuf& pixels, const PixelTypes& types, const ImageOutput& out)
{
    ImageSpec spec = pixels.spec();
    if (spec.get_int_attribute("oiio:BitsPerSample") != int(types.all.size()) * 8)
        spec.erase_attribute("oiio:BitsPerSample");
    spec.erase_attribute("textureformat");  // one level of no MIP-map
    spec.tile_width = spec.tile_height = spec.tile_depth = 0;
    // Files two to three per cent larger than by OpenImageIO's 6, in a third of the time, which was a sixth of all of
    // it.
    if (std::string(out.format_name()) == "png" && spec.find_attribute("png:compressionLevel") == nullptr)
        spec.attribute("png:compressionLevel", 4);
    spec.set_format(types.all);
    if (int(types.per_channel.size()) == spec.nchannels && out.supports("channelformats"))
        spec.channelformats = types.per_channel;
    return spec;
}

/// Hands the pixels to a writer and everything it says to `error`.
bool write_through(ImageOutput& out, const ImageBuf& pixels, const std::string& filename, const ImageSpec& spec,
                   const std::function<void(float)>& progress, std::string& error)
{
    const auto show = [](void* data, float done) {
        (*static_cast<const std::function<void(float)>*>(data))(done);
        return false;
    };
    if (!out.open(filename, spec)) {
        error = out.geterror();
        return false;
    }
    const bool written = pixels.write(&out, show, const_cast<std::function<void(float)>*>(&progress));
    if (!written)
        error = pixels.has_error() ? pixels.geterror() : out.geterror();
    const bool closed = out.close();
    if (written && !closed)
        error = out.geterror();
    if (!(written && closed) && error.empty())
        error = format("the writer of {} gave up without saying why", out.format_name());
    return written && closed;
}

/// Whether a file can be read to its last pixel.
bool is_readable(const std::string& filename, const ImageSpec& spec)
{
    const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(filename);
    if (!in) {
        OIIO::geterror();
        return true;  // formats that are only written
    }
    std::vector<float> row(std::size_t(in->spec().width) * std::size_t(in->spec().nchannels));
    const int last = in->spec().y + in->spec().height - 1;
    const bool fine = in->spec().width == spec.width && in->spec().height == spec.height
        && (in->spec().tile_width > 0 || in->read_scanline(last, 0, OIIO::TypeFloat, row.data()));
    in->geterror();
    return fine;
}

/// Whether a writer can write through a file of ours. OpenImageIO 2.4's for TIFF says so and loses its directory; without,
/// it reports what fails.
bool takes_proxy(const ImageOutput& out)
{
    return out.supports("ioproxy") && std::string(out.format_name()) != "tiff";
}

/// Writes a file that replaces `target` when all of it is on disk. Not every writer says that the disk was full: those
/// that can write through a file of ours, others are given the benefit of a doubt only if there was room for more and
/// the end of the file can be read.
bool write_safely(ImageOutput& out, const ImageBuf& pixels, const std::string& target, const std::string& temporary,
                  ImageSpec spec, const std::function<void(float)>& progress, std::string& error)
{
    pimg::SafeFile file;
    if (!file.open(target, temporary)) {
        error = format("cannot write \"{}\": {}", target, file.error());
        return false;
    }
    bool written = false;
    if (takes_proxy(out)) {
        pimg::SafeFileProxy proxy(file);
        Filesystem::IOProxy* pointer = &proxy;
        spec.attribute("oiio:ioproxy", TypeDesc::PTR, &pointer);
        written = write_through(out, pixels, file.name(), spec, progress, error);
        proxy.flush();
    } else
        written = write_through(out, pixels, file.name(), spec, progress, error) && file.has_room();
    if (written && file.error().empty() && !takes_proxy(out) && !file.is_empty() && !is_readable(file.name(), spec)) {
        error = format("cannot write \"{}\": what was written cannot be read", target);
        return false;
    }
    if (written && ((file.error().empty() && file.is_empty()) || file.keep()))
        return true;
    if (!file.error().empty())
        error = format("cannot write \"{}\": {}", target, file.error());
    return false;
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
    std::vector<int> order;
    for (int i = 0; i < (colour.count() == 2 ? 1 : colour.count()); ++i)
        order.push_back(colour.channel(i));
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
        report.warning = format("written without {}, which {} does not hold", OIIO::Strutil::join(left_out, ", "),
                                out.format_name());
    return true;
}

/// Labels are numbers: a codec that changes them a little makes others of them.
void avoid_lossy_codec(const OutputPicture& picture, ImageSpec& spec, std::string& warning)
{
    if (!picture.labels)
        return;
    const std::string compression = spec.get_string_attribute("compression");
    for (const char* lossy : { "pxr24", "b44", "dwa" })
        if (OIIO::Strutil::istarts_with(compression, lossy)) {
            warning = format("compression {} would change labels: zip instead", compression);
            spec.attribute("compression", "zip");
        }
}

}  // namespace

const char* const kOutputTypes = "uint8, uint16, uint32, int8, int16, int32, half, float, double";

TypeDesc output_type(const std::string& word)
{
    for (const TypeDesc::BASETYPE type :
         { TypeDesc::UINT8, TypeDesc::UINT16, TypeDesc::UINT32, TypeDesc::INT8, TypeDesc::INT16, TypeDesc::INT32,
           TypeDesc::HALF, TypeDesc::FLOAT, TypeDesc::DOUBLE })
        if (TypeDesc(word) == TypeDesc(type))
            return type;
    return TypeDesc::UNKNOWN;
}

bool can_write(const std::string& filename, std::string& error)
{
    const std::string extension = Filesystem::extension(filename, false);
    const std::string directory = Filesystem::parent_path(filename);
    if (extension.empty())
        error = "expected a name with the extension of an image format, such as .png or .exr";
    else if (!directory.empty() && !Filesystem::is_directory(directory))
        error = format("no directory \"{}\"", directory);
    else if (access(directory.empty() ? "." : directory.c_str(), W_OK) != 0)
        error = format("no permission to write in directory \"{}\"", directory.empty() ? "." : directory);
    else if (Filesystem::is_directory(filename))
        error = "it is a directory";
    else if (!create_output(filename))
        error = format("no image format that OpenImageIO can write has the extension \".{}\"", extension);
    OIIO::geterror();  // said above in fewer words
    return error.empty();
}

bool write_picture(const OutputPicture& picture, const std::string& filename,
                   const std::function<void(float)>& progress, const OutputReport& report)
{
    std::string& error = report.error;
    const std::unique_ptr<ImageOutput> out = create_output(filename, picture.hierarchy);
    if (!out) {
        error = OIIO::geterror();
        return false;
    }
    const TemporaryName file(filename);
    ImageBuf pixels, kept;  // as they are written, where that differs from what they are
    const ImageBuf* source = &picture.pixels;
    const bool names_channels = out->supports("nchannels") || has_pimg_extension(filename);
    if (!names_channels && !picture.labels && !source->deep()
        && !keep_picture(source, kept, *out, picture.layer, report))
        return false;
    TypeDesc type = picture.types.all;
    if (picture.encode_srgb && !stored_type(*out, file.name(), source->nchannels(), type, error))
        return false;
    const ROI window = writable_window(*source, *out);
    if (window != source->roi() && !source->deep()) {
        pixels = OIIO::ImageBufAlgo::crop(*source, window);
        source = &pixels;
    }
    PixelTypes types = picture.types;
    ImageBuf numbers;
    if (picture.labels) {
        if (!convert_labels(*source, *out, file.name(), types.all, numbers, error))
            return false;
        source = &numbers;
    }
    const bool encode = picture.encode_srgb && !type.is_floating_point() && !source->deep();
    if (encode) {
        pixels = srgb_encoded(*source, 0, source == &picture.pixels || names_channels ? picture.layer : "");
        if (pixels.has_error()) {
            error = pixels.geterror();
            return false;
        }
        source = &pixels;
    }
    ImageSpec spec = file_spec(*source, types, *out);
    avoid_lossy_codec(picture, spec, report.warning);
    if (has_pimg_extension(filename))
        pimg::io::add_hints(spec, picture.options);
    if (!write_safely(*out, *source, filename, file.name(), spec, progress, error))
        return false;
    report.summary =
        format("{} x {} {}{}", spec.width, spec.height, out->spec().format.c_str(), encode ? ", encoded sRGB" : "");
    return true;
}

}  // namespace pimgtool
