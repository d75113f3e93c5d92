// SPDX-License-Identifier: BSD-3-Clause
// What can be known of a file before its pixels are read: its parts, its size in memory, and where the format has one, a
// smaller picture that takes a few milliseconds.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>

namespace pimgview {

/// How large a picture is wanted, in pixels, and from how many in the file on: fewer are read in a fifth of a second, while
/// a window is being made.
struct GlimpseSize {
    double pixels = 0.3e6, from = 3e6;
};

struct Glimpse {
    std::vector<std::string> parts;  ///< names of all parts of the file
    double bytes = 0.0;              ///< of memory for the part; 0 if there is no such part

    /// The picture reduced: the mesh layer of a .pimg file, or the MIP level of a texture, about as large as wanted. Null
    /// if the file has neither, shows it in another way than upright and as stored, or is read soon anyway.
    std::shared_ptr<const OIIO::ImageBuf> pixels;
    OIIO::ImageSpec stored;  ///< header of the picture in the file, if there is a reduced one
    int factor = 1;          ///< pixels of the picture to a reduced one, across and down
};

/// Looks at a file, or at one part of it, by name or number; empty: the only one. A file that cannot be opened has no
/// parts: who reads it then says why.
Glimpse glimpse(const std::string& filename, const std::string& part, const GlimpseSize& size);

}  // namespace pimgview
