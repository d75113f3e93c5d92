// SPDX-License-Identifier: BSD-3-Clause
// Writes .pimg files. The picture is collected as it comes, encoded with its last scanline or tile, so that the call
// that completes it reports whatever goes wrong, and appears under its name whole or not at all.
#include <algorithm>
#include <cstring>
#include <exception>
#include <new>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/safe_file.h>
#include <pimg/progressive_image.h>
#include <pimg/threads.h>

#include "pimg_pvt.h"

namespace pimg {
namespace io {

namespace {

using OIIO::ImageSpec;
using OIIO::stride_t;
using OIIO::TypeDesc;
namespace Filesystem = OIIO::Filesystem;

class PimgOutput final : public OIIO::ImageOutput {
public:
    explicit PimgOutput(const Hierarchy* hierarchy) : m_given(hierarchy) { }
    ~PimgOutput() override { close(); }

    const char* format_name() const override { return "pimg"; }
    int supports(OIIO::string_view feature) const override;
    using ImageOutput::open;
    bool open(const std::string& name, const ImageSpec& spec, OpenMode mode) override;
    bool close() override;
    using ImageOutput::write_scanline;
    bool write_scanline(int y, int z, TypeDesc format, const void* data, stride_t xstride) override;
    using ImageOutput::write_tile;
    bool write_tile(int x, int y, int z, TypeDesc format, const void* data, stride_t xstride, stride_t ystride,
                    stride_t zstride) override;

private:
    bool check(const ImageSpec& spec);
    bool read_hints();
    bool accept(std::size_t part);
    bool finish();
    bool build_hierarchy(ProgressiveImage& progressive);
    bool store(const std::vector<std::uint8_t>& bytes);
    template<class Body>
    bool guarded(Body&& body)
    {
        return io::guarded(*this, m_name, body);
    }

