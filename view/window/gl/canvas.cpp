// SPDX-License-Identifier: BSD-3-Clause
#include "gl/canvas.h"

namespace pimgview {

Canvas::~Canvas()
{
    glDeleteFramebuffers(1, &m_buffer);
}

bool Canvas::begin(int width, int height)
{
    if (m_buffer == 0)
        glGenFramebuffers(1, &m_buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, m_buffer);
    if (width != m_width || height != m_height) {
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, m_pixels.name());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, m_pixels.name(), 0);
        m_width = width;
        m_height = height;
    }
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
        return true;
    m_width = m_height = 0;
    end();
    return false;
}

void Canvas::end()
{
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void Canvas::show(int x, int y, int width, int height) const
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, m_buffer);
    glBlitFramebuffer(x, y, x + width, y + height, x, y, x + width, y + height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

}  // namespace pimgview
