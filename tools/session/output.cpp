// SPDX-License-Identifier: BSD-3-Clause
#include "session/output.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>

#include <unistd.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/safe_file.h>

#include "session/part.h"
#include "session/pimg_file.h"
#include "session/streams.h"

namespace pimgtool {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
namespace Filesystem = OIIO::Filesystem;
using pimg::format;

/// The most files that are written at the same time, one by each frame. Their names are kept for the signal handler and
/// for libraries of formats that end the program, as libjpeg does on a full disk, so that nothing is left behind.
constexpr int kUnfinished = 256;
char unfinished_files[kUnfinished][4096];
std::mutex unfinished_mutex;
int unfinished_count = 0;

void remove_unfinished()
{
    for (const char* name : unfinished_files)
        if (name[0] != '\0')
            unlink(name);
}

void end_interrupted(int signal)
{
    remove_unfinished();
    _exit(128 + signal);
}

/// Signals that are ignored, as under nohup, stay so.
void on_interruption(void (*handler)(int))
{
    for (const int signal : { SIGINT, SIGTERM, SIGHUP })
        if (std::signal(signal, handler) == SIG_IGN)
            std::signal(signal, SIG_IGN);
}

/// A temporary name in the folder of the file to be written. A file of this name is removed in the end, unless it was
/// renamed.
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
            on_interruption(end_interrupted);
        static const int once = std::atexit(remove_unfinished);
        (void)once;
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

using Parts = std::vector<std::unique_ptr<Part>>;
using Progress = std::function<void(float)>;

/// Opens the file for a part; the header of the first has a proxy, if there is one.
bool open_part(ImageOutput& out, const std::string& filename, const Parts& parts, std::size_t i)
{
    if (i > 0)
        return out.open(filename, parts[i]->spec, ImageOutput::AppendSubimage);
    if (parts.size() == 1)
        return out.open(filename, parts[0]->spec);
    std::vector<ImageSpec> specs(parts.size());
    std::transform(parts.begin(), parts.end(), specs.begin(), [](const auto& part) { return part->spec; });
    return out.open(filename, int(specs.size()), specs.data());
}

/// Gives the pixels to a writer. Its messages go to `error`.
bool write_through(ImageOutput& out, const Parts& parts, const std::string& filename, const Progress& progress,
                   std::string& error)
{
    struct Share {
        const Progress& progress;
        float before, each;
    };
    const auto show = [](void* data, float done) {
        const Share& share = *static_cast<const Share*>(data);
        share.progress(share.before + share.each * done);
        return false;
    };
    bool written = true;
    for (std::size_t i = 0; i < parts.size() && written; ++i) {
        const ImageBuf& pixels = *parts[i]->source;
        Share share { progress, float(i) / float(parts.size()), 1.0f / float(parts.size()) };
        if (!open_part(out, filename, parts, i)) {
            error = out.geterror();
            return false;
        }
        out.geterror();  // about metadata that was left out, which is no failure
        written = pixels.write(&out, show, &share);
        if (!written)
            error = pixels.has_error() ? pixels.geterror() : out.geterror();
    }
    const bool closed = out.close();
    if (written && !closed)
        error = out.geterror();
    if (!(written && closed) && error.empty())
        error = format("the writer of {} failed without giving a reason", out.format_name());
    return written && closed;
}

/// Whether a file can be read to its last pixel.
bool is_readable(const std::string& filename, const Parts& parts)
{
    const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(filename);
    if (!in) {
        OIIO::geterror();
        return true;  // formats that are only written
    }
    const int last_part = int(parts.size()) - 1;
    const ImageSpec& written = parts.back()->spec;
    bool fine = in->seek_subimage(last_part, 0);
    const ImageSpec spec = in->spec();
    std::vector<float> row(std::size_t(spec.width) * std::size_t(spec.nchannels));
    const int last = spec.y + spec.height - 1;
    fine = fine && spec.width == written.width && spec.height == written.height
        && (spec.deep || spec.tile_width > 0
            || in->read_scanlines(last_part, 0, last, last + 1, 0, 0, spec.nchannels, OIIO::TypeFloat, row.data()));
    in->geterror();
    return fine;
}

/// Whether a writer can write through a file of ours. OpenImageIO 2.4's writer of TIFF says that it can, but then loses
/// the directory of the file; writing by itself it reports errors reliably.
bool takes_proxy(const ImageOutput& out)
{
    return out.supports("ioproxy") && std::string(out.format_name()) != "tiff";
}

/// Writes a file that replaces `target` when all of it is on disk. Writers that write through a file of ours report a
/// full disk. Others may not; what they wrote counts only if there was room for more and the end of the file can be
/// read.
bool write_safely(ImageOutput& out, const Parts& parts, const std::string& target, const std::string& temporary,
                  const Progress& progress, std::string& error)
{
    pimg::SafeFile file;
    if (!file.open(target, temporary)) {
        error = file.error();
        return false;
    }
    bool written = false;
    if (takes_proxy(out)) {
        pimg::SafeFileProxy proxy(file);
        Filesystem::IOProxy* pointer = &proxy;
        parts[0]->spec.attribute("oiio:ioproxy", TypeDesc::PTR, &pointer);
        written = write_through(out, parts, file.name(), progress, error);
        proxy.flush();
    } else
        written = write_through(out, parts, file.name(), progress, error) && file.has_room();
    if (written && file.error().empty() && !takes_proxy(out) && !file.is_empty() && !is_readable(file.name(), parts)) {
        error = "what was written cannot be read";
        return false;
    }
    if (written && ((file.error().empty() && file.is_empty()) || file.keep()))
        return true;
    if (!file.error().empty())
        error = file.error();
    return false;
}

bool same_display_window(const ImageBuf& a, const ImageBuf& b)
{
    const OIIO::ROI x = a.roi_full(), y = b.roi_full();
    return x.xbegin == y.xbegin && x.xend == y.xend && x.ybegin == y.ybegin && x.yend == y.yend;
}

/// Which parts are written. `warning` tells which are left out.
std::vector<std::size_t> choose_parts(const std::vector<OutputPicture>& parts, std::size_t picture,
                                      const std::string& filename, std::string& warning)
{
    std::vector<std::size_t> chosen;
    std::vector<std::string> left_out;
    const bool has_room = holds_parts(filename);
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (i == picture || (has_room && same_display_window(parts[i].pixels, parts[picture].pixels)))
            chosen.push_back(i);
        else
            left_out.push_back(parts[i].part);
    if (!left_out.empty())
        add_warning(warning,
                    format("written without part{} {}, {}", left_out.size() > 1 ? "s" : "",
                           OIIO::Strutil::join(left_out, ", "),
                           has_room ? "which have another display window" : "as the format holds one"));
    return chosen;
}

/// Writes to a file, whose name may differ from the one that was asked for.
bool write_file(const std::vector<OutputPicture>& pictures, std::size_t picture, const std::string& filename,
                const Progress& progress, const OutputReport& report)
{
    const std::unique_ptr<ImageOutput> out = create_output(filename, pictures[picture].hierarchy);
    if (!out) {
        report.error = OIIO::geterror();
        return false;
    }
    const TemporaryName file(filename);
    Parts parts;
    for (const std::size_t i : choose_parts(pictures, picture, filename, report.warning)) {
        parts.push_back(std::make_unique<Part>());
        if (!make_part(pictures[i], filename, *out, file.name(), *parts.back(), report))
            return false;
    }
    for (std::size_t i = 1; i < parts.size(); ++i)
        share_attributes(parts[0]->spec, parts[i]->spec);
    if (!write_safely(*out, parts, filename, file.name(), progress, report.error))
        return false;
    const Part& first = *parts[0];
    report.summary = format("{} x {} {}{}", first.spec.width, first.spec.height, out->spec().format.c_str(),
                            first.is_encoded ? ", encoded sRGB" : "");
    if (parts.size() > 1)
        report.summary += format(", {} parts", parts.size());
    return true;
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
    const std::string directory = is_stream(filename) ? "" : Filesystem::parent_path(filename);
    if (extension.empty() || filename == "-")
        error = format("expected {} with the extension of an image format, such as .png or .exr",
                       filename == "-" ? "-" : "a name");
    else if (is_stream(filename) && !can_write_standard_output(error))
        ;
    else if (!directory.empty() && !Filesystem::is_directory(directory))
        error = format("no directory \"{}\"", directory);
    else if (!is_stream(filename) && access(directory.empty() ? "." : directory.c_str(), W_OK) != 0)
        error = format("no permission to write in directory \"{}\"", directory.empty() ? "." : directory);
    else if (Filesystem::is_directory(filename))
        error = "it is a directory";
    else if (!create_output(filename))
        error = format("no image format that OpenImageIO can write has the extension \".{}\"", extension);
    OIIO::geterror();  // replaced by the shorter message above
    return error.empty();
}

bool holds_parts(const std::string& filename)
{
    const std::unique_ptr<ImageOutput> out = create_output(filename);
    OIIO::geterror();
    return out && out->supports("multiimage");
}

bool write_parts(const std::vector<OutputPicture>& parts, std::size_t picture, const std::string& filename,
                 const std::function<void(float)>& progress, const OutputReport& report)
{
    const bool streams = is_stream(filename);
    const auto& finish = parts[picture].finish;
    if (!streams && !finish)
        return write_file(parts, picture, filename, progress, report);
    const TemporaryName scratch(streams ? scratch_name(filename) : filename);
    if (!write_file(parts, picture, scratch.name(), progress, report))
        return false;
    if (finish) {
        std::string bytes;
        if (!Filesystem::read_text_file(scratch.name(), bytes)) {
            report.error = "what was written cannot be read";
            return false;
        }
        if (!finish(bytes, report.error)
            || !pimg::write_whole_file(streams ? scratch.name() : filename, bytes, report.error))
            return false;
    }
    return !streams || send_to_standard_output(scratch.name(), report.error);
}

bool write_picture(const OutputPicture& picture, const std::string& filename,
                   const std::function<void(float)>& progress, const OutputReport& report)
{
    return write_parts({ picture }, 0, filename, progress, report);
}

}  // namespace pimgtool
