// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/parallel.h>

#include "sketch.h"

#include <algorithm>
#include <cmath>

namespace pimg {
inline namespace PIMG_ABI {

ShadePicture::ShadePicture(const ChannelsView& guides, const ParallelFor& parallel)
    : m_width(guides.width),
      m_height(guides.height),
      m_per_channel(1.0f / float(std::max<std::size_t>(1, guides.channels.size()))),
      m_shades(std::size_t(m_width) * std::size_t(m_height), Shade {})
{
    constexpr int kRows = 32;
    constexpr float kKernel[5] = { 0.0625f, 0.25f, 0.375f, 0.25f, 0.0625f };
    const std::size_t channels = std::min(kChannels, guides.channels.size());
    run(parallel, std::size_t(m_height + kRows - 1) / kRows, [&](std::size_t block) {
        std::vector<float> column(std::size_t(m_width) + 4);
        const int first = int(block) * kRows, last = std::min(m_height, first + kRows);
        for (int y = first; y < last; ++y)
            for (std::size_t c = 0; c < channels; ++c) {
                std::fill(column.begin(), column.end(), 0.0f);
                for (int k = 0; k < 5; ++k) {
                    const float* row =
                        guides.channels[c] + std::size_t(std::clamp(y + k - 2, 0, m_height - 1)) * std::size_t(m_width);
                    for (int x = 0; x < m_width; ++x)
                        column[std::size_t(x) + 2] += kKernel[k] * row[x];
                }
                column[0] = column[1] = column[2];
                column[std::size_t(m_width) + 2] = column[std::size_t(m_width) + 3] = column[std::size_t(m_width) + 1];
                Shade* out = m_shades.data() + std::size_t(y) * std::size_t(m_width);
                for (int x = 0; x < m_width; ++x) {
                    const float* v = column.data() + x;
                    out[x][c] = 0.0625f * (v[0] + v[4]) + (0.25f * (v[1] + v[3]) + 0.375f * v[2]);
                }
            }
    });
}

ShadePicture::ShadePicture(int width, int height, int shrunk, float per_channel)
    : m_width(width),
      m_height(height),
      m_shrunk(shrunk),
      m_per_channel(per_channel),
      m_inverse(1.0f / float(shrunk)),
      m_shades(std::size_t(width) * std::size_t(height), Shade {})
{
}

ShadePicture ShadePicture::half(const ParallelFor& parallel) const
{
    ShadePicture half((m_width + 1) / 2, (m_height + 1) / 2, 2 * m_shrunk, m_per_channel);
    for_rows(parallel, 0, half.m_height, [&](int y) {
        const int below = std::min(2 * y + 1, m_height - 1);
        Shade* out = half.m_shades.data() + std::size_t(y) * std::size_t(half.m_width);
        for (int x = 0; x < half.m_width; ++x) {
            const int right = std::min(2 * x + 1, m_width - 1);
            const Shade &a = pixel(2 * x, 2 * y), &b = pixel(right, 2 * y);
            const Shade &c = pixel(2 * x, below), &d = pixel(right, below);
            for (std::size_t k = 0; k < kChannels; ++k)
                out[x][k] = 0.25f * ((a[k] + b[k]) + (c[k] + d[k]));
        }
    });
    return half;
}

Shade ShadePicture::between(Vec2 p) const
{
    const Vec2 q = own(p);
    const float fx = std::clamp(q.x, 0.0f, float(m_width - 1)), fy = std::clamp(q.y, 0.0f, float(m_height - 1));
    const int x = int(fx), y = int(fy), right = std::min(x + 1, m_width - 1), below = std::min(y + 1, m_height - 1);
    const float wx = fx - float(x), wy = fy - float(y);
    Shade result;
    for (std::size_t c = 0; c < kChannels; ++c)
        result[c] = (1 - wy) * ((1 - wx) * pixel(x, y)[c] + wx * pixel(right, y)[c])
            + wy * ((1 - wx) * pixel(x, below)[c] + wx * pixel(right, below)[c]);
    return result;
}

float ShadePicture::contrast(int x, int y) const
{
    const int left = std::max(x - 2, 0), right = std::min(x + 2, m_width - 1);
    const int above = std::max(y - 2, 0), below = std::min(y + 2, m_height - 1);
    return std::max(distance(pixel(left, y), pixel(right, y)), distance(pixel(x, above), pixel(x, below)));
}

ShadePyramid::ShadePyramid(const ChannelsView& guides, const ParallelFor& parallel)
{
    m_levels.emplace_back(guides, parallel);
    while (std::min(m_levels.back().width(), m_levels.back().height()) > 2)
        m_levels.push_back(m_levels.back().half(parallel));
}

const ShadePicture& ShadePyramid::for_width(float width) const
{
    // A pixel is at most an eighth of the stroke: less sees more noise, and more loses the edges. By eye.
    constexpr float kPixelsPerWidth = 8.0f;
    std::size_t level = 0;
    while (level + 1 < m_levels.size() && width >= 2.0f * kPixelsPerWidth * float(m_levels[level].shrunk()))
        ++level;
    return m_levels[level];
}

Sketch::Sketch(const ShadePicture& picture, int cell)
    : m_picture(picture),
      m_cell(cell),
      m_columns((picture.width() + cell - 1) / cell),
      m_rows((picture.height() + cell - 1) / cell),
      m_wanted(std::size_t(m_columns) * std::size_t(m_rows)),
      m_painted(m_wanted.size()),
      m_covered(m_wanted.size(), 0)
{
    for (int y = 0; y < m_rows; ++y)
        for (int x = 0; x < m_columns; ++x) {
            Shade sum {};
            const int right = std::min(picture.width(), (x + 1) * cell),
                      bottom = std::min(picture.height(), (y + 1) * cell);
            for (int py = y * cell; py < bottom; ++py)
                for (int px = x * cell; px < right; ++px)
                    for (std::size_t c = 0; c < sum.size(); ++c)
                        sum[c] += picture.pixel(px, py)[c];
            const float share = 1.0f / float((right - x * cell) * (bottom - y * cell));
            for (float& s : sum)
                s *= share;
            m_wanted[std::size_t(y) * std::size_t(m_columns) + std::size_t(x)] = sum;
        }
}

template<class Visit>
void Sketch::visit(const Vec2* points, int count, float width, Visit&& visit) const
{
    // Across the stroke in steps of a cell, without its rim, which neighbouring strokes overlap anyway.
    const float per_cell = 1.0f / float(m_cell);
    const int across = std::max(1, int(0.9f * width * per_cell + 0.5f));
    const float step = 0.9f * width / float(across);
    for (int i = 0; i + 1 < count; ++i) {
        const Vec2 a = points[i], d { points[i + 1].x - a.x, points[i + 1].y - a.y };
        const float length = std::sqrt(d.x * d.x + d.y * d.y);
        const int along = std::max(1, int(length * per_cell + 0.5f));
        const float inverse = length > 0.0f ? 1.0f / length : 0.0f;
        const Vec2 normal { -d.y * inverse, d.x * inverse };
        for (int k = 0; k < along; ++k) {
            const float share = (float(k) + 0.5f) / float(along);
            for (int j = 0; j < across; ++j) {
                const float v = (float(j) + 0.5f) * step - 0.45f * width;
                const int x = int((a.x + share * d.x + v * normal.x + 0.5f) * per_cell);
                const int y = int((a.y + share * d.y + v * normal.y + 0.5f) * per_cell);
                if (x >= 0 && y >= 0 && x < m_columns && y < m_rows)
                    visit(std::size_t(y) * std::size_t(m_columns) + std::size_t(x));
            }
        }
    }
}

float Sketch::gain(const Vec2* points, int count, float width, const Shade& shade, float bare) const
{
    float sum = 0.0f;
    int cells = 0;
    visit(points, count, width, [&](std::size_t at) {
        const float before = m_covered[at] ? m_picture.distance(m_wanted[at], m_painted[at]) : bare;
        sum += before - m_picture.distance(m_wanted[at], shade);
        ++cells;
    });
    return cells ? sum / float(cells) : 0.0f;
}

void Sketch::put(const Vec2* points, int count, float width, const Shade& shade, float opacity)
{
    visit(points, count, width, [&](std::size_t at) {
        // On bare canvas thin paint counts as much as thick: there is nothing else to compare with.
        const float share = m_covered[at] ? opacity : 1.0f;
        for (std::size_t c = 0; c < shade.size(); ++c)
            m_painted[at][c] += share * (shade[c] - m_painted[at][c]);
        m_covered[at] = 1;
    });
}

void Sketch::put_below(const Vec2* points, int count, float width, const Shade& shade)
{
    visit(points, count, width, [&](std::size_t at) {
        if (!m_covered[at])
            m_painted[at] = shade;
        m_covered[at] = 1;
    });
}

bool Sketch::is_covered(Vec2 p) const
{
    const int x = int((p.x + 0.5f) / float(m_cell)), y = int((p.y + 0.5f) / float(m_cell));
    return m_covered[std::size_t(y) * std::size_t(m_columns) + std::size_t(x)] != 0;
}

std::vector<Vec2> Sketch::bare_cells() const
{
    std::vector<Vec2> bare;
    for (int y = 0; y < m_rows; ++y)
        for (int x = 0; x < m_columns; ++x)
            if (!m_covered[std::size_t(y) * std::size_t(m_columns) + std::size_t(x)])
                bare.push_back({ (float(x) + 0.5f) * float(m_cell) - 0.5f, (float(y) + 0.5f) * float(m_cell) - 0.5f });
    return bare;
}

}  // namespace PIMG_ABI
}  // namespace pimg
