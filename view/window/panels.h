// SPDX-License-Identifier: BSD-3-Clause
// The panels beside the picture.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gl/colour_shader.h"
#include "workbench.h"

namespace pimgview {

/// What the panels show of the view.
struct ViewInfo {
    bool has_pixel = false;
    int x = 0, y = 0;  ///< under the pointer
    PixelValue source, result;
    double zoom = 1.0;
    std::size_t texture_memory = 0;
};

class Panels {
public:
    static constexpr int kWidth = 360, kStatusHeight = 54;  ///< in points; chosen by eye

    /// Draws all that is to be seen; `scale` is that of the screen.
    void draw(Workbench& bench, const ViewInfo& info, float scale);

private:
    void files(Workbench& bench);
    void parts_and_layers(Workbench& bench);
    void browser(Workbench& bench);
    void go_to_folder(const std::string& folder);
    void filters(Workbench& bench);
    bool filter(Workbench& bench, std::size_t index);
    void drag_filter(Workbench& bench, std::size_t index);
    static void add_filter(std::vector<StackItem>& items);
    void move_filter(std::vector<StackItem>& items);
    void level_slider(Workbench& bench);
    void look(Workbench& bench);
    static void scopes(const Workbench& bench);
    static void histogram(const Shown& shown, float width);
    void presets(Workbench& bench);
    void save(Workbench& bench);
    void status(Workbench& bench, const ViewInfo& info, float scale);
    static void command_line(Workbench& bench);
    void sheet(Workbench& bench);

    std::string m_folder, m_preset, m_pasted;
    std::vector<std::string> m_entries;
    std::pair<std::size_t, std::size_t> m_moved;  ///< a filter that was dropped: from, to; the same twice: none
    const DisplayList m_displays = display_list();
};

}  // namespace pimgview
