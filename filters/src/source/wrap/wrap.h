// SPDX-License-Identifier: BSD-3-Clause
// Pictures whose opposite sides meet: panoramas, whose left side continues the right one, and tiles. Filters work on such a
// picture with margins that repeat what is beyond each side, so that no side is an end; the picture is cut out of the middle.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/types.h>

namespace pimg {
inline namespace PIMG_ABI {

struct Wrap {
    bool x = false, y = false;       ///< whether left and right, top and bottom meet
    int width = 0, height = 0;       ///< of the picture without margins
    int margin_x = 0, margin_y = 0;  ///< pixels that are repeated beyond each side; 0 where sides do not meet

    /// Whether there is a margin.
    explicit operator bool() const { return margin_x > 0 || margin_y > 0; }

    int padded_width() const { return width + 2 * margin_x; }
    int padded_height() const { return height + 2 * margin_y; }
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }

    /// The pixel of the padded picture that shows pixel (x, y) of the picture. Both may lie in the margins.
    Index place(int px, int py) const { return Index(py + margin_y) * Index(padded_width()) + Index(px + margin_x); }
};

/// How one of the two margins that show a place near a side is mixed with the other, so that both sides agree.
struct Fade {
    int other = 0;       ///< where else the place is shown
    float share = 0.0f;  ///< of the other, 0 to 1/2; 0: it is shown once
};

/// For place `at` of 0 .. size - 1 between two sides that meet, with a margin beyond each.
Fade fade_at(int at, int size, int margin);

/// Whether the metadata say that the picture shows all around in latitude and longitude.
bool is_lat_long(const OIIO::ImageSpec& spec);

/// What "x", "xy", "none" or "" asks for; "" leaves it to the metadata. Returns false, with one line in `error`, for a
/// picture that fills only a part of its display window.
bool find_wrap(const OIIO::ImageSpec& spec, const std::string& asked, Wrap& wrap, std::string& error);

/// The name of what was found: "x", "y", "xy" or "none".
const char* name_of(const Wrap& wrap);

/// The picture with its margins. `picture` is local and of floats.
OIIO::ImageBuf padded(const OIIO::ImageBuf& picture, const Wrap& wrap);

/// A raster of the padded picture without the margins.
template<class T>
std::vector<T> without_margins(const Wrap& wrap, std::vector<T> raster)
{
    if (!wrap)
        return raster;
    std::vector<T> middle;
    middle.reserve(wrap.pixels());
    for (int y = 0; y < wrap.height; ++y) {
        const auto row = raster.begin() + std::ptrdiff_t(wrap.place(0, y));
        middle.insert(middle.end(), row, row + wrap.width);
    }
    return middle;
}

/// The remainder that is never negative.
inline int modulo(int at, int size)
{
    return (at % size + size) % size;
}

/// A raster of the picture with its margins.
template<class T>
std::vector<T> with_margins(const Wrap& wrap, std::vector<T> raster)
{
    if (!wrap)
        return raster;
    std::vector<T> all;
    all.reserve(std::size_t(wrap.padded_width()) * std::size_t(wrap.padded_height()));
    for (int y = -wrap.margin_y; y < wrap.height + wrap.margin_y; ++y) {
        const T* row = &raster[std::size_t(modulo(y, wrap.height)) * std::size_t(wrap.width)];
        for (int x = -wrap.margin_x; x < wrap.width + wrap.margin_x; ++x)
            all.push_back(row[modulo(x, wrap.width)]);
    }
    return all;
}

}  // namespace PIMG_ABI
}  // namespace pimg
