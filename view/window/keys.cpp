// SPDX-License-Identifier: BSD-3-Clause
#include "keys.h"

#include <GLFW/glfw3.h>

namespace pimgview {

const std::vector<Key>& key_table()
{
    static const std::vector<Key> table = {
        { Action::fit, GLFW_KEY_F, false, false, "F", "the whole picture" },
        { Action::actual_size, GLFW_KEY_1, false, false, "1", "one screen pixel to a pixel" },
        { Action::zoom_in, GLFW_KEY_EQUAL, false, false, "+", "closer; so does the wheel, about the pointer" },
        { Action::zoom_out, GLFW_KEY_MINUS, false, false, "-", "farther" },
        { Action::zoom_in, GLFW_KEY_EQUAL, false, true, "", "" },  // + on keyboards where that is above =
        { Action::zoom_in, GLFW_KEY_KP_ADD, false, false, "", "" },
        { Action::zoom_out, GLFW_KEY_KP_SUBTRACT, false, false, "", "" },
        { Action::brighter, GLFW_KEY_E, false, false, "E", "half a stop brighter" },
        { Action::darker, GLFW_KEY_E, false, true, "Shift+E", "half a stop darker" },
        { Action::more_gamma, GLFW_KEY_G, false, false, "G", "lifts the shadows" },
        { Action::less_gamma, GLFW_KEY_G, false, true, "Shift+G", "lowers the shadows" },
        { Action::plain_look, GLFW_KEY_R, false, false, "R", "exposure, gamma and false colours as at the beginning" },
        { Action::source, GLFW_KEY_B, false, false, "B", "before and after: the source, and back" },
        { Action::split, GLFW_KEY_S, false, false, "S", "split line, which the mouse drags" },
        { Action::difference, GLFW_KEY_D, false, false, "D", "difference of result and source" },
        { Action::clipped, GLFW_KEY_C, false, false, "C", "false colours for what is clipped or out of gamut" },
        { Action::histogram, GLFW_KEY_H, false, false, "H", "histogram in stops" },
        { Action::waveform, GLFW_KEY_W, false, false, "W", "waveform" },
        { Action::mesh, GLFW_KEY_M, false, false, "M", "the mesh" },
        { Action::piece, GLFW_KEY_P, false, false, "P", "the dual piece under the pointer" },
        { Action::panels, GLFW_KEY_TAB, false, false, "Tab", "panels" },
        { Action::theme, GLFW_KEY_T, false, false, "T", "light or dark" },
        { Action::undo, GLFW_KEY_Z, true, false, "Ctrl+Z", "undo" },
        { Action::redo, GLFW_KEY_Z, true, true, "Ctrl+Shift+Z", "redo" },
        { Action::redo, GLFW_KEY_Y, true, false, "Ctrl+Y", "redo" },
        { Action::copy, GLFW_KEY_C, true, false, "Ctrl+C", "copies the command line of what is seen" },
        { Action::open, GLFW_KEY_O, true, false, "Ctrl+O", "opens a file" },
        { Action::save, GLFW_KEY_S, true, false, "Ctrl+S", "saves the result" },
        { Action::next, GLFW_KEY_PAGE_DOWN, false, false, "Page down", "next file or frame" },
        { Action::previous, GLFW_KEY_PAGE_UP, false, false, "Page up", "previous file or frame" },
        { Action::play, GLFW_KEY_SPACE, false, false, "Space", "plays the files as a sequence" },
        { Action::sheet, GLFW_KEY_F1, false, false, "F1", "this list" },
        { Action::quit, GLFW_KEY_Q, false, false, "Q", "quits" },
        { Action::quit, GLFW_KEY_Q, true, false, "Ctrl+Q", "quits" },
    };
    return table;
}

}  // namespace pimgview
