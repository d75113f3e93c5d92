// SPDX-License-Identifier: BSD-3-Clause
// The picture on the screen, and what the mouse does to it.
#pragma once

#include "display/viewport.h"
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
    void look_up_pixel(const Workbench& bench, double at_x, double at_y);

    Viewport m_area;
    TiledTexture m_texture;
    ColourShader m_shader;
    std::shared_ptr<const Shown> m_drawn;
    ViewInfo m_info;
    bool m_panning = false, m_splitting = false;
    int m_pictures = 0;
};

}  // namespace pimgview