    const Hierarchy* m_given;
    std::string m_name;
    WriteOptions m_options;
    BuildOptions m_build;  ///< of the hierarchy
    bool m_build_given = false;
    std::vector<std::uint8_t> m_pixels;  ///< packed native samples, row by row
    std::vector<bool> m_here;            ///< which scanlines or tiles have come
    std::size_t m_missing = 0;           ///< how many have not
    unsigned int m_dither = 0;
    bool m_open = false;
    std::vector<unsigned char> m_scratch;
};

int PimgOutput::supports(OIIO::string_view feature) const
{
    for (const char* name : { "alpha", "nchannels", "channelformats", "tiles", "ioproxy", "arbitrary_metadata", "exif",
                              "iptc", "displaywindow", "origin", "negativeorigin", "random_access" })
        if (feature == name)
            return true;
    return false;
}

bool PimgOutput::check(const ImageSpec& spec)
{
    constexpr int kSide = 1 << 20, kFar = 1 << 30;  // docs/format.md, section 2
    const auto far_away = [](int v) {
        return v < -kFar || v > kFar;
    };
    if (spec.deep)
        errorfmt("pimg: deep images are not supported");
    else if (spec.depth > 1)
        errorfmt("pimg: volumes are not supported");
    else if (spec.width < 1 || spec.height < 1 || spec.width > kSide || spec.height > kSide)
        errorfmt("pimg: a picture of {} x {} pixels: sides must be 1 to {}", spec.width, spec.height, kSide);
    else if (spec.full_width > kSide || spec.full_height > kSide)
        errorfmt("pimg: a display window of {} x {} pixels: sides must be 1 to {}", spec.full_width, spec.full_height,
                 kSide);
    else if (spec.nchannels < 1 || spec.nchannels > 1024)
        errorfmt("pimg: {} channels: expected 1 to 1024", spec.nchannels);
    else if (far_away(spec.x) || far_away(spec.y) || far_away(spec.full_x) || far_away(spec.full_y))
        errorfmt("pimg: the picture is more than {} pixels from the origin", kFar);
    else
        return true;
    return false;
}

/// Reads the options from `pimg:key` attributes, and from OpenImageIO's `compression`: "compact" or "full", perhaps
/// followed by ":effort". Other values of `compression` are meant for other formats, and ignored.
bool PimgOutput::read_hints()
{
    m_options = {};
    m_build = {};
    m_build_given = false;
    std::string error;
    const auto words = OIIO::Strutil::splits(m_spec.get_string_attribute("compression"), ":");
    if (!words.empty() && (words[0] == "compact" || words[0] == "full")) {
        m_options.profile = words[0];
        if (words.size() > 1 && !set_option(m_options, "effort", words[1], error)) {
            errorfmt("pimg: compression {}", one_line(error));
            return false;
        }
    }
    for (const OIIO::ParamValue& hint : m_spec.extra_attribs) {
        const std::string name = hint.name().string();
        if (!OIIO::Strutil::istarts_with(name, "pimg:"))
            continue;
        const std::string key = OIIO::Strutil::lower(name.substr(5));
        const auto is_one_of = [&](const auto& table) {
            return std::any_of(table.begin(), table.end(), [&](const auto& option) { return key == option.rule.key; });
        };
        bool fine = true;
        if (is_one_of(option_table<WriteOptions>()))
            fine = set_option(m_options, key, hint_text(hint), error);
        else if (is_one_of(option_table<BuildOptions>()))
            fine = m_build_given = set_option(m_build, key, hint_text(hint), error);
        if (!fine) {
            errorfmt("pimg: {}", one_line(error));
            return false;
        }
    }
    if (m_options.quality >= 0)
        m_options.effort = (m_options.quality + 25) / 50;
    return true;
}

bool PimgOutput::open(const std::string& name, const ImageSpec& spec, OpenMode mode)
{
    if (mode != Create) {
        errorfmt("pimg: files hold one image: no {} can be added", mode == AppendMIPLevel ? "MIP level" : "subimage");
        return false;
    }
    if (m_open)
        close();  // which forgets a proxy that was set for this file
    return guarded([&] {
        m_name = name;
        m_spec = spec;
        if (!check(spec) || !read_hints())
            return false;
        m_spec.set_format(stored_type(spec.format));
        m_spec.channelformats.clear();
        if (int(spec.channelformats.size()) == spec.nchannels)
            for (const TypeDesc& format : spec.channelformats)
                m_spec.channelformats.push_back(stored_type(format));
        m_spec.depth = 1;
        if (m_spec.full_width < 1 || m_spec.full_height < 1) {
            m_spec.full_x = m_spec.x, m_spec.full_y = m_spec.y;
            m_spec.full_width = m_spec.width, m_spec.full_height = m_spec.height;
        }
        if (m_spec.get_int_attribute("oiio:BitsPerSample") >= int(m_spec.format.size()) * 8)
            m_spec.erase_attribute("oiio:BitsPerSample");
        m_dither = m_spec.format == TypeDesc::UINT8 ? unsigned(m_spec.get_int_attribute("oiio:dither")) : 0;

        ioproxy_retrieve_from_config(m_spec);
        SafeFile probe;  // finds out before the work whether the file can be written, and leaves nothing behind
        if (!ioproxy() && !probe.open(name)) {
            errorfmt("Could not open \"{}\": {}", name, probe.error());
            return false;
        }
        m_pixels.resize(m_spec.image_bytes(true));
        const bool tiled = m_spec.tile_width > 0 && m_spec.tile_height > 0;
        const auto parts = [](int size, int part) {
            return std::size_t(size + part - 1) / std::size_t(part);
        };
        m_missing = tiled ? parts(m_spec.width, m_spec.tile_width) * parts(m_spec.height, m_spec.tile_height)
                          : std::size_t(m_spec.height);
        m_here.assign(m_missing, false);
        return m_open = true;
    });
}

bool PimgOutput::close()
{
    const bool complete = !m_open || m_missing == 0;
    if (!complete)
        errorfmt("pimg: {} of {} {} were never written: no file was made", m_missing, m_here.size(),
                 m_spec.tile_width > 0 ? "tiles" : "scanlines");
    m_open = false;
    std::vector<std::uint8_t>().swap(m_pixels);
    m_here.clear();
    ioproxy_clear();
    return complete;
}

bool PimgOutput::write_scanline(int y, int z, TypeDesc format, const void* data, stride_t xstride)
{
    return guarded([&] {
        if (!m_open || m_pixels.empty() || m_spec.tile_width > 0 || y < m_spec.y || y >= m_spec.y + m_spec.height) {
            errorfmt("pimg: scanline {} cannot be written now", y);
            return false;
        }
        const void* native = to_native_scanline(format, data, xstride, m_scratch, m_dither, y, z);
        const std::size_t row = std::size_t(y - m_spec.y), bytes = m_spec.scanline_bytes(true);
        std::memcpy(m_pixels.data() + row * bytes, native, bytes);
        return accept(row);
    });
}

bool PimgOutput::write_tile(int x, int y, int z, TypeDesc format, const void* data, stride_t xstride, stride_t ystride,
                            stride_t zstride)
{
    return guarded([&] {
        const int across = m_spec.tile_width, down = m_spec.tile_height;
        const int left = x - m_spec.x, top = y - m_spec.y;
        if (!m_open || m_pixels.empty() || across < 1 || left < 0 || top < 0 || left >= m_spec.width
            || top >= m_spec.height || left % across != 0 || top % down != 0) {
            errorfmt("pimg: tile ({}, {}) cannot be written now", x, y);
            return false;
        }
        const void* native = to_native_tile(format, data, xstride, ystride, zstride, m_scratch, m_dither, x, y, z);
        const std::size_t pixel = m_spec.pixel_bytes(true), row = m_spec.scanline_bytes(true);
        const int width = std::min(across, m_spec.width - left), height = std::min(down, m_spec.height - top);
        for (int i = 0; i < height; ++i)
            std::memcpy(m_pixels.data() + std::size_t(top + i) * row + std::size_t(left) * pixel,
                        static_cast<const char*>(native) + std::size_t(i) * std::size_t(across) * pixel,
                        std::size_t(width) * pixel);
        const int columns = (m_spec.width + across - 1) / across;
        return accept(std::size_t(top / down) * std::size_t(columns) + std::size_t(left / across));
    });
}

bool PimgOutput::accept(std::size_t part)
{
    m_missing -= m_here[part] ? 0 : 1;
    m_here[part] = true;
    if (m_missing > 0)
        return true;
    const bool stored = finish();
    std::vector<std::uint8_t>().swap(m_pixels);
    return stored;
}

/// Builds the hierarchy by the options of the filters, instead of the codec's simpler guide.
bool PimgOutput::build_hierarchy(ProgressiveImage& progressive)
{
    ImageSpec spec = m_spec;
    spec.tile_width = spec.tile_height = 0;
    spec.channelformats.clear();
    OIIO::ImageBuf picture(spec);
    const std::size_t pixel = m_spec.pixel_bytes(true);
    for (int c = 0; c < m_spec.nchannels; ++c) {
        OIIO::ROI channel = picture.roi();
        channel.chbegin = c, channel.chend = c + 1;
        picture.set_pixels(channel, m_spec.channelformat(c), m_pixels.data() + m_spec.pixel_bytes(0, c, true),
                           stride_t(pixel), stride_t(m_spec.scanline_bytes(true)));
    }
    BuildOptions build = m_build;
    build.wrap = "none";  // a stored mesh has no margins; readers build that of a panorama anew
    build.preview = false;
    if (progressive.build(picture, build, threads()))
        return true;
    errorfmt("pimg: {}", progressive.error());
    return false;
}

bool PimgOutput::finish()
{
    EncodeOptions options;
    options.profile = m_options.profile == "full" ? Profile::full : Profile::compact;
    options.vertices = m_options.vertices;
    options.effort = m_options.effort;
    options.tile = std::uint32_t(m_options.tile);
    options.parallel = pool_loop(threads());
    options.hierarchy = m_given;
    ProgressiveImage progressive;
    if ((options.profile == Profile::full || m_build_given) && !m_given) {
        if (!build_hierarchy(progressive))
            return false;
        options.hierarchy = &progressive.hierarchy();
    }
    const PictureDesc desc = to_desc(m_spec);
    std::vector<std::uint8_t> bytes;
    const Status status = encode(desc, interleaved(desc, static_cast<const void*>(m_pixels.data())), options, bytes);
    if (!status) {
        errorfmt("{}", status.error());
        return false;
    }
    return store(bytes);
}

bool PimgOutput::store(const std::vector<std::uint8_t>& bytes)
{
    if (Filesystem::IOProxy* proxy = ioproxy()) {
        if (proxy->write(bytes.data(), bytes.size()) == bytes.size())
            return true;
        errorfmt("pimg: could not write \"{}\": {}", m_name, proxy->error());
        return false;
    }
    SafeFile file;
    if (file.open(m_name) && file.write(bytes.data(), bytes.size()) && file.keep())
        return true;
    errorfmt("pimg: could not write \"{}\": {}", m_name, file.error());
    return false;
}

}  // namespace

std::unique_ptr<OIIO::ImageOutput> make_output(const Hierarchy* hierarchy)
{
    return std::make_unique<PimgOutput>(hierarchy);
}

}  // namespace io
}  // namespace pimg
