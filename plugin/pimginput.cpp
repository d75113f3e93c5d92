// SPDX-License-Identifier: BSD-3-Clause
// Reads .pimg files. open() reads the header only; pixels are decoded tile by tile as they are asked for, straight into
// the caller's memory where the request covers a tile. Filters and MIP levels are made whole, at the first read.
// After open() nothing changes but caches behind a mutex: all reads may come from several threads.
#include <algorithm>
#include <cstring>
#include <exception>
#include <list>
#include <mutex>
#include <new>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <pimg/threads.h>

#include "pimg_pvt.h"
#include "read_request.h"

namespace pimg {
namespace io {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::ROI;
using OIIO::stride_t;
using OIIO::TypeDesc;
namespace Filesystem = OIIO::Filesystem;

constexpr int kMipTile = 64;
constexpr int kThumbnailSide = 256;

/// A part of a level: pixels [x0, x1) x [y0, y1) from its upper left corner, channels [c0, c1), and where they go, as
/// packed native samples.
struct Request {
    int x0, x1, y0, y1, c0, c1;
    std::uint8_t* to;
    stride_t x_stride, y_stride;
};

/// A decoded tile of the file, all channels, packed.
struct Tile {
    std::uint32_t column, row;
    std::vector<std::uint8_t> pixels;
};

class PimgInput final : public OIIO::ImageInput {
public:
    PimgInput() = default;
    ~PimgInput() override { close(); }

    const char* format_name() const override { return "pimg"; }
    int supports(OIIO::string_view feature) const override;
    bool valid_file(const std::string& name) const override;
#if OIIO_VERSION >= OIIO_MAKE_VERSION(2, 5, 0)
    bool valid_file(Filesystem::IOProxy* proxy) const override;
#endif
    bool open(const std::string& name, ImageSpec& spec) override { return open(name, spec, ImageSpec()); }
    bool open(const std::string& name, ImageSpec& spec, const ImageSpec& config) override;
    bool close() override;
    int current_miplevel() const override;
    bool seek_subimage(int subimage, int miplevel) override;
    ImageSpec spec(int subimage, int miplevel) override;
    ImageSpec spec_dimensions(int subimage, int miplevel) override;
    const ImageSpec& spec() const override { return m_spec; }
    bool get_thumbnail(ImageBuf& thumbnail, int subimage) override;

    bool read_native_scanline(int subimage, int miplevel, int y, int z, void* data) override;
    bool read_native_scanlines(int subimage, int miplevel, int ybegin, int yend, int z, void* data) override;
    bool read_native_scanlines(int subimage, int miplevel, int ybegin, int yend, int z, int chbegin, int chend,
                               void* data) override;
    bool read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) override;

private:
    template<class Body> bool guarded(Body&& body);
    bool fail(const std::string& message);
    bool has_level(int subimage, int miplevel);
    bool announce_levels(std::string& error);

    bool read(int miplevel, const Request& request);
    bool is_whole();
    bool decode(const Request& request);
    Status decode_tile(const Request& request, std::uint32_t column, std::uint32_t row);
    std::vector<Plane> planes(const ImageSpec& spec, const Request& request) const;
    std::shared_ptr<const Tile> tile(std::uint32_t column, std::uint32_t row, Status& status);

    std::shared_ptr<const ImageBuf> picture();
    std::shared_ptr<const ImageBuf> made(int miplevel);
    std::shared_ptr<const ImageBuf> make(int miplevel);

    std::string m_name;
    ReadRequest m_request;
    Decoder m_decoder;
    std::vector<ImageSpec> m_levels;  ///< level 0 and, if asked for, its MIP levels
    ImageSpec m_stored;               ///< the picture in the file
    int m_miplevel = 0;

