// SPDX-License-Identifier: BSD-3-Clause
// Where the pixels come from: tiles of the file, a filter, the level above, or, for a thumbnail, the mesh layer.
#include "pimginput.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/oiio_compat.h>
#include <pimg/detail/parallel.h>
#include <pimg/threads.h>

namespace pimg {
namespace io {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::ROI;
using OIIO::stride_t;

/// Whether the file is complete. One that was cut short shows a coarser picture, but only if that is asked for.
bool PimgInput::is_whole()
{
    if (m_request.partial)
        return true;
    std::lock_guard<std::mutex> lock(m_whole_mutex);
    if (m_whole == Whole::unknown) {
        std::vector<ChunkInfo> chunks;
        const Status status = m_decoder.chunks(chunks);
        if (!status)
            return fail(pimg::format("\"{}\": {}", m_name, status.error()));
        m_whole = !chunks.empty() && !std::strcmp(chunks.back().type, "DONE") ? Whole::yes : Whole::no;
    }
    if (m_whole == Whole::no)
        return fail(pimg::format(
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
        const Status status =
            decode_tile(request, std::uint32_t(column0 + int(i) % columns), std::uint32_t(row0 + int(i) / columns));
        if (!status) {
            std::lock_guard<std::mutex> lock(mutex);
            failure = status;
        }
    });
    return failure.ok() || fail(pimg::format("\"{}\": {}", m_name, failure.error()));
}

/// The channels of the picture, as places in the memory of the request; those outside its range are left out.
std::vector<StridedChannel> PimgInput::channels_of(const ImageSpec& spec, const Request& request) const
{
    std::vector<StridedChannel> channels(std::size_t(spec.nchannels));
    for (int c = request.c0; c < request.c1; ++c)
        channels[std::size_t(c)] = { request.to + spec.pixel_bytes(request.c0, c, true), request.x_stride,
                                     request.y_stride };
    return channels;
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
        return m_decoder.read_tile(column, row, channels_of(m_stored, part));

    Status status;
    const std::shared_ptr<const Tile> whole = tile(column, row, status);
    if (!status)
        return status;
    const std::size_t pixel = m_stored.pixel_bytes(true), wanted = m_stored.pixel_bytes(part.c0, part.c1, true);
    const std::size_t skipped = m_stored.pixel_bytes(0, part.c0, true);
    for (int y = part.y0; y < part.y1; ++y) {
        const std::uint8_t* from = whole->pixels.data()
            + (std::size_t(y - top) * std::size_t(right - left) + std::size_t(part.x0 - left)) * pixel;
        std::uint8_t* to = part.to + (y - part.y0) * part.y_stride;
        if (wanted == pixel && part.x_stride == stride_t(pixel))
            std::memcpy(to, from, std::size_t(part.x1 - part.x0) * pixel);
        else
            for (int x = part.x0; x < part.x1; ++x, from += pixel, to += part.x_stride)
                std::memcpy(to, from + skipped, wanted);
    }
    return {};
}

/// A decoded tile. As many are kept as lie side by side, so that reading scanline by scanline decodes each tile once.
std::shared_ptr<const Tile> PimgInput::tile(std::uint32_t column, std::uint32_t row, Status& status)
{
    const auto side = int(m_decoder.tile());
    const auto is_it = [&](const auto& t) {
        return t->column == column && t->row == row;
    };
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
    status = m_decoder.read_tile(column, row, channels_of(m_stored, all));
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
    std::shared_ptr<ImageBuf> picture = stored_picture();
    if (picture && m_associates) {
        OIIO::ImageBufAlgo::premult(*picture, *picture, {}, threads());
        picture->specmod().erase_attribute(kUnassociatedAlpha);
    }
    return picture;
}

std::shared_ptr<ImageBuf> PimgInput::stored_picture()
{
    ImageSpec spec = m_stored;
    spec.channelformats.clear();
    spec.x = spec.y = spec.full_x = spec.full_y = 0;
    spec.full_width = spec.width;
    spec.full_height = spec.height;
    auto picture = std::make_shared<ImageBuf>(spec);
    if (m_stored.channelformats.empty()) {
        const auto pixel = stride_t(spec.pixel_bytes());
        const Request all { 0,
                            spec.width,
                            0,
                            spec.height,
                            0,
                            spec.nchannels,
                            static_cast<std::uint8_t*>(picture->localpixels()),
                            pixel,
                            pixel * spec.width };
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

/// A level that is not in the file, made when it is first asked for. Meanwhile other threads that ask for it wait. The
/// thread that makes it must not take up other tasks of OpenImageIO's pool: such a task may read this file, and would
/// wait for a lock that its own thread holds.
std::shared_ptr<const ImageBuf> PimgInput::made(int miplevel)
{
    if (!is_whole())
        return nullptr;
    std::lock_guard<std::mutex> lock(m_made_mutex);
    run_without_foreign_tasks([&] {
        for (int level = 0; level <= miplevel; ++level)
            if (!m_made[std::size_t(level)] && m_failure.empty())
                m_made[std::size_t(level)] = make(level);
    });
    return m_made[std::size_t(miplevel)];
}

/// `above` at half its size, in strips so that several threads can work at it. False with an error in `level`.
static bool halve(const ImageBuf& above, const ImageSpec& size, int nthreads, ImageBuf& level)
{
    constexpr int kRows = 64;
    ImageSpec spec(size.width, size.height, size.nchannels, above.spec().format);
    spec.channelnames = above.spec().channelnames;
    level.reset(spec);
    std::atomic<bool> failed { false };
    run(pool_loop(nthreads), std::size_t((size.height + kRows - 1) / kRows), [&](std::size_t strip) {
        const int y0 = int(strip) * kRows, y1 = std::min(size.height, y0 + kRows);
        const ROI rows(0, size.width, y0, y1, 0, 1, 0, size.nchannels);
        if (!resize_picture(level, above, "box", rows, 1))
            failed = true;
    });
    return !failed;
}

/// The filtered picture, or half of the level above.
std::shared_ptr<const ImageBuf> PimgInput::make(int miplevel)
{
    auto level = std::make_shared<ImageBuf>();
    if (miplevel > 0) {
        if (halve(*m_made[std::size_t(miplevel - 1)], m_levels[std::size_t(miplevel)], threads(), *level))
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
    const bool stored = m_decoder.has_hierarchy() && !m_request.rebuild && !m_associates;
    if (stored ? !progressive.adopt(*source, stored_hierarchy(m_decoder, *source), m_request.build, threads())
               : !progressive.build(*source, m_request.build, threads()))
        m_failure = progressive.error();
    else if (!m_request.run(*level, progressive, threads()))
        m_failure = level->geterror();
    m_failure = m_failure.empty() ? "" : pimg::format("\"{}\": {}", m_name, m_failure);
    return m_failure.empty() ? level : nullptr;
}

/// A small picture made from the mesh layer alone, with as many vertices as make a difference at that size.
bool PimgInput::get_thumbnail(ImageBuf& thumbnail, int subimage)
{
    return guarded([&] {
        if (subimage != 0 || m_levels.empty() || m_request.filtered())
            return false;
        if (!m_failure.empty())
            return fail(m_failure);
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
        const Request all {
            0, spec.width, 0, spec.height, 0, spec.nchannels, packed.data(), pixel, pixel * spec.width
        };
        const double vertices = std::max(1.0, double(m_decoder.vertices())), enough = double(spec.image_pixels());
        const Status status = m_decoder.read_preview(std::uint32_t(spec.width), std::uint32_t(spec.height),
                                                     channels_of(m_stored, all), std::min(1.0, enough / vertices));
        if (!status)
            return fail(pimg::format("\"{}\": {}", m_name, status.error()));
        thumbnail.reset(spec);
        for (int c = 0; c < spec.nchannels; ++c)
            thumbnail.set_pixels(ROI(0, spec.width, 0, spec.height, 0, 1, c, c + 1), m_stored.channelformat(c),
                                 packed.data() + m_stored.pixel_bytes(0, c, true), pixel, pixel * spec.width);
        return !m_associates || OIIO::ImageBufAlgo::premult(thumbnail, thumbnail);
    });
}

}  // namespace io
}  // namespace pimg
