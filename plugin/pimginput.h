// SPDX-License-Identifier: BSD-3-Clause
// Reads .pimg files. open() reads the header only; pixels are decoded tile by tile as they are asked for, straight into
// the caller's memory where the request covers a tile. Filters and MIP levels are made whole, at the first read.
// After open() nothing changes but caches behind a mutex: all reads may come from several threads.
#pragma once

#include <exception>
#include <list>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

#include "pimg_pvt.h"
#include "read_request.h"

namespace pimg {
namespace io {

/// A part of a level: pixels [x0, x1) x [y0, y1) from its upper left corner, channels [c0, c1), and where they go, as
/// packed native samples.
struct Request {
    int x0, x1, y0, y1, c0, c1;
    std::uint8_t* to;
    OIIO::stride_t x_stride, y_stride;
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
    bool valid_file(OIIO::Filesystem::IOProxy* proxy) const override;
#endif
    bool open(const std::string& name, OIIO::ImageSpec& spec) override
    {
        return open(name, spec, OIIO::ImageSpec());
    }
    bool open(const std::string& name, OIIO::ImageSpec& spec, const OIIO::ImageSpec& config) override;
    bool close() override;
    int current_miplevel() const override;
    bool seek_subimage(int subimage, int miplevel) override;
    OIIO::ImageSpec spec(int subimage, int miplevel) override;
    OIIO::ImageSpec spec_dimensions(int subimage, int miplevel) override;
    const OIIO::ImageSpec& spec() const override
    {
        return m_spec;
    }
    bool get_thumbnail(OIIO::ImageBuf& thumbnail, int subimage) override;

    using ImageInput::read_native_scanlines;
    using ImageInput::read_native_tile;
    bool read_native_scanline(int subimage, int miplevel, int y, int z, void* data) override;
    bool read_native_scanlines(int subimage, int miplevel, int ybegin, int yend, int z, void* data) override;
    bool read_native_scanlines(int subimage, int miplevel, int ybegin, int yend, int z, int chbegin, int chend,
                               void* data) override;
    bool read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) override;

private:
    template<class Body>
    bool guarded(Body&& body)
    {
        return io::guarded(*this, m_name, body);
    }
    bool fail(const std::string& message);
    bool has_level(int subimage, int miplevel);
    void refuse(const std::string& error);
    void announce_levels(const OIIO::ImageSpec& config);

    bool read(int miplevel, const Request& request);
    bool is_whole();
    bool decode(const Request& request);
    Status decode_tile(const Request& request, std::uint32_t column, std::uint32_t row);
    std::vector<StridedChannel> channels_of(const OIIO::ImageSpec& spec, const Request& request) const;
    std::shared_ptr<const Tile> tile(std::uint32_t column, std::uint32_t row, Status& status);

    std::shared_ptr<const OIIO::ImageBuf> picture();
    std::shared_ptr<OIIO::ImageBuf> stored_picture();
    std::shared_ptr<const OIIO::ImageBuf> made(int miplevel);
    std::shared_ptr<const OIIO::ImageBuf> make(int miplevel);

    std::string m_name;
    ReadRequest m_request;
    Decoder m_decoder;
    std::vector<OIIO::ImageSpec> m_levels;  ///< level 0 and, if asked for, its MIP levels
    OIIO::ImageSpec m_stored;               ///< the picture in the file
    bool m_associates = false;              ///< colours are multiplied by alpha, which the file has not done
    int m_miplevel = 0;

    std::mutex m_tiles_mutex, m_made_mutex, m_whole_mutex;
    std::list<std::shared_ptr<const Tile>> m_tiles;             ///< the last ones that were not read whole
    std::vector<std::shared_ptr<const OIIO::ImageBuf>> m_made;  ///< levels that are not in the file
    enum class Whole { unknown, yes, no } m_whole = Whole::unknown;
    std::string m_failure;  ///< what is wrong with the query, or why no level could be made: it would fail again
};

}  // namespace io
}  // namespace pimg
