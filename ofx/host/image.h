// SPDX-License-Identifier: BSD-3-Clause
// Pictures of the host's, and how they become pictures of OpenImageIO and back. Rows of OpenFX go up, ours go down.
#pragma once

#include <cstdint>
#include <string>

#include <OpenImageIO/imagebuf.h>

#include "host/host.h"

namespace pimg_ofx {

/// An image that a clip has handed out; given back at the end.
class Image {
public:
    /// The image of `clip` at `time`, at least of `region` (canonical coordinates) if that is given.
    Image(const Host& host, OfxImageClipHandle clip, OfxTime time, const OfxRectD* region = nullptr);
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;
    ~Image();

    /// Whether there is one, with pixels of a kind that is understood.
    explicit operator bool() const { return m_data != nullptr && m_channels > 0 && m_depth != OIIO::TypeDesc::UNKNOWN; }

    const OfxRectI& bounds() const { return m_bounds; }  ///< of the pixels in memory; y2 is above the last row
    OfxRectI picture() const;                            ///< those of them that are inside the region of definition
    int row_bytes() const { return m_row_bytes; }
    int channels() const { return m_channels; }
    OIIO::TypeDesc depth() const { return m_depth; }
    bool has_alpha() const { return m_channels == 4; }
    bool is_unpremultiplied() const { return has_alpha() && m_premultiplication == kOfxImageUnPreMultiplied; }
    bool holds_both_fields() const { return m_field == kOfxImageFieldNone || m_field == kOfxImageFieldBoth; }
    std::size_t pixel_bytes() const { return std::size_t(m_channels) * m_depth.size(); }

    /// The first sample of a pixel in bounds().
    char* address(int x, int y) const
    {
        return m_data + std::ptrdiff_t(y - m_bounds.y1) * m_row_bytes
            + std::ptrdiff_t(x - m_bounds.x1) * std::ptrdiff_t(pixel_bytes());
    }

    const std::string& premultiplication() const { return m_premultiplication; }
    void set_premultiplication(const std::string& word) { m_premultiplication = word; }

private:
    const Host& m_host;
    OfxPropertySetHandle m_handle = nullptr;
    char* m_data = nullptr;
    OfxRectI m_bounds {}, m_defined {};
    int m_row_bytes = 0, m_channels = 0;
    OIIO::TypeDesc m_depth;
    std::string m_premultiplication, m_field;
};

inline bool is_empty(const OfxRectI& r)
{
    return r.x1 >= r.x2 || r.y1 >= r.y2;
}
bool operator==(const OfxRectI& a, const OfxRectI& b);
OfxRectI intersection(const OfxRectI& a, const OfxRectI& b);

/// The type of a word like kOfxBitDepthFloat; UNKNOWN for any other.
OIIO::TypeDesc type_of_depth(const std::string& depth);

/// The samples of Image::picture(), top row first, associated with their alpha.
OIIO::ImageBuf picture_of(const Image& image, int threads);

/// What is in that picture: a number for its pixels. Equal pictures of equal size have equal numbers.
std::uint64_t fingerprint(const Image& image, int threads);

/// The pixels of `picture` in `output`, top row first: a result may be written there directly if it has the output's depth
/// and channels.
OIIO::ImageBuf canvas_of(const Image& output, const OfxRectI& picture);

/// A result and where it is to go.
struct Placement {
    OfxRectI picture {};              ///< the whole of which the result is (a part of) one, in pixels of the host
    OfxRectI window {};               ///< pixels to write
    int first_row = 0, row_step = 1;  ///< of the window's rows, those whose y is first_row modulo row_step
    bool has_colours = true;          ///< associated with alpha; false: numbers that have nothing to do with it
    bool is_labels = false;           ///< numbers that are not scaled to the range of a depth
};

/// Writes pixels of `result`, whose data window begins at (0, 0) for the picture's top left corner, to `output`. Alpha
/// that the result does not have comes from `source`; outside the picture all is 0.
void write_result(const OIIO::ImageBuf& result, const Image& source, const Placement& placement, const Image& output,
                  int threads);

}  // namespace pimg_ofx
