// SPDX-License-Identifier: BSD-3-Clause
// The picture on the screen, and what the mouse does to it.
#pragma once

#include "display/viewport.h"
#include "gl/canvas.h"
#include "gl/colour_shader.h"
#include "gl/tiled_texture.h"
#include "panels.h"
#include "workbench.h"

namespace pimgview {

class PictureView {
public:
    explicit PictureView(int largest_tile) : m_texture(largest_tile) { }

    /// Moves, zooms and finds the pixel under the pointer. `area` is in pixels of the frame buffer, of which `pixel_scale`
    /// are a unit of the mouse.
    void interact(Workbench& bench, const Viewport& area, double pixel_scale);

    /// What a key does to the place in the picture.
    void act(Workbench& bench, Action action) const;

    /// Draws the picture into the frame buffer, which has been cleared. What would look as it did before is copied.
    void draw(Workbench& bench, int buffer_width, int buffer_height);

    /// Mesh and dual piece, into the background of what Dear ImGui draws.
    void draw_overlays(const Workbench& bench, double pixel_scale);

    const ViewInfo& info() const { return m_info; }
    bool dragging() const { return m_panning || m_splitting; }

    /// Pictures that have been put on the screen so far.
    int pictures() const { return m_pictures; }
    bool is_current(const Workbench& bench) const { return bench.studio.shown() == m_drawn; }
    const Shown* drawn() const { return m_drawn.get(); }

private:
    /// All that decides how the canvas looks.
    struct Painted {
        std::shared_ptr<const Shown> shown;
        LookOptions look;
        int x = 0, y = 0, width = 0, height = 0, buffer_width = 0, buffer_height = 0;

        friend bool operator==(const Painted& a, const Painted& b)
        {
            return a.shown == b.shown && a.look == b.look && a.x == b.x && a.y == b.y && a.width == b.width
                && a.height == b.height && a.buffer_width == b.buffer_width && a.buffer_height == b.buffer_height;
        }
    };

    bool may_draw(const DocumentState& document, const Shown& shown) const;
    bool paint(Workbench& bench, const Shown& shown, int buffer_width, int buffer_height);
    /// Words in the middle of where the picture would be.
    void draw_words(const std::string& words, double pixel_scale) const;
    void look_up_pixel(const Workbench& bench, double at_x, double at_y);

    Viewport m_area;
    TiledTexture m_texture;
    ColourShader m_shader;
    Canvas m_canvas;
    Painted m_painted;
    std::shared_ptr<const Shown> m_drawn;
    ViewInfo m_info;
    bool m_panning = false, m_splitting = false;
    int m_pictures = 0;
};

}  // namespace pimgview
