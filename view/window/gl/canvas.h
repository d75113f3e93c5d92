// SPDX-License-Identifier: BSD-3-Clause
// A copy of the frame buffer that keeps what was drawn into it, so that a window whose panels change need not colour all
// pixels of its picture again.
#pragma once

#include "gl/gl.h"

namespace pimgview {

class Canvas {
public:
    Canvas() = default;
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    /// Makes what is drawn go here until end(). What was kept is lost if the size is another. False if the driver does
    /// not want to; drawing then goes to the window.
    bool begin(int width, int height);
    static void end();

    /// Copies a rectangle to the same place of the window; y counts from the bottom as everywhere in OpenGL.
    void show(int x, int y, int width, int height) const;

    std::size_t memory() const { return std::size_t(m_width) * std::size_t(m_height) * 4; }

private:
    int m_width = 0, m_height = 0;
    GLuint m_buffer = 0;
    Texture m_pixels;
};

}  // namespace pimgview
