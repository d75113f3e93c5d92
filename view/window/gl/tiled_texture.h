// SPDX-License-Identifier: BSD-3-Clause
// Frames on the graphics card, in tiles no larger than a texture can be.
#pragma once

#include <vector>

#include "gl/gl.h"
#include "render/frame.h"

namespace pimgview {

/// Where a picture is in the frame buffer: x = left + column * zoom, counted from the upper left corner.
struct Placement {
    double left = 0.0, top = 0.0, zoom = 1.0;  ///< zoom: pixels of the frame buffer to a pixel of the file
    int width = 1, height = 1;                 ///< of the frame buffer
};

class TiledTexture {
public:
    /// `largest` is the side of the largest tile; 0: what the driver allows, but no more than 2048.
    explicit TiledTexture(int largest = 0);
    ~TiledTexture();
    TiledTexture(const TiledTexture&) = delete;
    TiledTexture& operator=(const TiledTexture&) = delete;

    /// Replaces what is shown. Without a source the result stands for it.
    void upload(const Frame& result, const Frame* source);

    /// Draws all tiles with the program in use.
    void draw(const Placement& placement) const;

    std::size_t memory() const;

private:
    struct Tile {
        int x, y, width, height;  ///< what it shows, in texels of the frame
        int x0, y0, x1, y1;       ///< what it holds: one texel more where there is one, for filtering across edges
        Texture textures[2];      ///< result, source
    };

    void lay_out(const Frame& frame);
    static void fill(const Frame& frame, const Tile& tile, const Texture& texture);

    int m_largest;
    int m_width = 0, m_height = 0, m_step = 1;
    Region m_region;
    bool m_has_source = false;
    std::vector<Tile> m_tiles;
    GLuint m_vertices = 0, m_buffer = 0;
};

}  // namespace pimgview
