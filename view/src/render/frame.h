// SPDX-License-Identifier: BSD-3-Clause
// The part of a rendering that is in view, as red, green and blue for a texture.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace pimgview {

/// A rectangle in pixels of the file, from its data window's corner; the ends are not in it.
struct Region {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    bool contains(const Region& r) const { return r.x0 >= x0 && r.y0 >= y0 && r.x1 <= x1 && r.y1 <= y1; }
    bool empty() const { return x1 <= x0 || y1 <= y0; }
};

/// How the numbers of a frame become linear light, which is up to the shader.
struct Light {
    bool encoded = false;            ///< sRGB, to be decoded
    std::string space;               ///< name in the configuration of $OCIO; empty: none
    std::array<float, 9> to_rec709;  ///< of linear light; row by row

    friend bool operator==(const Light& a, const Light& b)
    {
        return a.encoded == b.encoded && a.space == b.space && a.to_rec709 == b.to_rec709;
    }
    friend bool operator!=(const Light& a, const Light& b) { return !(a == b); }
};

struct Frame {
    Region region;
    int step = 1;               ///< pixels of the file to a texel
    int width = 0, height = 0;  ///< in texels
    std::vector<float> rgb;
    Light light;
};

/// Makes a frame of the part of a rendering in `region`; each texel is the mean of reduce x reduce of its pixels. Grey
/// pictures have three equal channels. Labels are given colours of their own. Numbers encoded in another way than sRGB
/// are decoded.
Frame make_frame(const Rendering& rendering, const Region& region, int reduce);

/// What is known of one pixel of a rendering.
struct PixelValue {
    std::vector<float> samples;   ///< of all channels, as they are
    double luminance = 0.0;       ///< of its linear light
    std::array<int, 3> codes {};  ///< of 8 bits, as pimgtool writes them
};

/// `x` and `y` are in pixels of the file. False outside of the picture.
bool pixel_at(const Rendering& rendering, int x, int y, PixelValue& value);

}  // namespace pimgview
