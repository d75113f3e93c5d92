// SPDX-License-Identifier: BSD-3-Clause
#include "gl/tiled_texture.h"

#include <algorithm>

namespace pimgview {

TiledTexture::TiledTexture(int largest) : m_largest(largest)
{
    GLint allowed = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &allowed);
    if (m_largest <= 0 || m_largest > allowed)
        m_largest = std::min(int(allowed), 2048);
    glGenVertexArrays(1, &m_vertices);
    glGenBuffers(1, &m_buffer);
}

TiledTexture::~TiledTexture()
{
    glDeleteBuffers(1, &m_buffer);
    glDeleteVertexArrays(1, &m_vertices);
}

void TiledTexture::lay_out(const Frame& frame)
{
    const int side = m_largest - 2;
    if (frame.width == m_width && frame.height == m_height)
        return;
    m_width = frame.width;
    m_height = frame.height;
    m_tiles.clear();
    for (int y = 0; y < m_height; y += side)
        for (int x = 0; x < m_width; x += side) {
            Tile tile { x, y, std::min(side, m_width - x), std::min(side, m_height - y), 0, 0, 0, 0, {} };
            tile.x0 = std::max(0, x - 1);
            tile.y0 = std::max(0, y - 1);
            tile.x1 = std::min(m_width, x + tile.width + 1);
            tile.y1 = std::min(m_height, y + tile.height + 1);
            for (const Texture& texture : tile.textures) {
                glBindTexture(GL_TEXTURE_2D, texture.name());
                glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
                glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
                glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
                glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
                glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
            }
            m_tiles.push_back(std::move(tile));
        }
}

void TiledTexture::fill(const Frame& frame, const Tile& tile, const Texture& texture)
{
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, frame.width);
    const float* first = &frame.rgb[3 * (std::size_t(tile.y0) * std::size_t(frame.width) + std::size_t(tile.x0))];
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, tile.x1 - tile.x0, tile.y1 - tile.y0, 0, GL_RGB, GL_FLOAT, first);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

void TiledTexture::upload(const Frame& result, const Frame* source)
{
    lay_out(result);
    m_region = result.region;
    m_step = result.step;
    m_has_source = source != nullptr && source->width == result.width && source->height == result.height;
    glActiveTexture(GL_TEXTURE0);
    for (const Tile& tile : m_tiles) {
        fill(result, tile, tile.textures[0]);
        if (m_has_source)
            fill(*source, tile, tile.textures[1]);
    }
}

void TiledTexture::draw(const Placement& placement) const
{
    glBindVertexArray(m_vertices);
    glBindBuffer(GL_ARRAY_BUFFER, m_buffer);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    const auto clip_x = [&](int texel) {
        return float((placement.left + (m_region.x0 + texel * double(m_step)) * placement.zoom) * 2.0 / placement.width
                     - 1.0);
    };
    const auto clip_y = [&](int texel) {
        return float(
            1.0 - (placement.top + (m_region.y0 + texel * double(m_step)) * placement.zoom) * 2.0 / placement.height);
    };
    // Nearest from one to one on: with linear filtering a rounded weight would let a sun bleed into its neighbour.
    const GLint filter = m_step * placement.zoom > 0.999 ? GL_NEAREST : GL_LINEAR;
    for (const Tile& tile : m_tiles) {
        const float x0 = clip_x(tile.x), x1 = clip_x(tile.x + tile.width);
        const float y0 = clip_y(tile.y), y1 = clip_y(tile.y + tile.height);
        const float w = float(tile.x1 - tile.x0), h = float(tile.y1 - tile.y0);
        const float u0 = float(tile.x - tile.x0) / w, u1 = float(tile.x + tile.width - tile.x0) / w;
        const float v0 = float(tile.y - tile.y0) / h, v1 = float(tile.y + tile.height - tile.y0) / h;
        const float corners[16] = { x0, y0, u0, v0, x1, y0, u1, v0, x0, y1, u0, v1, x1, y1, u1, v1 };
        glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STREAM_DRAW);
        for (int i = 0; i < 2; ++i) {
            glActiveTexture(GLenum(GL_TEXTURE0 + i));
            glBindTexture(GL_TEXTURE_2D, tile.textures[m_has_source ? i : 0].name());
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
        }
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
}

std::size_t TiledTexture::memory() const
{
    return std::size_t(m_width) * std::size_t(m_height) * 3 * sizeof(float) * (m_has_source ? 2 : 1);
}

}  // namespace pimgview
