// SPDX-License-Identifier: BSD-3-Clause
// Opening, levels, and what OpenImageIO asks for; pimginput_read.cpp has what answers it.
#include "pimginput.h"

#include <algorithm>
#include <cstring>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/threads.h>

namespace pimg {
namespace io {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::ROI;
using OIIO::stride_t;
namespace Filesystem = OIIO::Filesystem;

constexpr int kMipTile = 64;         ///< as in most tiled files, and as maketx writes them
constexpr int kThumbnailSide = 256;  ///< a large thumbnail of the freedesktop.org specification

}  // namespace

bool PimgInput::fail(const std::string& message)
{
    errorfmt("{}", one_line(message));
    return false;
}

int PimgInput::supports(OIIO::string_view feature) const
{
    for (const char* name : { "arbitrary_metadata", "exif", "iptc", "ioproxy", "mipmap", "thumbnail" })
        if (feature == name)
            return true;
    return false;
}

// ---- opening ----------------------------------------------------------------------------------------------------

/// By plain input: OpenImageIO may hold the lock of its list of formats while it asks.
bool PimgInput::valid_file(const std::string& name) const
{
    char signature[8] = {};
    return Filesystem::read_bytes(file_of(name), signature, sizeof signature) == sizeof signature
        && is_pimg(signature, sizeof signature);
}

#if OIIO_VERSION >= OIIO_MAKE_VERSION(2, 5, 0)
bool PimgInput::valid_file(Filesystem::IOProxy* proxy) const
{
    char signature[8] = {};
    return proxy && proxy->mode() == Filesystem::IOProxy::Read
        && proxy->pread(signature, sizeof signature, 0) == sizeof signature && is_pimg(signature, sizeof signature);
}
#endif

bool PimgInput::open(const std::string& name, ImageSpec& spec, const ImageSpec& config)
{
    if (m_decoder.is_open())
        close();  // which forgets a proxy that was set for this file
    const bool opened = guarded([&] {
        m_name = name;
        ioproxy_retrieve_from_config(config);
        if (!ioproxy_use_or_open(file_of(name)))
            return false;
        // The file may not be one of ours: OpenImageIO tries every reader on files of unknown formats. So that is
        // checked first.
        const Status status = open_decoder(ioproxy(), m_decoder);
        if (!status)
            return fail(pimg::format("\"{}\": {}", name, status.error()));
        std::string error;
        if (!m_request.parse(name, config, error))
            refuse(error);
        announce_levels(config);
        m_spec = m_levels[0];
        spec = m_spec;
        return true;
    });
    if (!opened)
        close();
    return opened;
}

bool PimgInput::close()
{
    m_decoder = Decoder();  // must go before the proxy that it reads from
    ioproxy_clear();
    m_levels.clear();
    m_made.clear();
    m_tiles.clear();
    m_failure.clear();
    m_whole = Whole::unknown;
    m_request = ReadRequest();
    m_spec = ImageSpec();
    m_miplevel = 0;
    m_associates = false;
    return true;
}

/// Shape of MIP level `level` of the picture `top`: halved and rounded down, as the texture system wants it.
static ImageSpec mip_spec(const ImageSpec& top, int level)
{
    const auto halved = [level](int size) {
        return std::max(1, size >> level);
    };
    ImageSpec spec = top;
    spec.x = top.x >> level, spec.full_x = top.full_x >> level;
    spec.y = top.y >> level, spec.full_y = top.full_y >> level;
    spec.width = halved(top.width), spec.full_width = halved(top.full_width);
    spec.height = halved(top.height), spec.full_height = halved(top.full_height);
    return spec;
}

/// Handles a name whose query is wrong. If the file did not open, oiiotool would only say that there is no such file.
/// So it opens, with the picture in the file, and reading pixels fails with the reason.
void PimgInput::refuse(const std::string& error)
{
    m_failure = pimg::format("\"{}\": {}", m_name, one_line(error));
    m_request = ReadRequest();
}

/// As everywhere in OpenImageIO, colours are multiplied by alpha unless the configuration asks for them as stored.
void PimgInput::announce_levels(const ImageSpec& config)
{
    m_stored = to_spec(m_decoder.desc());
    ImageSpec top = m_stored;
    m_associates = m_stored.get_int_attribute(kUnassociatedAlpha) != 0 && m_stored.alpha_channel >= 0
        && config.get_int_attribute(kUnassociatedAlpha) == 0;
    if (m_associates)
        top.erase_attribute(kUnassociatedAlpha);
    top.attribute("compression", m_decoder.profile() == Profile::full ? "full" : "compact");
    std::string error;
    ImageSpec changed = top;
    if (m_request.change_spec(changed, error))
        top = changed;
    else
        refuse(error);
    if (!m_failure.empty())
        top.attribute("pimg:error", m_failure);
    if (!m_request.filtered()) {
        const int longer = std::max(top.width, top.height), side = std::min(longer, kThumbnailSide);
        top.attribute("thumbnail_width", std::max(1, int(std::int64_t(top.width) * side / longer)));
        top.attribute("thumbnail_height", std::max(1, int(std::int64_t(top.height) * side / longer)));
        top.attribute("thumbnail_nchannels", std::min(top.nchannels, 4));
    }
    if (m_request.mip) {
        top.tile_width = top.tile_height = kMipTile;
        top.tile_depth = 1;
        top.attribute("textureformat", "Plain Texture");
    }
    m_levels = { top };
    while (m_request.mip && (m_levels.back().width > 1 || m_levels.back().height > 1))
        m_levels.push_back(mip_spec(top, int(m_levels.size())));
    m_made.resize(m_levels.size());
}

// ---- levels -----------------------------------------------------------------------------------------------------

bool PimgInput::has_level(int subimage, int miplevel)
{
    return subimage == 0 && miplevel >= 0 && miplevel < int(m_levels.size());
}

int PimgInput::current_miplevel() const
{
    lock_guard lock(*this);
    return m_miplevel;
}

bool PimgInput::seek_subimage(int subimage, int miplevel)
{
    lock_guard lock(*this);
    if (!has_level(subimage, miplevel))
        return false;
    if (m_miplevel != miplevel) {
        m_miplevel = miplevel;
        m_spec = m_levels[std::size_t(miplevel)];
    }
    return true;
}

ImageSpec PimgInput::spec(int subimage, int miplevel)
{
    return has_level(subimage, miplevel) ? m_levels[std::size_t(miplevel)] : ImageSpec();
}

ImageSpec PimgInput::spec_dimensions(int subimage, int miplevel)
{
    ImageSpec dimensions;
    if (has_level(subimage, miplevel))
        dimensions.copy_dimensions(m_levels[std::size_t(miplevel)]);
    return dimensions;
}

// ---- reading ----------------------------------------------------------------------------------------------------

bool PimgInput::read_native_scanline(int subimage, int miplevel, int y, int z, void* data)
{
    return read_native_scanlines(subimage, miplevel, y, y + 1, z, data);
}

bool PimgInput::read_native_scanlines(int subimage, int miplevel, int ybegin, int yend, int z, void* data)
{
    const int channels = has_level(subimage, miplevel) ? m_levels[std::size_t(miplevel)].nchannels : 0;
    return read_native_scanlines(subimage, miplevel, ybegin, yend, z, 0, channels, data);
}

bool PimgInput::read_native_scanlines(int subimage, int miplevel, int ybegin, int yend, int, int chbegin, int chend,
                                      void* data)
{
    return guarded([&] {
        if (!has_level(subimage, miplevel))
            return fail("pimg: no such level");
        const ImageSpec& spec = m_levels[std::size_t(miplevel)];
        const int y0 = ybegin - spec.y, y1 = std::min(yend - spec.y, spec.height);
        if (y0 < 0 || y0 >= y1 || chbegin < 0 || chbegin >= chend || chend > spec.nchannels)
            return fail("pimg: no such scanlines");
        const auto pixel = stride_t(spec.pixel_bytes(chbegin, chend, true));
        return read(
            miplevel,
            { 0, spec.width, y0, y1, chbegin, chend, static_cast<std::uint8_t*>(data), pixel, pixel * spec.width });
    });
}

bool PimgInput::read_native_tile(int subimage, int miplevel, int x, int y, int, void* data)
{
    return guarded([&] {
        if (!has_level(subimage, miplevel) || m_levels[0].tile_width == 0)
            return fail("pimg: no such tile");
        const ImageSpec& spec = m_levels[std::size_t(miplevel)];
        const int x0 = x - spec.x, y0 = y - spec.y;
        if (x0 < 0 || y0 < 0 || x0 >= spec.width || y0 >= spec.height || x0 % kMipTile || y0 % kMipTile)
            return fail("pimg: no such tile");
        const auto pixel = stride_t(spec.pixel_bytes(true));
        std::memset(data, 0, spec.tile_bytes(true));
        return read(miplevel,
                    { x0, std::min(x0 + kMipTile, spec.width), y0, std::min(y0 + kMipTile, spec.height), 0,
                      spec.nchannels, static_cast<std::uint8_t*>(data), pixel, pixel * kMipTile });
    });
}

bool PimgInput::read(int miplevel, const Request& request)
{
    if (miplevel == 0 && !m_request.filtered() && !m_associates && m_failure.empty())
        return decode(request);
    const std::shared_ptr<const ImageBuf> level = made(miplevel);
    if (!level)
        return fail(m_failure);
    const ImageSpec& spec = m_levels[std::size_t(miplevel)];
    bool ok = true;
    run_without_foreign_tasks([&] {  // OpenImageIO's image cache may hold a lock of its own while it reads
        for (int c = request.c0; c < request.c1 && ok; ++c) {
            const ROI part(request.x0, request.x1, request.y0, request.y1, 0, 1, c, c + 1);
            ok = level->get_pixels(part, spec.channelformat(c), request.to + spec.pixel_bytes(request.c0, c, true),
                                   request.x_stride, request.y_stride);
        }
    });
    return ok || fail(level->geterror());
}

std::unique_ptr<OIIO::ImageInput> make_input()
{
    return std::make_unique<PimgInput>();
}

}  // namespace io
}  // namespace pimg