    std::mutex m_tiles_mutex, m_made_mutex, m_whole_mutex;
    std::list<std::shared_ptr<const Tile>> m_tiles;             ///< the last ones that were not read whole
    std::vector<std::shared_ptr<const ImageBuf>> m_made;        ///< levels that are not in the file
    enum class Whole { unknown, yes, no } m_whole = Whole::unknown;
    std::string m_failure;                                      ///< of making a level; it would fail again
};

bool PimgInput::fail(const std::string& message)
{
    errorfmt("{}", message);
    return false;
}

/// No exception passes OpenImageIO's virtual functions.
template<class Body>
bool PimgInput::guarded(Body&& body)
{
    try {
        return body();
    } catch (const std::bad_alloc&) {
        errorfmt("pimg: not enough memory for {}", m_name);
    } catch (const std::exception& exception) {
        errorfmt("pimg: {}", exception.what());
    }
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
        // First whether the file is one of ours: OpenImageIO shows every reader files of unknown formats.
        const Status status = open_decoder(ioproxy(), m_decoder);
        if (!status)
            return fail(OIIO::Strutil::fmt::format("\"{}\": {}", name, status.error()));
        std::string error;
        if (!m_request.parse(name, config, error))
            return fail(OIIO::Strutil::fmt::format("\"{}\": {}", name, error));
        if (!announce_levels(error))
            return fail(OIIO::Strutil::fmt::format("\"{}\": {}", name, error));
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
    m_decoder = Decoder();  // before what it reads from
    ioproxy_clear();
    m_levels.clear();
    m_made.clear();
    m_tiles.clear();
    m_failure.clear();
    m_whole = Whole::unknown;
    m_request = ReadRequest();
    m_spec = ImageSpec();
    m_miplevel = 0;
    return true;
}

/// Shape of MIP level `level` of the picture `top`: halved and rounded down, as the texture system wants it.
ImageSpec mip_spec(const ImageSpec& top, int level)
{
    const auto halved = [level](int size) { return std::max(1, size >> level); };
    ImageSpec spec = top;
    spec.x = top.x >> level, spec.full_x = top.full_x >> level;
    spec.y = top.y >> level, spec.full_y = top.full_y >> level;
    spec.width = halved(top.width), spec.full_width = halved(top.full_width);
    spec.height = halved(top.height), spec.full_height = halved(top.full_height);
    return spec;
}

bool PimgInput::announce_levels(std::string& error)
{
    m_stored = to_spec(m_decoder.desc());
    ImageSpec top = m_stored;
    top.attribute("compression", m_decoder.profile() == Profile::full ? "full" : "compact");
    if (!m_request.change_spec(top, error))
        return false;
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
    return true;
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
        return read(miplevel, { 0, spec.width, y0, y1, chbegin, chend, static_cast<std::uint8_t*>(data), pixel,
                                pixel * spec.width });
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
    if (miplevel == 0 && !m_request.filtered())
        return decode(request);
    const std::shared_ptr<const ImageBuf> level = made(miplevel);
    if (!level)
        return fail(m_failure);
    const ImageSpec& spec = m_levels[std::size_t(miplevel)];
    for (int c = request.c0; c < request.c1; ++c) {
        const ROI part(request.x0, request.x1, request.y0, request.y1, 0, 1, c, c + 1);
        if (!level->get_pixels(part, spec.channelformat(c), request.to + spec.pixel_bytes(request.c0, c, true),
                               request.x_stride, request.y_stride))
            return fail(level->geterror());
    }
    return true;
}

/// Whether the file has its end. A file that was cut is a coarser picture, which only those get who ask for it.
bool PimgInput::is_whole()
{
    if (m_request.partial)
        return true;
    std::lock_guard<std::mutex> lock(m_whole_mutex);
    if (m_whole == Whole::unknown) {
        std::vector<ChunkInfo> chunks;
        const Status status = m_decoder.chunks(chunks);
        if (!status)
            return fail(OIIO::Strutil::fmt::format("\"{}\": {}", m_name, status.error()));
        m_whole = !chunks.empty() && !std::strcmp(chunks.back().type, "DONE") ? Whole::yes : Whole::no;
    }
    if (m_whole == Whole::no)
        return fail(OIIO::Strutil::fmt::format(
            "\"{}\": the file ends early; its beginning can be read as a coarser picture with partial=1", m_name));
    return true;
}

bool PimgInput::decode(const Request& request)
{
    if (!is_whole())
        return false;
    const auto side = int(m_decoder.tile());
    const int column0 = request.x0 / side, columns = (request.x1 - 1) / side + 1 - column0;
    const int row0 = request.y0 / side, rows = (request.y1 - 1) / side + 1 - row0;
    std::mutex mutex;
    Status failure;
    run(pool_loop(threads()), std::size_t(columns) * std::size_t(rows), [&](std::size_t i) {
        const Status status
            = decode_tile(request, std::uint32_t(column0 + int(i) % columns), std::uint32_t(row0 + int(i) / columns));
        if (!status) {
            std::lock_guard<std::mutex> lock(mutex);
            failure = status;
        }
    });
    return failure.ok() || fail(OIIO::Strutil::fmt::format("\"{}\": {}", m_name, failure.error()));
}

/// One plane per channel over the request's memory; those outside its range are not wanted.
std::vector<Plane> PimgInput::planes(const ImageSpec& spec, const Request& request) const
{
    std::vector<Plane> planes(std::size_t(spec.nchannels));
    for (int c = request.c0; c < request.c1; ++c)
        planes[std::size_t(c)]
            = { request.to + spec.pixel_bytes(request.c0, c, true), request.x_stride, request.y_stride };
    return planes;
}

/// The part of a request that lies in one tile of the file.
Status PimgInput::decode_tile(const Request& request, std::uint32_t column, std::uint32_t row)
{
    const auto side = int(m_decoder.tile());
    const int left = int(column) * side, right = std::min(left + side, m_stored.width);
    const int top = int(row) * side, bottom = std::min(top + side, m_stored.height);
    Request part = request;
    part.x0 = std::max(request.x0, left), part.x1 = std::min(request.x1, right);
    part.y0 = std::max(request.y0, top), part.y1 = std::min(request.y1, bottom);
    part.to += (part.y0 - request.y0) * request.y_stride + (part.x0 - request.x0) * request.x_stride;
    if (part.x0 == left && part.x1 == right && part.y0 == top && part.y1 == bottom)
        return m_decoder.read_tile(column, row, planes(m_stored, part));

    Status status;
    const std::shared_ptr<const Tile> whole = tile(column, row, status);
    if (!status)
        return status;
    const std::size_t pixel = m_stored.pixel_bytes(true), wanted = m_stored.pixel_bytes(part.c0, part.c1, true);
    const std::size_t skipped = m_stored.pixel_bytes(0, part.c0, true);
    for (int y = part.y0; y < part.y1; ++y) {
        const std::uint8_t* from
            = whole->pixels.data() + (std::size_t(y - top) * std::size_t(right - left) + std::size_t(part.x0 - left)) * pixel;
        std::uint8_t* to = part.to + (y - part.y0) * part.y_stride;
        if (wanted == pixel && part.x_stride == stride_t(pixel))
            std::memcpy(to, from, std::size_t(part.x1 - part.x0) * pixel);
        else
            for (int x = part.x0; x < part.x1; ++x, from += pixel, to += part.x_stride)
                std::memcpy(to, from + skipped, wanted);
    }
    return {};
}

/// Tiles that are read piecemeal are kept: as many as lie beside each other, so that scanlines decode each once.
std::shared_ptr<const Tile> PimgInput::tile(std::uint32_t column, std::uint32_t row, Status& status)
{
    const auto side = int(m_decoder.tile());
    const auto is_it = [&](const auto& t) { return t->column == column && t->row == row; };
    {
        std::lock_guard<std::mutex> lock(m_tiles_mutex);
        const auto found = std::find_if(m_tiles.begin(), m_tiles.end(), is_it);
        if (found != m_tiles.end()) {
            m_tiles.splice(m_tiles.begin(), m_tiles, found);
            return m_tiles.front();
        }
    }
    auto tile = std::make_shared<Tile>();
    tile->column = column, tile->row = row;
    const int width = std::min(side, m_stored.width - int(column) * side);
    const int height = std::min(side, m_stored.height - int(row) * side);
    const auto pixel = stride_t(m_stored.pixel_bytes(true));
    tile->pixels.resize(std::size_t(pixel) * std::size_t(width) * std::size_t(height));
    const Request all { 0, width, 0, height, 0, m_stored.nchannels, tile->pixels.data(), pixel, pixel * width };
    status = m_decoder.read_tile(column, row, planes(m_stored, all));
    if (!status)
        return nullptr;
    std::lock_guard<std::mutex> lock(m_tiles_mutex);
    m_tiles.push_front(tile);
    if (m_tiles.size() > std::size_t(m_stored.width / side + 2))
        m_tiles.pop_back();
    return tile;
}

// ---- what is not in the file ------------------------------------------------------------------------------------

/// The picture in the file, moved to the origin and without a display window: levels are halved pixel by pixel.
std::shared_ptr<const ImageBuf> PimgInput::picture()
{
    ImageSpec spec = m_stored;
    spec.channelformats.clear();
    spec.x = spec.y = spec.full_x = spec.full_y = 0;
    spec.full_width = spec.width;
    spec.full_height = spec.height;
    auto picture = std::make_shared<ImageBuf>(spec);
    if (m_stored.channelformats.empty()) {
        const auto pixel = stride_t(spec.pixel_bytes());
        const Request all { 0, spec.width, 0, spec.height, 0, spec.nchannels,
                            static_cast<std::uint8_t*>(picture->localpixels()), pixel, pixel * spec.width };
        return decode(all) ? picture : nullptr;
    }
    std::vector<std::uint8_t> packed(m_stored.image_bytes(true));
    const auto pixel = stride_t(m_stored.pixel_bytes(true));
    if (!decode({ 0, spec.width, 0, spec.height, 0, spec.nchannels, packed.data(), pixel, pixel * spec.width }))
        return nullptr;
    for (int c = 0; c < spec.nchannels; ++c) {
        ROI channel = picture->roi();
        channel.chbegin = c, channel.chend = c + 1;
        picture->set_pixels(channel, m_stored.channelformat(c), packed.data() + m_stored.pixel_bytes(0, c, true), pixel,
                            pixel * spec.width);
    }
    return picture;
}

/// A level that must be made, from the one above it. All threads but the first wait for it.
std::shared_ptr<const ImageBuf> PimgInput::made(int miplevel)
{
    if (!is_whole())
        return nullptr;
    std::lock_guard<std::mutex> lock(m_made_mutex);
    for (int level = 0; level <= miplevel; ++level)
        if (!m_made[std::size_t(level)] && m_failure.empty())
            m_made[std::size_t(level)] = make(level);
    return m_made[std::size_t(miplevel)];
}

/// The filtered picture, or half of the level above.
std::shared_ptr<const ImageBuf> PimgInput::make(int miplevel)
{
    auto level = std::make_shared<ImageBuf>();
    if (miplevel > 0) {
        const ImageSpec& spec = m_levels[std::size_t(miplevel)];
        const ImageBuf& above = *m_made[std::size_t(miplevel - 1)];
        const ROI size(0, spec.width, 0, spec.height, 0, 1, 0, spec.nchannels);
        if (OIIO::ImageBufAlgo::resize(*level, above, "box", 0.0f, size, threads()))
            return level;
        m_failure = level->geterror();
        return nullptr;
    }
    const std::shared_ptr<const ImageBuf> source = picture();
    if (!source) {
        m_failure = geterror();
        return nullptr;
    }
    if (!m_request.filtered())
        return source;
    ProgressiveImage progressive;
    const bool stored = m_decoder.has_hierarchy() && !m_request.rebuild;
    if (stored ? !progressive.adopt(*source, stored_hierarchy(m_decoder, *source), m_request.build, threads())
               : !progressive.build(*source, m_request.build, threads()))
        m_failure = progressive.error();
    else if (!m_request.run(*level, progressive, threads()))
        m_failure = level->geterror();
    m_failure = m_failure.empty() ? "" : OIIO::Strutil::fmt::format("\"{}\": {}", m_name, m_failure);
    return m_failure.empty() ? level : nullptr;
}

/// A small picture from the mesh layer alone: of as many of its vertices as make a difference at that size.
bool PimgInput::get_thumbnail(ImageBuf& thumbnail, int subimage)
{
    return guarded([&] {
        if (subimage != 0 || m_levels.empty() || m_request.filtered())
            return false;
        const ImageSpec& top = m_levels[0];
        ImageSpec spec(top.get_int_attribute("thumbnail_width"), top.get_int_attribute("thumbnail_height"),
                       top.get_int_attribute("thumbnail_nchannels"), m_stored.format);
        spec.channelnames.assign(top.channelnames.begin(), top.channelnames.begin() + spec.nchannels);
        if (m_stored.alpha_channel < spec.nchannels)
            spec.alpha_channel = m_stored.alpha_channel;
        const std::string space = top.get_string_attribute("oiio:ColorSpace");
        if (!space.empty())
            spec.attribute("oiio:ColorSpace", space);

        const auto pixel = stride_t(m_stored.pixel_bytes(0, spec.nchannels, true));
        std::vector<std::uint8_t> packed(spec.image_pixels() * std::size_t(pixel));
        const Request all { 0, spec.width, 0, spec.height, 0, spec.nchannels, packed.data(), pixel, pixel * spec.width };
        const double vertices = 0.015 * double(m_stored.image_pixels()), enough = double(spec.image_pixels());
        const Status status = m_decoder.read_preview(std::uint32_t(spec.width), std::uint32_t(spec.height),
                                                     planes(m_stored, all), std::min(1.0, enough / vertices));
        if (!status)
            return fail(OIIO::Strutil::fmt::format("\"{}\": {}", m_name, status.error()));
        thumbnail.reset(spec);
        for (int c = 0; c < spec.nchannels; ++c)
            thumbnail.set_pixels(ROI(0, spec.width, 0, spec.height, 0, 1, c, c + 1), m_stored.channelformat(c),
                                 packed.data() + m_stored.pixel_bytes(0, c, true), pixel, pixel * spec.width);
        return true;
    });
}

}  // namespace

std::unique_ptr<OIIO::ImageInput> make_input() { return std::make_unique<PimgInput>(); }

}  // namespace io
}  // namespace pimg
